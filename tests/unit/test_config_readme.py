import importlib.util
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_page_is_in_step_with_the_schema() -> None:
    path = ROOT / "workflow" / "scripts" / "config_readme.py"
    spec = importlib.util.spec_from_file_location("config_readme", path)
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    page = script.page()
    assert (ROOT / "config" / "README.md").read_text(encoding="utf-8") == page
    assert "| `mesh.size_mm` | `3.0` | mm | number, > 0 |" in page

"""The documentation as a site: it is made without a warning, and its links lead somewhere."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def made(source: Path, out: Path) -> subprocess.CompletedProcess[str]:
    """Make the site of a folder; a warning is an error."""
    command = [sys.executable, "-m", "sphinx", "-c", "docs/site", "-W", "--keep-going", "-q", "."]
    return subprocess.run(
        [*command, str(out)], cwd=source, capture_output=True, text=True, check=False
    )


def copied(folder: Path) -> Path:
    """The files that the site is made of, without what making it would leave in the repository."""
    for name in ("docs", "config", "results"):
        pages = shutil.ignore_patterns("api", "*.parquet", *_RESULTS)
        shutil.copytree(ROOT / name, folder / name, ignore=pages)
    for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "CITATION.cff"):
        shutil.copyfile(ROOT / name, folder / name)
    (folder / "pagd").symlink_to(ROOT / "pagd")
    return folder


#: What a run may have left.
_RESULTS = [path.name for path in (ROOT / "results").iterdir() if path.name != "README.md"]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, made once."""
    folder = copied(tmp_path_factory.mktemp("pages"))
    answer = made(folder, folder / "site")
    assert (answer.returncode, answer.stderr) == (0, "")
    return folder / "site"


@pytest.mark.slow
def test_every_page_of_the_repository_is_in_it(site: Path) -> None:
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}
    assert {path.stem for path in (site / "docs").glob("*.html")} == pages
    first = (site / "index.html").read_text()
    contents = set(re.findall(r'class="reference internal" href="docs/(\w[\w-]*)\.html"', first))
    assert pages <= contents


@pytest.mark.slow
def test_every_notebook_is_in_it(site: Path) -> None:
    names = {path.stem for path in (ROOT / "docs/notebooks").glob("*.ipynb")}
    assert {path.stem for path in (site / "docs/notebooks").glob("*.html")} == names
    first = (site / "index.html").read_text()
    for name in names:
        assert f'href="docs/notebooks/{name}.html"' in first
    page = (site / "docs/notebooks/own_actuator.html").read_text()
    assert "simulate" in page
    assert 'href="../data.html"' in page
    assert "without its outputs" in page


@pytest.mark.slow
def test_the_reference_has_what_is_public(site: Path) -> None:
    text = (site / "docs/api/pagd.design.html").read_text()
    assert 'id="pagd.design.model.Design"' in text
    assert "The independent parameters of a pneu-net (mm, degrees)" in text


@pytest.mark.slow
def test_it_needs_no_network(site: Path) -> None:
    for page in (site / "index.html", site / "docs/mechanics.html"):
        loaded = re.findall(
            r'<(?:script|link|img)[^>]*(?:src|href)="(https?:[^"]*)"', page.read_text()
        )
        assert loaded == []


@pytest.mark.slow
def test_a_link_that_leads_nowhere_is_a_warning(tmp_path: Path) -> None:
    (tmp_path / "docs/site").mkdir(parents=True)
    text = (ROOT / "docs/site/conf.py").read_text()
    # One page is enough.
    text = text.replace("source[0] += _CONTENTS", "pass").replace("apidoc_modules", "_unused")
    (tmp_path / "docs/site/conf.py").write_text(text)
    (tmp_path / "README.md").write_text("# One\n\n[there](docs/nowhere.md)\n")
    answer = made(tmp_path, tmp_path / "site")
    assert answer.returncode != 0
    assert "nowhere" in answer.stderr

"""How the pages of the documentation are made: `make docs`."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import nbformat
from myst_parser.parsers.sphinx_ import MystParser

from pagd import __version__

project = "pagd"
author = copyright = "The pagd authors"
release = version = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.apidoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]

# The pages are those of the repository, which people also read there: README first.
root_doc = "README"
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "config/README.md",
    "results/README.md",
    "docs/*.md",
    "docs/notebooks/*.ipynb",
    "docs/api/*.rst",
]
exclude_patterns = ["docs/site", ".venv"]

# Of two classes of one name either is meant; the text tells which.
suppress_warnings = ["ref.python"]

html_theme = "furo"
html_title = f"pagd {version}"
html_show_sourcelink = False

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

# Signatures are as they are written; names of types are no links.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
# What a package only hands on is described where it is made.
autodoc_default_options = {"members": True, "show-inheritance": True, "ignore-module-all": True}
napoleon_use_rtype = False
napoleon_use_ivar = True
apidoc_modules = [
    {
        "path": "../../pagd",
        "destination": "docs/api",
        # A page a package.
        "separate_modules": False,
        "module_first": True,
        "max_depth": 2,
        "exclude_patterns": ["../../pagd/cli/*", "../../pagd/__main__.py"],
    }
]

_CONTENTS = """

```{toctree}
:hidden:
:caption: Using it

docs/quick-start
docs/command-line
docs/report
docs/workflow
docs/sweeps
docs/dataset
docs/data
config/README
results/README
```

```{toctree}
:hidden:
:caption: Notebooks

docs/notebooks/own_actuator
docs/notebooks/paper_to_figures
docs/notebooks/compare_generators
```

```{toctree}
:hidden:
:caption: How it works

docs/method
docs/mechanics
docs/reduced-order
docs/verification
docs/performance
docs/robustness
```

```{toctree}
:hidden:
:caption: Working on it

docs/extending
CONTRIBUTING
CHANGELOG
docs/api/modules
```
"""


def add_contents(app, name, source):
    """Give the first page, which knows of no Sphinx, the contents of all."""
    if name == root_doc:
        source[0] += _CONTENTS


def add_index(app, error):
    """Have the first page under the name that people look for, too."""
    if error is None and app.builder.name == "html":
        folder = Path(app.outdir)
        shutil.copyfile(folder / f"{root_doc}.html", folder / "index.html")


def leave_out(app, what, name, found, skip, options):
    """Leave out what scikit-learn adds to classes, which is described there."""
    return True if re.fullmatch(r"set_\w+_request", name) else None


def tidy(app, what, name, found, options, lines):
    """Make lists of the fields that docstrings of classes name, and leave bars what they are."""
    result, in_field = [], False
    for line in lines:
        field = _FIELD.match(line) if what in ("class", "exception") else None
        if field:
            result += [] if in_field else [""]
            result.append(f"* **{field[1]}**: {field[2]}")
        elif in_field and line.startswith("    "):
            result.append(f"  {line.strip()}")
        else:
            result += [""] if in_field and line.strip() else []
            result.append(line)
        in_field = bool(field) or (in_field and line.startswith("    "))
    lines[:] = [_bars_escaped(line) for line in result]


_FIELD = re.compile(r"(\w+(?:, \w+)*): (.+)")


def _bars_escaped(line):
    parts = line.split("``")
    # Every second part is code.
    return "``".join(part if i % 2 else part.replace("|", "\\|") for i, part in enumerate(parts))


class Notebook(MystParser):
    """Notebooks as pages: their texts and code; what they show, `make notebooks` makes."""

    supported = ("notebook",)

    def parse(self, inputstring, document):
        """Parse the cells as Markdown."""
        cells = nbformat.reads(inputstring, as_version=4).cells
        first, *others = [_as_markdown(cell) for cell in cells]
        super().parse("\n\n".join([first, _NOTICE, *others]), document)


_NOTICE = """```{note}
This is a notebook of the repository, without its outputs: open it in Jupyter from
`docs/notebooks`, or have all of them executed by `make notebooks`.
```"""


def _as_markdown(cell):
    return cell.source if cell.cell_type == "markdown" else f"```python\n{cell.source}\n```"


def setup(app):
    """Connect what this file adds."""
    app.add_source_suffix(".ipynb", "notebook")
    app.add_source_parser(Notebook)
    # Before napoleon, which reads the sections.
    app.connect("autodoc-process-docstring", tidy, priority=400)
    app.connect("source-read", add_contents)
    app.connect("build-finished", add_index)
    app.connect("autodoc-skip-member", leave_out)

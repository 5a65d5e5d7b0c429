"""Sphinx: `sphinx-build -W -b html docs docs/_build`. Pages are Markdown (MyST)."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import mdlgen.version

project = "mdlgen"
author = "the mdlgen authors"
project_copyright = author
release = mdlgen.version.version()
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
exclude_patterns = ["_build", "_generate"]
source_suffix = {".md": "markdown"}
html_theme = "furo"
html_title = "mdlgen"
html_static_path: list[str] = []
html_copy_source = False
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
# "..." of a command line stays three points
smartquotes = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"


def setup(app: Any) -> None:
    app.connect("source-read", outside)


def outside(app: Any, name: str, source: list[str]) -> None:
    """Pages of the repository that are not of the manual are named in it, not linked."""
    source[0] = re.sub(r"\[[^\]]+\]\((?:\.\./)+((?:samples/)?\w+\.md)\)", _named, source[0])


def _named(link: re.Match[str]) -> str:
    root = Path(__file__).resolve().parent.parent
    return f"`{link[1]}`" if (root / link[1]).is_file() else link[0]

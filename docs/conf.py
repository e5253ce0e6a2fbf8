"""Settings of the documentation: `make docs` builds it strictly into out/docs/."""

import logging
import sys
from importlib import metadata
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
logging.getLogger("skfem").setLevel(logging.WARNING)  # it tells of every mesh

project = html_title = "tsm-crossval"
author = copyright = "The tsm-crossval authors"  # noqa: A001 - Sphinx's own name
release = version = metadata.version("tsm-crossval")

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc", "sphinx_argparse_cli", "docs.extensions.site"]
exclude_patterns = ["extensions", "static", "_generated/*.md"]  # the last ones are included by other pages

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3

html_theme = "furo"
html_math_renderer = "mathml"
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_theme_options = {"navigation_with_keys": True}

default_role = "literal"  # single backticks of docstrings name parameters as well as objects
autodoc_typehints = "none"  # docstrings state types with shapes and units
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "no-value": True}
numpydoc_show_class_members = False
add_module_names = False
toc_object_entries = False
# in the aliases `Errors`, `Columns` and `Values`; the standard library and NumPy are not linked
nitpick_ignore_regex = [("py:class", r"collections\.abc\.(Mapping|Callable)|numpy\.(ndarray|dtype|float64)")]


def _list_keys(_app: Sphinx, kind: str, _name: str, value: object, *said: Any) -> None:
    if kind == "data" and isinstance(value, dict):
        said[1][:] += ["", "Keys: " + ", ".join(f"``{key}``" for key in value) + "."]


def setup(app: Sphinx) -> None:
    """Add the keys of a registry to its entry."""
    app.connect("autodoc-process-docstring", _list_keys)

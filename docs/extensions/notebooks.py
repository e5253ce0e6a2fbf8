"""The notebooks as files for Jupyter, made from the pages before every build."""

import re
from pathlib import Path

import nbformat
from myst_nb.core.read import read_myst_markdown_notebook
from sphinx.application import Sphinx


def notebook(page: str) -> str:
    r"""Return a page with code cells as an .ipynb without outputs: without its link to this file, and with its roles as plain code.

    Examples
    --------
    >>> import json
    >>> page = "The {test}`proof`.\n\n{download}`a.ipynb`\n\n```{code-cell} ipython3\n1 + 1\n```\n"
    >>> [cell["source"] for cell in json.loads(notebook(page))["cells"]]
    [['The `proof`.'], ['1 + 1']]
    """
    text = re.sub(r"^.*\{download\}.*\n+", "", page, flags=re.MULTILINE)
    found = read_myst_markdown_notebook(re.sub(r"\{\w+\}(?=`\S)", "", text))
    for number, cell in enumerate(found.cells):
        cell["id"] = f"cell-{number}"
    found.metadata = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.validate(found)
    return nbformat.writes(found) + "\n"


def _on_start(app: Sphinx) -> None:
    source = Path(app.srcdir)
    target = source / "_generated" / "notebooks"
    target.mkdir(parents=True, exist_ok=True)
    for page in sorted((source / "notebooks").glob("*.md")):
        text = notebook(page.read_text(encoding="utf-8"))
        (target / f"{page.stem}.ipynb").write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the notebooks when a build starts."""
    app.connect("builder-inited", _on_start)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

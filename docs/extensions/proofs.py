"""The role ``test``: names the test that proves a statement, and warns when there is none of that name."""

import ast
from functools import cache
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxRole
from sphinx.util.logging import getLogger

ROOT = Path(__file__).parents[2]


@cache
def tests_in(path: str) -> frozenset[str]:
    """Return the names of the tests in a file, given from the root of the project; none if there is no such file."""
    file = ROOT / path
    if not file.is_file():
        return frozenset()
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return frozenset(
        node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    )


def exists(test: str) -> bool:
    """Whether there is a test ``tests/FILE.py::NAME``.

    Examples
    --------
    >>> exists("tests/tsm/test_contract.py::test_linear_beam_is_timoshenkos")
    True
    >>> exists("tests/tsm/test_contract.py::test_of_nothing")
    False
    """
    path, _, name = test.partition("::")
    return name in tests_in(path)


class ProofRole(SphinxRole):
    """``{test}`tests/FILE.py::NAME```, shown as NAME; the file is shown where the mouse rests on it."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Return the name, and warn if there is no such test."""
        if not exists(self.text):
            getLogger(__name__).warning("%s: no such test", self.text, location=self.get_location())
        path, _, name = self.text.partition("::")
        return [nodes.raw("", f'<code class="literal" title="{path}">{name}</code>', format="html")], []


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the role."""
    app.add_role("test", ProofRole())
    return {"parallel_read_safe": True, "parallel_write_safe": True}

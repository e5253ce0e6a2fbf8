"""Every kind of fault is drawn, and changes the module that it is put into."""

import ast

from tests.mutation.__main__ import faults

SOURCE = "def f(x: int = 1) -> float:\n    return -x + 2.0 * x[0] if x < 1e-9 and x else 'text'\n"
KINDS = ["off by one", "sign", "operator", "missing term", "operator", "factor", "off by one", "condition", "comparison", "tolerance"]  # fmt: skip


def test_every_kind_of_fault_is_found_and_changes_the_module() -> None:
    kinds = []
    for number, (_, kind, _) in enumerate(faults(ast.parse(SOURCE))):
        tree = ast.parse(SOURCE)
        list(faults(tree))[number][2]()
        assert ast.unparse(tree) != ast.unparse(ast.parse(SOURCE)), kind
        kinds.append(kind)
    assert sorted(kinds) == sorted(KINDS)

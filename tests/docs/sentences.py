"""The sentences with which the scene reader refuses a file, found in its source."""

import ast
from collections.abc import Iterator
from pathlib import Path

GROUPS = {"RecordError"}
"""Errors that hold errors."""
ERRORS = {"RuleError", "FieldError", "InputError", "SceneError", "kind"}
"""Names by which the reader calls its errors; `kind` is the class of error that a caller hands down."""


def sentences(source: Path) -> set[str]:
    """Return the sentences that a module raises or hands down, ``{}`` for every value in them.

    Raises
    ------
    ValueError
        For an error of another kind, and for a sentence that is made in a way that is not understood here.
    """
    tree = ast.parse(source.read_text(encoding="utf-8"))
    found: set[str] = set()
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef):
            for argument in _said(function):
                found |= _templates(argument, function, f"{source.name}:{argument.lineno}")
    return found


def _said(function: ast.FunctionDef) -> Iterator[ast.expr]:
    """Yield the last argument of every error made in a function itself, and what it hands to `read_text`."""
    for node in _own_nodes(function):
        if not isinstance(node, ast.Call):
            continue
        name = _name(node)
        if name in ERRORS and node.args:
            yield node.args[-1]
        elif name.endswith("Error") and name not in GROUPS | ERRORS:
            raise ValueError(f"line {node.lineno}: {name} is no error of the reader")
        elif name == "read_text":
            yield node.args[1]


def _name(value: ast.AST) -> str:
    """Return the name of the function that is called, empty if the value is no call of a name."""
    return str(getattr(getattr(value, "func", None), "id", ""))


def _own_nodes(function: ast.FunctionDef) -> Iterator[ast.AST]:
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop()
        yield node
        waiting += [part for part in ast.iter_child_nodes(node) if not isinstance(part, ast.FunctionDef)]


def _templates(value: ast.expr, function: ast.FunctionDef, where: str) -> set[str]:
    if isinstance(value, ast.Constant | ast.JoinedStr | ast.BinOp):
        return {_template(value, where)}
    if isinstance(value, ast.Name):
        if value.id in {argument.arg for argument in function.args.args}:
            return set()  # the caller's sentence, found there
        assigned = [
            node.value
            for node in _own_nodes(function)
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", None) == value.id
        ]
        if assigned:
            return set().union(*(_templates(item, function, where) for item in assigned))
    if ast.unparse(value) in ("str(error)", "self.rule") or _name(value) in GROUPS:
        return set()  # a sentence that is passed on, or errors that are looked at one by one
    raise ValueError(f"{where}: {ast.unparse(value)} is no sentence")


def _template(value: ast.expr, where: str) -> str:
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return value.value
    if isinstance(value, ast.JoinedStr):
        return "".join(_template(part, where) for part in value.values)
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add):
        return _template(value.left, where) + _template(value.right, where)
    return "{}"

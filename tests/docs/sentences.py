"""The sentences with which the scene reader refuses a file, found in its source."""

import ast
from collections.abc import Iterator
from pathlib import Path

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
    """Yield the last argument of every error raised in a function itself, and what it hands to `read_text`."""
    for node in _own_nodes(function):
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            name = getattr(node.exc.func, "id", None)
            if name in ERRORS:
                yield node.exc.args[-1]
            elif name is not None:
                raise ValueError(f"line {node.lineno}: {name} is no error of the reader")
        if isinstance(node, ast.Call) and getattr(node.func, "id", None) == "read_text":
            yield node.args[1]


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
    if ast.unparse(value) in ("str(error)", "self.rule"):
        return set()  # a sentence that is passed on
    raise ValueError(f"{where}: {ast.unparse(value)} is no sentence")


def _template(value: ast.expr, where: str) -> str:
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return value.value
    if isinstance(value, ast.JoinedStr):
        return "".join(_template(part, where) for part in value.values)
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add):
        return _template(value.left, where) + _template(value.right, where)
    return "{}"

"""Mutants of a module: copies of its source that differ in one operator, constant, sign, condition or statement."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

_ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
}
_COMPARISON: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """One change of a module.

    Attributes
    ----------
    module : str
        Path of the module in the project.
    line : int
        Line of the change, counted from 1.
    before, after : str
        The lines that change, as they were and as they are, in one line each.
    source : str
        The whole changed module.
    """

    module: str
    line: int
    before: str
    after: str
    source: str


def mutants(module: str, source: str) -> list[Mutant]:
    """Return all mutants of a module in the order of its lines.

    Arithmetic operators are exchanged (+ and -, * and /), comparisons negated and moved by their bound, `and` and `or` exchanged, `not` and
    minus signs dropped, integers raised by 1, other numbers x made 2 x + 1, truth values negated, conditions made true and false, and
    statements of effect (calls, augmented assignments, assignments to items and attributes, raise, break, continue, yield) left out.
    Asserts, annotations, decorators, messages and plain assignments to names are left alone.
    """
    found = [
        _mutant(module, source, at, text)
        for node in _worth_changing(ast.parse(source))
        for at, text in _changes(node)
    ]
    return sorted(found, key=lambda mutant: mutant.line)


def _worth_changing(node: ast.AST) -> Iterator[ast.AST]:
    """Expressions and statements below a node, without those that no test is to tell apart."""
    if isinstance(node, ast.Assert | ast.JoinedStr):
        return
    yield node
    if isinstance(node, ast.Raise):
        return
    left_out: list[ast.AST | None] = [*getattr(node, "decorator_list", ())]
    left_out += [getattr(node, name, None) for name in ("annotation", "returns")]
    attributes = isinstance(node, ast.FunctionDef) and node.name == "__init__"
    for child in ast.iter_child_nodes(node):
        if child in left_out or (attributes and _sets_attribute(child)):
            continue
        yield from _worth_changing(child)


def _sets_attribute(node: ast.AST) -> bool:
    """Whether a statement sets an attribute to a plain name, which nobody can do without."""
    return (
        isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Attribute)
        and isinstance(node.value, ast.Name)
    )


def _changes(node: ast.AST) -> Iterator[tuple[ast.stmt | ast.expr, str]]:
    """Nodes to replace, and the texts to put in their place."""
    if isinstance(node, ast.expr):
        yield from ((node, f"({ast.unparse(other)})") for other in _expressions(node))
    if isinstance(node, ast.stmt) and _has_effect(node):
        yield node, "pass"
    if isinstance(node, ast.AugAssign) and type(node.op) in _ARITHMETIC:
        op = _ARITHMETIC[type(node.op)]()
        yield node, ast.unparse(ast.AugAssign(target=node.target, op=op, value=node.value))
    if isinstance(node, ast.If | ast.IfExp) or (isinstance(node, ast.While) and not _is_true(node.test)):
        yield node.test, "(False)"
    if isinstance(node, ast.If | ast.IfExp):
        yield node.test, "(True)"
    if isinstance(node, ast.comprehension):
        yield from ((test, "(True)") for test in node.ifs)


def _is_true(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is True


def _expressions(node: ast.expr) -> Iterator[ast.expr]:
    match node:
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _ARITHMETIC:
            yield ast.BinOp(left=left, op=_ARITHMETIC[type(op)](), right=right)
        case ast.Compare(left=left, ops=[*ops], comparators=right):
            for n, op in enumerate(ops):
                for other in _COMPARISON[type(op)]:
                    yield ast.Compare(left=left, ops=[*ops[:n], other(), *ops[n + 1 :]], comparators=right)
        case ast.BoolOp(op=op, values=values):
            yield ast.BoolOp(op=ast.And() if isinstance(op, ast.Or) else ast.Or(), values=values)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand):
            yield operand
        case ast.Constant(value=bool(value)):
            yield ast.Constant(value=not value)
        case ast.Constant(value=int(value)):
            yield ast.Constant(value=value + 1)
        case ast.Constant(value=float(value)):
            yield ast.Constant(value=2 * value + 1)


def _has_effect(node: ast.stmt) -> bool:
    """Whether leaving a statement out leaves a program that still runs."""
    match node:
        case ast.Expr(value=ast.Call() | ast.Yield() | ast.YieldFrom()):
            return True
        case ast.Assign(targets=[ast.Subscript() | ast.Attribute(), *_]):
            return True
        case _:
            return isinstance(node, ast.AugAssign | ast.Raise | ast.Break | ast.Continue)


def _mutant(module: str, source: str, node: ast.stmt | ast.expr, text: str) -> Mutant:
    """Splice a text into the source in the place of a node; positions of `ast` count bytes."""
    lines = source.encode().splitlines(keepends=True)
    first, last = node.lineno - 1, node.end_lineno - 1
    head, tail = lines[first][: node.col_offset], lines[last][node.end_col_offset :]
    changed = head + text.encode() + tail
    old = b"".join(lines[first : last + 1])
    return Mutant(
        module=module,
        line=node.lineno,
        before=" ".join(old.decode().split()),
        after=" ".join(changed.decode().split()),
        source=b"".join([*lines[:first], changed, *lines[last + 1 :]]).decode(),
    )

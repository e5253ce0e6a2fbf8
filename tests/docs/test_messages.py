"""Every sentence of the scene reader is in the documentation with its cure, and is provoked here."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from comparisons import scene as reader
from comparisons.cli import main
from comparisons.scene import FieldError, InputError, Scene, load_scene
from docs.extensions.messages import FILE, SCENES, messages

SOURCES = [path.read_text(encoding="utf-8") for path in sorted(Path(reader.__file__).parent.glob("*.py"))]
LISTED = messages()
GROUPS = {"RecordError"}
"""Errors that hold errors."""
ERRORS = {"RuleError", "FieldError", "InputError", "SceneError", "kind"}
"""Names by which the reader calls its errors; `kind` is the class of error that a caller hands down."""


def sentences(source: str) -> set[str]:
    """Return the sentences that a module raises or hands down, ``{}`` for every value in them.

    Raises
    ------
    ValueError
        For an error of another kind, and for a sentence that is made in a way that is not understood here.
    """
    functions = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)]
    return {
        words for function in functions for said in _said(function) for words in _templates(said, function)
    }


def _said(function: ast.FunctionDef) -> Iterator[ast.expr]:
    """Yield the last argument of every error made in a function itself, and what it hands to `read_text`."""
    for node in _own_nodes(function):
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
        yield (node := waiting.pop())
        waiting += [part for part in ast.iter_child_nodes(node) if not isinstance(part, ast.FunctionDef)]


def _templates(value: ast.expr, function: ast.FunctionDef) -> set[str]:
    if isinstance(value, ast.Constant | ast.JoinedStr | ast.BinOp):
        return {_template(value)}
    name = getattr(value, "id", "")
    if name in {argument.arg for argument in function.args.args}:
        return set()  # the caller's sentence, found there
    made = [node for node in _own_nodes(function) if isinstance(node, ast.Assign)]
    assigned = [node.value for node in made if name and getattr(node.targets[0], "id", None) == name]
    if assigned:
        return {words for item in assigned for words in _templates(item, function)}
    if ast.unparse(value) in ("str(error)", "self.rule") or _name(value) in GROUPS:
        return set()  # a sentence that is passed on, or errors that are looked at one by one
    raise ValueError(f"line {value.lineno}: {ast.unparse(value)} is no sentence")


def _template(value: ast.expr) -> str:
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        return value.value
    if isinstance(value, ast.JoinedStr):
        return "".join(map(_template, value.values))
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add):
        return _template(value.left) + _template(value.right)
    return "{}"


def test_every_sentence_is_listed_once_and_none_is_stale():
    found = {words for source in SOURCES for words in sentences(source)}
    listed = Counter(message.sentence for message in LISTED)
    assert found
    assert set(listed) == found, f"{FILE} and the source of the reader differ"
    assert max(listed.values()) == 1
    classes = [
        node for source in SOURCES for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)
    ]
    assert {node.name for node in classes if node.name.endswith("Error")} == ERRORS - {"kind"} | GROUPS


@pytest.mark.parametrize("message", LISTED, ids=lambda message: message.sentence)
def test_every_message_is_provoked(message, tmp_path, monkeypatch, capsys):
    """By a change of a scene that is good without it."""
    monkeypatch.chdir(tmp_path)
    assert message.cure.endswith(".")
    assert [part for part in message.sentence.split("{}") if part not in message.example] == []
    if message.python is not None:
        with pytest.raises(FieldError) as caught:
            eval(message.python, {"Scene": Scene})  # noqa: S307 - our own file
        assert str(caught.value) == message.example
    elif message.arguments is not None:
        try:
            status = main(list(message.arguments))
        except SystemExit as end:
            status = end.code
        assert status == 2
        assert capsys.readouterr().err.strip().splitlines()[-1].removeprefix("crossval: ") == message.example
    else:
        Path("my.toml").write_text(SCENES[message.base])
        assert load_scene("my.toml").beams
        Path("my.toml").write_bytes(message.text.encode(message.encoding))
        with pytest.raises(InputError) as error:
            load_scene("my.toml")
        assert str(error.value) == message.example

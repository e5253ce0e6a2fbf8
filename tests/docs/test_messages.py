"""Every sentence of the scene reader is in the documentation with its cure, and is provoked here."""

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from comparisons import scene as reader
from comparisons.cli import main
from comparisons.scene import FieldError, InputError, Scene, StageSpec, load_scene

# where a rule is declared, and what it accepts
from comparisons.scene.read import LISTS
from comparisons.scene.record import lists_of
from docs.extensions.messages import FILE, SCENES, messages

SOURCES = [path.read_text(encoding="utf-8") for path in sorted(Path(reader.__file__).parent.glob("*.py"))]
LISTED = messages()
ERRORS = {"FieldError", "InputError"}
"""Names by which the reader calls its errors."""
HANDED = {"read_text", "refused"}
"""Functions that are given a sentence as their second argument."""
PASSED = {"rule", "absent", "reason", "sentence", "error.rule", "one.rule"}
"""What holds the sentence of a caller."""
RULE = "must be {}"
"""The sentence of a rule for a single value: what the rule accepts."""


def sentences(source: str) -> set[str]:
    """Return the sentences that a module raises, hands down or keeps in a variable, ``{}`` for every value in them.

    Raises ValueError for a sentence that is made in a way that is not understood here.
    """
    said, kept = list[ast.expr](), defaultdict[str, list[ast.expr]](list)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            said += node.args[-1:] if node.func.id in ERRORS else []
            said += node.args[1:2] if node.func.id in HANDED else []
        elif isinstance(node, ast.Assign):
            kept[ast.unparse(node.targets[0])].append(node.value)
    return {
        words for value in said for one in kept[ast.unparse(value)] or [value] for words in _template(one)
    }


def _template(value: ast.expr) -> Iterator[str]:
    if isinstance(value, ast.JoinedStr):
        yield "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in value.values)
    elif isinstance(value, ast.Constant):
        yield value.value
    elif not (ast.unparse(value) in PASSED or "RecordError(" in ast.unparse(value)):
        raise ValueError(f"line {value.lineno}: {ast.unparse(value)} is no sentence")


def test_every_sentence_is_listed_once_and_none_is_stale():
    found = {words for source in SOURCES for words in sentences(source)} - {RULE}
    listed = Counter(message.sentence for message in LISTED)
    kinds = [Scene, *LISTS.values(), *lists_of(StageSpec).values()]
    for rule in {RULE.format(rule.accepts) for kind in kinds for rule in kind.rules.values()}:
        found |= {
            words for words in listed if re.fullmatch(".*".join(map(re.escape, words.split("{}"))), rule)
        } or {rule}
    assert found
    assert set(listed) == found, f"{FILE} and the source of the reader differ"
    assert max(listed.values()) == 1
    raised = set(re.findall(r"raise (\w+)\(", "".join(SOURCES)))
    others = {"RecordError", "Unjudged", "TypeError", "AttributeError", "FrozenInstanceError"}
    assert raised <= ERRORS | others


@pytest.mark.parametrize("message", LISTED, ids=lambda message: message.sentence)
def test_every_message_is_provoked(message, in_folder, capsys):
    """By a change of a scene that is good without it."""
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

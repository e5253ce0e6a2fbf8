"""Every sentence of the scene reader is in the documentation with its cure, and is provoked here."""

import ast
from collections import Counter
from pathlib import Path

import pytest

from comparisons import scene as reader
from comparisons.cli import main
from comparisons.scene import FieldError, InputError, Scene, load_scene
from docs.extensions.messages import FILE, SCENES, Message, messages
from tests.docs.sentences import ERRORS, GROUPS, sentences

SOURCES = sorted(Path(reader.__file__).parent.glob("*.py"))
LISTED = messages()
NAMES = {"Scene": Scene}


def test_every_sentence_is_listed_once_and_none_is_stale() -> None:
    found = set().union(*(sentences(source) for source in SOURCES))
    listed = Counter(message.sentence for message in LISTED)
    assert found
    assert set(listed) == found, f"{FILE} and the source of the reader differ"
    assert max(listed.values()) == 1


def test_sentences_are_found_in_every_form(tmp_path: Path) -> None:
    source = tmp_path / "rules.py"
    source.write_text(
        "def f(a, rule):\n"
        "    if a:\n        raise RuleError('plain')\n"
        "    if not a:\n        rule_ = f'with {a} in it'\n        raise FieldError('k', a, rule_)\n"
        "    if a == 1:\n        raise FieldError('k', a, 'one' + f' {a!r}')\n"
        "    raise SceneError(a, rule)\n"
    )
    assert sentences(source) == {"plain", "with {} in it", "one {}"}
    source.write_text("def f(a):\n    raise RuleError(a.strip())\n")
    with pytest.raises(ValueError, match="is no sentence"):
        sentences(source)
    source.write_text("def f(a):\n    raise OtherError('x')\n")
    with pytest.raises(ValueError, match="OtherError"):
        sentences(source)


@pytest.mark.parametrize("message", LISTED, ids=lambda message: message.sentence)
def test_every_message_is_provoked(
    message: Message, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert message.cure.endswith(".")
    for part in message.sentence.split("{}"):
        assert part in message.example
    if message.python is not None:
        with pytest.raises(FieldError) as caught:
            eval(message.python, NAMES)  # noqa: S307 - our own file
        assert str(caught.value) == message.example
    elif message.arguments is not None:
        assert message.example == _of_command(message.arguments, capsys)
    else:
        Path("my.toml").write_bytes(message.text.encode(message.encoding))
        with pytest.raises(InputError) as error:
            load_scene("my.toml")
        assert str(error.value) == message.example


def _of_command(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> str:
    try:
        status = main(list(arguments))
    except SystemExit as end:
        status = end.code
    assert status == 2
    return capsys.readouterr().err.strip().splitlines()[-1].removeprefix("crossval: ")


@pytest.mark.parametrize("name", SCENES)
def test_the_scenes_that_are_changed_are_good(name: str, tmp_path: Path) -> None:
    path = tmp_path / "my.toml"
    path.write_text(SCENES[name])
    assert load_scene(str(path)).beams


def test_the_module_of_sentences_knows_every_error_of_the_reader() -> None:
    names = {
        node.name
        for source in SOURCES
        for node in ast.walk(ast.parse(source.read_text()))
        if isinstance(node, ast.ClassDef) and node.name.endswith("Error")
    }
    assert names == ERRORS - {"kind"} | GROUPS

"""Files are whole or not there."""

import errno
import os
import re
from dataclasses import replace
from pathlib import Path
from threading import Thread

import pytest

from comparisons.cli import main
from comparisons.files import (
    WRITTEN,
    OutputError,
    alone_in,
    replacing,
    result_file,
    writable_file,
    writable_folder,
    write_text,
)
from comparisons.scene import load_scene, to_toml


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    write_text(path, "old")

    def fail() -> None:
        with replacing(path) as temporary:
            temporary.write_text("half")
            assert temporary.suffix == path.suffix
            raise RuntimeError("power cut")

    with pytest.raises(RuntimeError, match="power cut"):
        fail()
    assert path.read_text() == "old"
    assert sorted(tmp_path.iterdir()) == [tmp_path / WRITTEN, path]
    write_text(path, "new")
    assert path.read_text() == "new"


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for folder in ("file", "file/below", "nul\0l"):
        with pytest.raises(OutputError, match="cannot be written"):
            writable_folder(tmp_path / folder)
    os.mkfifo(tmp_path / "pipe")
    for file in (tmp_path, tmp_path / "pipe", tmp_path / "none" / "a.json"):
        with pytest.raises(OutputError, match="cannot be written"):
            writable_file(file)
    assert writable_file(tmp_path / "a.json").parent == writable_folder(tmp_path / "new").parent
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "new", "pipe"]


def test_a_link_is_followed_not_replaced(tmp_path: Path) -> None:
    target, link = tmp_path / "target.json", tmp_path / "link.json"
    write_text(target, "old")
    link.symlink_to(target)
    write_text(result_file(link), "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_no_room_names_the_file(tmp_path: Path) -> None:
    def fill() -> None:
        with replacing(tmp_path / "a.txt"):
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OutputError, match=r"a\.txt: cannot be written: No space left on device"):
        fill()
    assert not list(tmp_path.iterdir())


def test_sets_of_files_are_written_one_after_the_other(tmp_path: Path) -> None:
    order: list[str] = []

    def write() -> None:
        with alone_in(tmp_path):
            order.append("second")

    other = Thread(target=write)
    with alone_in(tmp_path):
        other.start()
        other.join(0.2)
        order.append("first")
    other.join(10)
    assert order == ["first", "second"]


HERE = "of a user"
"""What a command must leave alone."""
INTO_A_FILE = {
    "check": (["check", "s.toml", "--json", "FILE"], ["check", "s.toml", "--out", "FILE.png"]),
    "solve": tuple(
        ["solve", "s.toml", option, f"FILE{ending}"]
        for option, ending in (("--json", ""), ("--csv", ""), ("--plot", ".svg"))
    ),
    "certify": (["certify", "s.toml", "--json", "FILE"],),
    "gate": (["gate", "s.toml", "--max-error", "force=1", "--junit", "FILE"],),
    "manual": (["manual", "--only", "roll-up", "--quiet", "--out", "new", "--junit", "FILE"],),
}
INTO_A_FOLDER = {
    "compare": (["compare", "s.toml"], ("report.html", "budget.json", "tsm/tsm.pvd", "solid/solid-0002.vtm")),
    "view": (["view", "s.toml"], ("view.png", "view.gif")),
    "trade": (["trade", "s.toml", "--quick"], ("trade.csv", "report.html")),
    "league": (["league", "s.toml"], ("league.svg", "report.html")),
    "reproduce": (["reproduce", "fig8", "--quick"], ("report.html",)),
    "extremes": (["extremes", "--quick"], ("extremes.csv",)),
    "study": (["study", "locking"], ("locking.csv",)),
    "manual": (["manual", "--only", "roll-up", "--quiet"], ("index.md", "roll-up.svg")),
    "cards": (["manual", "--only", "roll-up", "--cards"], ("roll-up.json", "card.schema.json")),
}


@pytest.fixture
def scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "s.toml"
    path.write_text(to_toml(replace(load_scene("tip-load"), load_parameters=2)))
    return path


@pytest.mark.parametrize("command", INTO_A_FILE)
def test_no_file_of_a_user_is_replaced(command: str, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The scene itself among them; and the same command replaces what it wrote, until that is edited."""
    text = scene.read_text()
    for arguments in INTO_A_FILE[command]:
        mine = Path(next(word for word in arguments if word.startswith("FILE")).replace("FILE", "mine"))
        mine.write_text(HERE)
        for file, there in ((str(mine), HERE), ("s.toml", text)):
            given = [file if word.startswith("FILE") else word for word in arguments]
            assert main(given) == 2
            error = capsys.readouterr().err
            assert error.count("\n") == 1
            assert re.search(r"is there already, and is not as crossval wrote it|must end in", error)
            assert Path(file).read_text() == there
        mine.unlink()
        given = [str(mine) if word.startswith("FILE") else word for word in arguments]
        assert main(given) == main(given) == 0
        with mine.open("a") as file:
            file.write("edited")
        assert main(given) == 2
        assert "is there already" in capsys.readouterr().err
        assert mine.read_bytes().endswith(b"edited")


@pytest.mark.parametrize("command", INTO_A_FOLDER)
def test_a_folder_of_a_user_is_left_alone(
    command: str, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Before anything is computed, but for a few files whose names are not known by then."""
    arguments, names = INTO_A_FOLDER[command]
    for number, name in enumerate(names):
        mine = Path(str(number), name)
        mine.parent.mkdir(parents=True)
        mine.write_text(HERE)
        assert main([*arguments, *([] if "--cards" in arguments else ["--out"]), str(number)]) == 2
        error = capsys.readouterr().err.splitlines()
        assert error[-1].startswith(f"crossval: {mine}: is there already, and is not as crossval wrote it")
        assert mine.read_text() == HERE
    assert scene.is_file()


def test_an_answer_is_not_replaced_by_its_certificate(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["solve", str(scene), "--json", "a.json"]) == 0
    answer = Path("a.json").read_bytes()
    assert main(["certify", "a.json", "--scene", "s.toml", "--json", "./a.json"]) == 2
    assert "--json ./a.json: is the answer to be judged" in capsys.readouterr().err
    assert Path("a.json").read_bytes() == answer


def test_a_new_scene_is_a_users_from_the_beginning(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "mine", "--like", "tip-load"]) == 0
    text = Path("mine.toml").read_text()
    assert main(["check", "mine.toml", "--json", "mine.toml"]) == 2
    assert "mine.toml: is there already" in capsys.readouterr().err
    assert Path("mine.toml").read_text() == text
    assert scene.is_file()

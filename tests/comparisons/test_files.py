"""Files are whole or not there, and no file of a user is replaced."""

import os
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons import files  # faults of a disk are made here
from comparisons.cli import main
from comparisons.scene import load_scene, to_toml
from tests.comparisons.processes import begun


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "a.txt"

    def fail() -> None:
        with files.replacing(path) as temporary:
            assert temporary.suffix == path.suffix
            temporary.write_text("half")
            raise RuntimeError("power cut")

    for old in (None, "old"):
        if old:
            files.write_text(path, old)
        there = {file.name: file.read_text() for file in tmp_path.iterdir()}
        with pytest.raises(RuntimeError, match="power cut"):
            fail()
        assert {file.name: file.read_text() for file in tmp_path.iterdir()} == there
    assert there.keys() == {"a.txt", ".crossval"}
    files.write_text(path, "new")
    assert path.read_text() == "new"


def test_places_that_cannot_be_written_are_named_and_a_link_is_followed(tmp_path):
    (tmp_path / "file").write_text("")
    os.mkfifo(tmp_path / "pipe")
    for name in ("file", "file/below", "nul\0l"):
        with pytest.raises(ValueError, match="cannot be written"):
            files.writable_folder(tmp_path / name)
    for name in (".", "pipe", "none/a.json"):
        with pytest.raises(ValueError, match="cannot be written"):
            files.result_file(tmp_path / name)
    target, link = tmp_path / "target.json", tmp_path / "link.json"
    files.write_text(target, "old")
    link.symlink_to(target)
    files.write_text(files.result_file(link), "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


HOLD = """
import sys, time
from pathlib import Path
from comparisons.files import alone_in
with alone_in(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(float(sys.argv[2]))
"""


def test_a_lock_ends_with_its_process(tmp_path):
    """Another one waits until then, and no longer, and no file stays."""
    with begun(HOLD, tmp_path, 600) as first:
        try:
            assert first.stdout.readline() == "held\n"
            with begun(HOLD, tmp_path, 0) as second:
                with pytest.raises(subprocess.TimeoutExpired):
                    second.wait(1.0)
                first.kill()
                assert second.communicate(timeout=60)[0] == "held\n"
        finally:
            first.kill()
    assert not list(tmp_path.iterdir())


HERE = "of a user"
"""What a command must leave alone."""
INTO_A_FILE = """check s.toml --out FILE.json
check s.toml --out FILE.png
solve s.toml --out FILE.csv
solve s.toml --out FILE.svg
certify s.toml --out FILE.json
compare s.toml --max-error force=1 --out FILE.xml"""
INTO_A_FOLDER = {
    "compare s.toml --out": ("report.html", "budget.json", "tsm/tsm.pvd", "solid/solid-0002.vtm"),
    "view s.toml --out": ("view.png", "view.gif"),
    "run trade s.toml --quick --out": ("trade.csv", "report.html"),
    "compare s.toml tip-load --out": ("league.svg", "report.html"),
    "run fig8 --quick --out": ("report.html",),
    "run extremes --quick --out": ("extremes.csv",),
    "run locking --out": ("locking.csv",),
    "run manual roll-up --quiet --out": ("index.md", "roll-up.svg", "junit.xml"),
    "run bench --quiet --out": ("scenes.json", "tsm.json"),
}


@pytest.fixture
def scene(in_folder: Path) -> str:
    text = to_toml(replace(load_scene("tip-load"), load_parameters=2))
    Path("s.toml").write_text(text)
    return text


@pytest.mark.slow_at(*(line for line in INTO_A_FILE.splitlines() if re.match("solve .*svg", line)))
@pytest.mark.parametrize("line", INTO_A_FILE.splitlines())
def test_no_file_of_a_user_is_replaced(line, scene, capsys):
    """The scene itself among them; and the same command replaces what it wrote, until that is edited."""

    def ended(file: str) -> int:
        return main([file if word.startswith("FILE") else word for word in line.split()])

    mine = Path(re.findall(r"FILE\S*", line)[0].replace("FILE", "mine"))
    mine.write_text(HERE)
    for file, there in ((str(mine), HERE), ("s.toml", scene)):
        assert ended(file) == 2
        (error,) = capsys.readouterr().err.splitlines()
        assert re.search(r"is there already, and is not as crossval wrote it|must end in", error)
        assert Path(file).read_text() == there
    mine.unlink()
    assert ended(str(mine)) == ended(str(mine)) == 0
    with mine.open("a") as file:
        file.write("edited")
    assert ended(str(mine)) == 2
    assert "is there already" in capsys.readouterr().err
    assert mine.read_bytes().endswith(b"edited")


@pytest.mark.usefixtures("scene")
@pytest.mark.slow_at("run bench --quiet --out")
@pytest.mark.parametrize("line", INTO_A_FOLDER)
def test_a_folder_of_a_user_is_left_alone(line, capsys):
    """Before anything is computed, but for a few files whose names are not known by then."""
    for number, name in enumerate(INTO_A_FOLDER[line]):
        mine = Path(str(number), name)
        mine.parent.mkdir(parents=True)
        mine.write_text(HERE)
        assert main([*line.split(), str(number)]) == 2
        error = capsys.readouterr().err.splitlines()[-1]
        assert error.startswith(f"crossval: {mine}: is there already, and is not as crossval wrote it")
        assert mine.read_text() == HERE


@pytest.mark.usefixtures("scene")
def test_an_answer_is_not_replaced_by_its_certificate_nor_a_new_scene_by_anything(capsys):
    assert main(["solve", "s.toml", "--out", "a.json"]) == main(["new", "mine", "--like", "tip-load"]) == 0
    for line, file, told in (
        ("certify a.json --scene s.toml --out ./a.json", "a.json", "is the answer to be judged"),
        ("check mine.toml --out mine.toml", "mine.toml", "must end in"),
    ):
        there = Path(file).read_bytes()
        assert main(line.split()) == 2
        assert f"{file}: {told}" in capsys.readouterr().err
        assert Path(file).read_bytes() == there

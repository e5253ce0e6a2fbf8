"""What goes wrong around a run: signals, company, no room, no permission, a missing library. Each really happens."""

import json
import os
import random
import re
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import meshio
import pytest

# no command writes a file without a solution, and a file that is replaced must be this program's own
from comparisons.files import WRITTEN, write_text
from tests.comparisons.processes import COMMAND, begun, ended

HERE = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
SOLVE = ["solve", "ks-cantilever", "--model", "tsm"]
KIB = 1024


def crossval(*arguments: str, setup: str = "", **options: Any) -> tuple[int, str]:
    """Run ``crossval`` after a statement; return its exit status and standard error."""
    found = ended(f"{setup}\n{COMMAND}", *arguments, **options)
    return found.returncode, found.stderr


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir() if not path.name.startswith(".")}


WRITE = """
from dataclasses import replace
from pathlib import Path
from comparisons.report.export import write_series
from comparisons.files import write_text
from comparisons.models import solve
from comparisons.scene import load_scene
from comparisons.answer.file import as_json
scene = replace(load_scene("ks-cantilever"), load_parameters=12)
response = solve(scene, "tsm")
text = as_json(response)

def write():
    write_text(Path("a.json"), text)
    write_series(Path(), response, scene)

write()  # all is imported now; a callback of Python's own import loses an interrupt
print("ready", flush=True)
while True:
    write()
"""


def interrupted_while_writing(folder: Path, how: signal.Signals, after: float) -> None:
    with begun(WRITE, cwd=folder) as child:
        assert child.stdout is not None
        try:
            assert child.stdout.readline() == "ready\n"
            time.sleep(after)
            child.send_signal(how)
            assert child.wait(60) == -how
        finally:
            child.kill()


def check_whole(folder: Path) -> int:
    """Read every file with a name of its own; return their number."""
    for path in folder.glob("[!.]*"):
        if path.suffix == ".json":
            assert json.loads(path.read_text())["status"] == "COMPLETED"
        elif path.suffix == ".vtu":
            assert len(meshio.read(path).points) > 0
        else:
            files = listed(path)
            assert None not in files
            assert {name for name in files if name} <= names(folder)
    return len(names(folder))


def listed(path: Path) -> set[str | None]:
    """Return the files that a collection of VTK files names."""
    return {item.get("file") for item in ET.parse(path).iter("DataSet")}  # noqa: S314 - our own


@pytest.mark.parametrize("times", [1, pytest.param(8, marks=pytest.mark.slow)])
def test_files_are_whole_or_absent_when_interrupted(times, tmp_path):
    """Kill and interrupt in turn, at random points of as many equal parts of the time of some writes."""
    draw = random.Random(times)  # noqa: S311 - no secret
    for number in range(times):
        how = (signal.SIGKILL, signal.SIGINT)[number % 2]
        place = tmp_path / str(number)
        place.mkdir()
        interrupted_while_writing(place, how, 0.3 * (number + draw.random()) / times)
        assert check_whole(place) > 0
        if how is signal.SIGINT:
            assert {path.name for path in place.glob(".*")} == {WRITTEN}


def test_interrupt_is_one_line(tmp_path):
    with begun(COMMAND, "compare", "ks-cantilever", "--out", str(tmp_path / "out")) as child:
        assert child.stderr is not None
        assert child.stderr.readline().startswith("[1/")
        child.send_signal(signal.SIGINT)
        lines = [line for line in child.stderr.read().splitlines() if not line.startswith("[")]
    assert lines == ["crossval: interrupted"]
    assert child.returncode == 130
    assert not names(tmp_path / "out")


@pytest.mark.slow
def test_two_runs_into_one_folder(tmp_path):
    """Of different lengths: the files are those of the one that wrote last, whole."""
    text = (Path(sys.modules["comparisons"].__path__[0]) / "scene/scenes/ks-cantilever.toml").read_text()
    children = []
    for steps in (7, 23):
        scene = tmp_path / f"{steps}.toml"
        scene.write_text(re.sub(r"load_parameters = \d+", f"load_parameters = {steps}", text))
        arguments = ["solve", str(scene), "--model", "tsm", "--out", str(tmp_path / "vtk")]
        children += [begun(COMMAND, *arguments) for _ in range(2)]
    for child in children:
        assert child.communicate(timeout=300)[1] == ""
        assert child.returncode == 0
    folder = tmp_path / "vtk"
    check_whole(folder)
    states = {name for name in names(folder) if name.endswith(".vtm")}
    assert len(states) in (7, 23)
    assert listed(folder / "tsm.pvd") == states
    blocks = set[str | None]().union(*(listed(folder / name) for name in states))
    assert blocks == names(folder) - states - {"tsm.pvd"}
    assert {path.name for path in folder.glob(".*")} == {WRITTEN}


FULL = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))"


@pytest.mark.slow_at("options0-2048-a.json")
@pytest.mark.parametrize(
    ("options", "size", "file"),
    [(["--out", "a.json"], 2 * KIB, "a.json"), (["--out", "v"], KIB, "v/tsm-0001-0.vtu")],
)
def test_no_room_for_a_file(options, size, file, in_folder):
    (in_folder / "v").mkdir()
    kept = {"tsm-pin.vtu" if "v" in options else file}
    for name in kept:
        write_text(in_folder / name, "kept")
    list_of_them = (in_folder / WRITTEN).read_text()
    status, err = crossval(*SOLVE, *options, setup=FULL.format(size=size))
    assert (status, err.count("\n")) == (2, 1)
    assert re.fullmatch(rf"crossval: \S*{file}: cannot be written: File too large\n", err)
    there = {path.name: path.read_text() for path in in_folder.rglob("*") if path.is_file()}
    assert there.pop(WRITTEN) == list_of_them
    assert there == dict.fromkeys(kept, "kept")


@pytest.mark.slow_at("arguments1-", "arguments1-1")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("arguments", [["scenes"], [*SOLVE, "--out", "-"]])
def test_no_room_on_standard_output(arguments, unbuffered):
    with Path("/dev/full").open("w") as full:
        end = crossval(*arguments, stdout=full.fileno(), env={"PYTHONUNBUFFERED": unbuffered})
    assert end == (2, "crossval: output: No space left on device\n")


@pytest.mark.slow_at("2>&--end1")
@pytest.mark.parametrize(
    ("closed", "end"),
    [
        (">&-", (2, "", "crossval: output: standard output is closed\n")),
        ("2>&-", (0, "ks", "")),
        (">&- 2>&-", (2, "", "")),
    ],
)
def test_closed_streams(closed, end, tmp_path):
    """Nothing is computed for nobody; and no file gets the number of the closed stream."""
    shell = ["/bin/sh", "-c", f'exec "$@" {closed}', "sh", sys.executable, "-c", COMMAND]
    found = subprocess.run(
        [*shell, *SOLVE, "--out", "a.json"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env=HERE,
        check=False,
        timeout=300,
    )
    assert (found.returncode, found.stdout[:2], found.stderr) == end
    assert (tmp_path / "a.json").exists() is (end[0] == 0)


NO_CLUSTER = ["run", "s.toml", "--out", "out", "--workers", "tcp://127.0.0.1:1"]


@pytest.mark.slow_at("skfem", "distributed")
@pytest.mark.parametrize("library", ["numpy", "skfem", "distributed"])
def test_a_missing_library(library, in_folder):
    Path("s.toml").write_text('[study]\nname = "s"\nscene = "ks-cantilever"\n[[run]]\nmodel = "rod"\n')
    arguments = {"skfem": [*SOLVE[:-1], "solid"], "distributed": NO_CLUSTER}.get(library, SOLVE)
    status, err = crossval(*arguments, setup=f"import sys; sys.modules['{library}'] = None")
    assert (status, err.count("\n")) == (2, 1)
    cure = "install tsm-crossval[cluster]" if library == "distributed" else "install tsm-crossval again"
    assert cure in err
    assert library == "distributed" or re.match(rf"crossval: {library}\S*: cannot be imported, ", err)

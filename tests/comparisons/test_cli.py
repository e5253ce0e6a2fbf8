"""The command ``crossval``: exit statuses, messages, files; never a traceback."""

import json
import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.scene import built_in_scenes

KS = built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 4")


@pytest.fixture
def scene(tmp_path: Path) -> str:
    path = tmp_path / "my.toml"
    path.write_text(KS)
    return str(path)


def run(*arguments: str) -> int:
    """Return the exit status, argparse's own included."""
    try:
        return main(list(arguments))
    except SystemExit as exit_:
        return int(exit_.code or 0)


def test_scenes_and_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("scenes") == 0
    listed = capsys.readouterr().out.split()
    assert listed == sorted(built_in_scenes())
    assert {"ks-cantilever", "ks-face", "ks-tied-tip"} <= set(listed)
    assert run("--version") == 0
    assert capsys.readouterr().out == f"crossval {metadata.version('tsm-crossval')}\n"


@pytest.mark.slow_at("options0", "options2")
@pytest.mark.parametrize(
    "options",
    [
        ["--model", "tsm", "--elements", "7", "--element", "timoshenko"],
        ["--model", "tsm", "--element", "exact", "--integration-tolerance", "1e-6"],
        ["--model", "solid", "--mesh", "16x1"],
        ["--model", "rod"],
        ["--model", "elastica"],
    ],
)
def test_solve_prints_a_summary_or_json(
    scene: str, options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("solve", scene, *options) == 0
    assert "COMPLETED" in capsys.readouterr().out
    assert run("solve", scene, *options, "--json", "-") == 0
    data = json.loads(capsys.readouterr().out)
    assert data["model"] == options[1]
    assert data["load_parameter"] == [0.25, 0.5, 0.75, 1.0]


def test_solve_writes_json_and_vtk(scene: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [
        "solve",
        scene,
        "--model",
        "tsm",
        "--json",
        str(tmp_path / "a.json"),
        "--vtk",
        str(tmp_path / "vtk"),
    ]
    assert run(*arguments) == 0
    assert json.loads((tmp_path / "a.json").read_text())["status"] == "COMPLETED"
    assert len(list((tmp_path / "vtk").glob("*.vtm"))) == 4
    assert len(list((tmp_path / "vtk").glob("*.vtu"))) == 12
    assert capsys.readouterr().err == ""


BAD = {
    "no command": [],
    "unknown model": ["solve", "SCENE", "--model", "nosuch"],
    "no elements": ["solve", "SCENE", "--model", "tsm", "--elements", "0"],
    "negative elements": ["solve", "SCENE", "--model", "tsm", "--elements", "-3"],
    "elements as text": ["solve", "SCENE", "--model", "tsm", "--elements", "ten"],
    "too many elements": ["solve", "SCENE", "--model", "tsm", "--elements", "1000001"],
    "unknown element": ["solve", "SCENE", "--model", "tsm", "--element", "nosuch"],
    "tolerance of an element without one": [
        "solve",
        "SCENE",
        "--model",
        "tsm",
        "--integration-tolerance",
        "1e-9",
        "--element",
        "mixed",
    ],
    "tolerance as text": [
        "solve",
        "SCENE",
        "--model",
        "tsm",
        "--element",
        "exact",
        "--integration-tolerance",
        "sharp",
    ],
    "tolerance below round-off": [
        "solve",
        "SCENE",
        "--model",
        "tsm",
        "--element",
        "exact",
        "--integration-tolerance",
        "1e-17",
    ],
    "elements for the rod": ["solve", "SCENE", "--model", "rod", "--elements", "3"],
    "mesh for beams": ["solve", "SCENE", "--model", "tsm", "--mesh", "3x3"],
    "half a mesh": ["solve", "SCENE", "--model", "solid", "--mesh", "50"],
    "flat mesh": ["solve", "SCENE", "--model", "solid", "--mesh", "50x0"],
    "coarse mesh": ["solve", "SCENE", "--model", "solid", "--mesh", "1x1"],
    "missing file": ["solve", "nosuch.toml", "--model", "tsm"],
    "json without folder": ["solve", "SCENE", "--model", "tsm", "--json", "DIR/none/a.json"],
    "csv without folder": ["solve", "SCENE", "--csv", "DIR/none/a.csv"],
    "picture of another format": ["solve", "SCENE", "--plot", "DIR/a.gif"],
    "json is a folder": ["solve", "SCENE", "--model", "tsm", "--json", "DIR"],
    "vtk is a file": ["solve", "SCENE", "--model", "tsm", "--vtk", "SCENE"],
    "out is a file": ["compare", "SCENE", "--out", "SCENE"],
    "compare a missing file": ["compare", "nosuch.toml"],
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_status_2_with_one_reason(
    case: str, scene: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = [part.replace("SCENE", scene).replace("DIR", str(tmp_path)) for part in BAD[case]]
    assert run(*arguments) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert sum(line.startswith("crossval") for line in err.splitlines()) == 1
    assert "Traceback" not in err
    assert [path.name for path in tmp_path.iterdir()] == ["my.toml"]


def test_bad_scene_overwrites_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, result = tmp_path / "bad.toml", tmp_path / "a.json"
    path.write_text(KS.replace("height = 0.02", "height = -0.02"))
    result.write_text("kept")
    assert run("solve", str(path), "--model", "tsm", "--json", str(result)) == 2
    assert capsys.readouterr().err == f"crossval: {path}: beam[0].height = -0.02: must be positive\n"
    assert result.read_text() == "kept"


def test_model_that_cannot_state_the_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "area.toml"
    path.write_text(
        KS.replace("width = 0.02", "area = 4e-4").replace("height = 0.02", "second_moment = 1.3333e-6")
    )
    assert run("solve", str(path), "--model", "solid") == 2
    assert (
        capsys.readouterr().err
        == 'crossval: solid: the solid model needs the width and height of beam "cantilever": the rectangle of its area '
        "and second moment is 0.2 high, more than an eighth of the length\n"
    )
    assert run("solve", str(path), "--model", "tsm") == 0


def test_a_stopped_solution_is_status_3_and_keeps_what_was_reached(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, result = tmp_path / "slip.toml", tmp_path / "a.json"
    pin = "start = [0.9, 0.0]\ndisplacement = [0.0, 0.6]"
    scene = KS.replace("start = [1.0, 0.0]\ndisplacement = [-1.0, 0.6366197723675814]", pin)
    path.write_text(scene.replace('side = "right"', 'side = "right"\nkeep = true'))
    assert run("solve", str(path), "--model", "solid", "--mesh", "16x1", "--json", str(result)) == 3
    err = capsys.readouterr().err
    assert "LOST_CONTACT" in err
    assert "2 of 4 load parameters reached" in err
    data = json.loads(result.read_text())
    assert (data["status"], data["load_parameter"]) == ("LOST_CONTACT", [0.25, 0.5])


def child(*arguments: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False)


def test_help_loads_nothing_heavy() -> None:
    code = """
import sys
from comparisons.cli import main
try:
    main(["--help"])
except SystemExit as done:
    assert done.code == 0
heavy = {"numpy", "scipy", "skfem", "meshio", "pyvista", "matplotlib"} & set(sys.modules)
assert not heavy, heavy
"""
    done = child("-c", code)
    assert done.returncode == 0, done.stderr
    assert "exit status" in done.stdout


def test_installed_command_runs() -> None:
    command = Path(sys.executable).with_name("crossval")
    done = subprocess.run(
        [command, "scenes"], capture_output=True, text=True, check=False, env={"PATH": os.defpath}
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "ks-cantilever" in done.stdout


@pytest.mark.slow
def test_a_reader_that_stops_early_is_no_error() -> None:
    command = "crossval solve ks-cantilever --model rod --json - | head -1"
    path = {"PATH": f"{Path(sys.executable).parent}:/usr/bin:/bin"}
    run = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, env=path, check=False
    )
    assert run.stdout.strip() == "{"
    assert run.stderr == ""


def test_solve_to_an_accuracy(scene: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("solve", scene, "--accuracy", "1e-3", "--explain") == 0
    out, err = capsys.readouterr()
    assert "tsm: exact elements, one a beam, 10 unknowns" in out
    assert "beam theory itself" in out
    assert "exact rods suffice" in err
    assert (
        run("solve", scene, "--accuracy", "1e-4", "--quantity", "arc", "--element", "mixed", "--json", "-")
        == 0
    )
    data = json.loads(capsys.readouterr().out)
    assert data["accuracy"]["quantity"] == "arc"
    assert data["accuracy"]["reached"]
    assert 0 < data["accuracy"]["estimate"] <= 1e-4
    assert data["unknowns"] > 10


@pytest.mark.parametrize(
    ("options", "status", "sentence"),
    [
        (["--accuracy", "1e-12"], 3, "ACCURACY_NOT_REACHED: estimated error"),
        (["--accuracy", "1e-3", "--mesh", "5x2"], 2, "--mesh: is what --accuracy chooses"),
        (["--accuracy", "1e-3", "--model", "rod"], 2, "model = rod: has no resolution to choose"),
        (["--model", "tsm", "--quantity", "force"], 2, "--quantity: belongs to --accuracy"),
        (["--model", "tsm", "--explain"], 2, "--explain: belongs to --accuracy"),
        (["--accuracy", "0"], 2, "must lie between 0 and 1"),
    ],
)
def test_what_an_accuracy_refuses(
    scene: str, options: list[str], status: int, sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("solve", scene, *options) == status
    assert sentence in capsys.readouterr().err

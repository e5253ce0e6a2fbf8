"""Scenes whose solution stops: exit status 3 with the named reason, and what was reached is kept."""

import json
from pathlib import Path

import pytest

from comparisons.cli import main

BEAM = """[scene]
name = "stop"
load_parameters = 10
[[beam]]
name = "beam"
start = [0.0, 0.0]
end = [1.0, 0.0]
area = 4e-4
second_moment = 1.3333333333333333e-8
youngs_modulus = 2.1e4
shear_modulus = 8.0769e3
elements = 10
"""
CLAMPED = BEAM + 'clamped = ["start"]\n'


def pin(path: str, name: str = "pin", keep: str = "false") -> str:
    contact = f'[[contact]]\nnode = "{name}"\nbeam = "beam"\nside = "right"\nkeep = {keep}\n'
    return f'[[pin]]\nname = "{name}"\npath = {path}\n' + contact


UP, OFF, BACK = (
    "[[0.9, 0.0], [0.9, 0.3]]",
    "[[0.9, 0.0], [0.9, 0.6]]",
    "[[0.9, 0.0], [0.9, 0.2], [0.9, -0.1]]",
)
BEHIND = "[[0.5, 0.0], [0.5, 0.1], [-0.3, 0.1]]"
STOPS = {
    "release of a contact that must persist": ("LOST_CONTACT", CLAMPED + pin(BACK, keep="true"), ["tsm", "rod", "elastica"], 8),
    "slip-off of a contact that must persist": ("SLIPPED_OFF", CLAMPED + pin(OFF, keep="true"), ["tsm", "rod", "elastica"], 6),
    "pin behind the last equilibrium": ("LIMIT_POINT", CLAMPED + pin(BEHIND), ["tsm"], 6),
    "no equilibrium of the rod": ("LOST", CLAMPED + pin(BEHIND), ["rod"], 6),
    "slid along to the clamp": ("FOLDED", CLAMPED + pin("[[0.5, 0.0], [-0.5, 0.0]]"), ["tsm"], 5),
    "pin on a node of the paper's elements": ("CUTBACK_FLOOR", CLAMPED + pin("[[0.5, 0.0], [0.5, 0.1]]"), ["tsm --element timoshenko"], 0),
    "two nodes on one element of the paper's": (
        "TWO_CONTACTS",
        CLAMPED + pin("[[0.93, 0.0], [0.93, 0.3]]") + pin("[[0.97, 0.0], [0.97, 0.4]]", name="other"),
        ["tsm --element timoshenko"],
        0,
    ),
}  # fmt: skip


def solve(text: str, model: str, folder: Path) -> tuple[int, dict[str, object]]:
    scene, result = folder / "scene.toml", folder / "result.json"
    scene.write_text(text)
    name, *options = model.split()
    status = main(["solve", str(scene), "--model", name, *options, "--json", str(result)])
    return status, json.loads(result.read_text())


@pytest.mark.parametrize(
    ("case", "model"), [(case, model) for case, (_, _, models, _) in STOPS.items() for model in models]
)
def test_a_stop_has_its_name_and_status_3(
    case: str, model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, text, _, reached = STOPS[case]
    status, data = solve(text, model, tmp_path)
    assert (status, data["status"]) == (3, name)
    assert len(data["load_parameter"]) == reached  # type: ignore[arg-type]
    err = capsys.readouterr().err
    assert err.startswith(f"crossval: {name}: ")
    assert err.endswith(f"{reached} of 10 load parameters reached\n")
    rigid = 'the contact lies on a node, where elements "timoshenko" are rigid: try '
    assert (rigid in err) == (case == "pin on a node of the paper's elements")


@pytest.mark.parametrize("path", [UP, BACK, OFF])
def test_without_keep_a_lost_contact_is_no_stop(path: str, tmp_path: Path) -> None:
    status, data = solve(CLAMPED + pin(path), "tsm", tmp_path)
    assert (status, data["status"]) == (0, "COMPLETED")


@pytest.mark.parametrize("model", ["tsm", "rod"])
def test_keep_does_not_stop_a_contact_that_persists(model: str, tmp_path: Path) -> None:
    status, data = solve(CLAMPED + pin(UP, keep="true"), model, tmp_path)
    assert (status, data["status"]) == (0, "COMPLETED")

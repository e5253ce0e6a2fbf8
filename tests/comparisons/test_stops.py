"""Scenes whose solution stops: exit status 3 with the named reason, and what was reached is kept."""

import json
from pathlib import Path

import pytest

from comparisons.cli import main

BEAM = """scene = { name = "stop", load_parameters = 10 }
beam = [{ name = "beam", start = [0.0, 0.0], end = [1.0, 0.0], area = 4e-4, second_moment = 1.3333333333333333e-8, youngs_modulus = 2.1e4, shear_modulus = 8.0769e3, elements = 10, clamped = ["start"] }]
"""
UP, OFF = "[[0.9, 0.0], [0.9, 0.3]]", "[[0.9, 0.0], [0.9, 0.6]]"
BACK, BEHIND = "[[0.9, 0.0], [0.9, 0.2], [0.9, -0.1]]", "[[0.5, 0.0], [0.5, 0.1], [-0.3, 0.1]]"


def pin(path: str, keep: str = "false") -> str:
    contact = f'[[contact]]\nnode = "pin"\nbeam = "beam"\nside = "right"\nkeep = {keep}\n'
    return f'[[pin]]\nname = "pin"\npath = {path}\n{contact}'


KEPT = ["tsm", "rod", "elastica"]
STOPS = {
    "release of a contact that must persist": ("LOST_CONTACT", pin(BACK, keep="true"), KEPT, 8),
    "slip-off of a contact that must persist": ("SLIPPED_OFF", pin(OFF, keep="true"), KEPT, 6),
    "slip-off of the solid": ("LOST_CONTACT", pin(OFF, keep="true"), ["solid --mesh 16x1"], 6),
    "no equilibrium of the rod": ("LOST", pin(BEHIND), ["rod"], 6),
    "a contact that persists as it must": ("COMPLETED", pin(UP, keep="true"), ["tsm", "rod"], 10),
}  # fmt: skip


@pytest.mark.parametrize(
    ("case", "model"), [(case, model) for case, row in STOPS.items() for model in row[2]]
)
def test_a_stop_has_its_name_and_status_3(case, model, in_folder, capsys):
    name, contacts, _, reached = STOPS[case]
    Path("a.toml").write_text(BEAM + contacts)
    status = main(["solve", "a.toml", "--model", *model.split(), "--out", "a.json"])
    data = json.loads(Path("a.json").read_text())
    assert (status, data["status"]) == (0 if name == "COMPLETED" else 3, name)
    assert len(data["load_parameter"]) == reached
    err = capsys.readouterr().err
    assert err == "" if status == 0 else err.startswith(f"crossval: {name}: ")
    assert status == 0 or err.endswith(f"{reached} of 10 load parameters reached\n")

"""What a certificate knows of load parameters at which no equilibrium is sought, and of an answer that reached none."""

from dataclasses import replace

import numpy as np

from comparisons.cli import main
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import Verdict, certify
from comparisons.response import Response
from comparisons.scene import load_scene, to_toml


def weakened(response: Response, kept: list[float], factor: float) -> Response:
    """Multiply all forces away from the kept load parameters: they balance as before."""
    part = np.where(np.isin(response.load_parameter, kept), 1.0, factor)
    contacts = {
        pair: replace(
            item,
            force=part * item.force,
            vector=None if item.vector is None else part[:, None] * item.vector,
        )
        for pair, item in response.contacts.items()
    }
    supports = {
        end: replace(item, force=part[:, None] * item.force, moment=part * item.moment)
        for end, item in response.supports.items()
    }
    return replace(response, contacts=contacts, supports=supports, material_force={})


def test_forces_at_load_parameters_that_are_not_judged_do_the_work_that_is_stored():
    """By default two of fifty load parameters are judged; all others hold nine tenths of their forces."""
    scene = load_scene("crossed-beams")
    answer = solve(scene, "tsm", Options(element="exact"))
    right = certify(answer, scene)
    assert right.certified
    found = certify(weakened(answer, [item.load_parameter for item in right.judged], 0.9), scene)
    assert found.verdict is Verdict.NOT_AN_EQUILIBRIUM
    assert found.reason.startswith("the work of supports, pins and loads is not the strain energy")


def test_an_answer_that_reached_nothing_is_not_judged(tmp_path, capsys):
    """A round pin meets the end of the beam before the first load parameter."""
    scene = load_scene("ks-cantilever")
    pin = replace(scene.pins[0], start=(1.002, 0.0), displacement=(-0.01, 0.0), radius=0.001)
    file = tmp_path / "end.toml"
    file.write_text(to_toml(replace(scene, pins=(pin,), load_parameters=2)))
    assert main(["certify", str(file)]) == 3
    assert "NOT_JUDGED" in capsys.readouterr().out

"""Scenes with natural curvature, taper, weight and loads along a beam, by beams."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import MODELS, certified, solve
from comparisons.models.options import ModelError, Options
from comparisons.models.translate import to_structure
from comparisons.scene import read_scene

HOOK = """
scene = { name = "hook", load_parameters = 2, gravity = [0.5, -9.81] }
pin = [{ name = "pin", start = [0.3, 0.15], displacement = [0, -0.2] }]
contact = [{ node = "pin", beam = "strip", side = "left" }]
load = [
  { beam = "strip", force_per_length = [0, -10], part = [0.3, 0.6] },
  { beam = "strip", at = 0.8, force = [0, 3], moment = 0.1 },
]

[[beam]]
name = "strip"
start = [0, 0]
end = [0.4, 0.1]
turn = -1.2
clamped = ["start"]
width = [0.02, 0.01]
height = [0.004, 0.002]
youngs_modulus = 2e11
poissons_ratio = 0.3
density = 7850
"""
EXACT = Options(element="exact")


def scene(**strip):
    loaded = read_scene(HOOK, "hook")
    return replace(loaded, beams=(replace(loaded.beams[0], **strip),))


def test_undeformed_axis_and_stresses_of_the_grid():
    spec = scene().beams[0]
    data = solve(scene(), "tsm", EXACT).grid(-1)
    arc = data.point_data["arc"] / spec.length
    reference = np.array([spec.place(part) for part in arc])
    assert np.abs(data.points - reference).max() <= 1e-15
    width, height = 0.02 - 0.01 * arc, 0.004 - 0.002 * arc
    N, M = data.point_data["N"], data.point_data["M"]
    left = N / (width * height) - 6 * M / (width * height**2)
    assert np.abs(data.point_data["axial_stress_left"] - left).max() <= 1e-12 * np.abs(left).max()
    assert np.abs(M).max() > 0.1


def test_what_elements_and_contacts_do_not_state_is_refused_in_one_line():
    with pytest.raises(ModelError, match=r"such elements are straight and uniform.*; use "):
        solve(scene(), "tsm", Options(element="timoshenko"))
    rubbed = replace(scene(), contacts=(replace(scene().contacts[0], surface="face", friction=0.2),))
    why = 'does not state friction on the face of a beam whose height tapers; use --model solid, surface = "axis" or one height'
    for model in ("tsm", "rod"):
        assert why in MODELS[model].refusal(rubbed)
        with pytest.raises(ModelError, match=why):
            solve(rubbed, model, EXACT if model == "tsm" else Options())


@pytest.mark.parametrize("element", ["exact", "mixed"])
def test_a_round_pin_on_the_face_of_a_taper_is_certified(element):
    """The referee makes the same face in another way. The face of a straight taper lies at half the height."""
    round_pin = replace(scene().pins[0], radius=0.01, displacement=(0.0, -0.12))
    thick = scene(height=(0.012, 0.004))
    contact = replace(scene().contacts[0], surface="face")
    on_face = replace(thick, pins=(round_pin,), contacts=(contact,))
    given = solve(on_face, "tsm", Options(element=element))
    answer = certified(given, on_face, allowance=1e-9 if element == "exact" else 1e-6)
    assert (answer.certificate.verdict.name, answer.completed) == ("CERTIFIED", True)
    straight = replace(on_face, beams=(replace(thick.beams[0], turn=0.0),))
    pair = to_structure(straight, element=element).contacts[0]
    axis, steep = 0.3, (pair.end_offset - pair.offset) / straight.beams[0].length
    beyond = pair.offset + steep * axis - 0.01
    # the envelope touches a circle ahead of its centre
    height = straight.beams[0].height_at((axis - beyond * steep) / straight.beams[0].length)
    assert beyond * (1 - steep**2) ** 0.5 == pytest.approx(height / 2, rel=1e-12)

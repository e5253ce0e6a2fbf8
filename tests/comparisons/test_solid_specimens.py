"""Loads along a beam, weight, taper, springs and hinges: the solid against the exact rod."""

import re
from dataclasses import replace

import numpy as np
import pytest

from comparisons.models import solve
from comparisons.models.options import ModelError, Options
from comparisons.models.translate import to_solid
from comparisons.scene.read import read_scene

YOUNG, WIDTH = 2.1e9, 0.02
CLAMP = 'clamped = ["start"]\n'
LOAD = '[[load]]\nbeam = "s"\n'


def scene(height, *, size="", gravity="", conditions=CLAMP):
    """A strip of length 1. Forces are given in its EI over the squared length by ``{EI}``."""
    EI = YOUNG * WIDTH * height**3 / 12
    text = f"""[scene]
name = "specimen"
units = "N, m"
load_parameters = 2
{gravity}
[[beam]]
name = "s"
start = [0.0, 0.0]
end = [1.0, 0.0]
{size or f"width = {WIDTH}{chr(10)}height = {height}"}
youngs_modulus = {YOUNG}
poissons_ratio = 0.3
material = "biot-linear"
{conditions}"""
    for factor in ("-4", "-3", "3", "5"):
        text = text.replace(f"{factor} EI", repr(float(factor) * EI))
    return read_scene(text.replace("DENSITY", repr(3 * EI / (9.81 * WIDTH * height))), "s")


def tapered(height):
    return {"size": f"width = [{WIDTH}, 0.01]\nheight = [{height}, {0.6 * height}]"}


def over_arc(height, friction=""):
    """A round pin above the top of an arc that turns by -1.4."""
    top = 0.5 * (1 - np.cos(0.7)) / np.sin(0.7) + height / 2
    return (
        f'[[pin]]\nname = "p"\nstart = [0.5, {top + 0.0501}]\ndisplacement = [0.1, -0.2]\nradius = 0.05\n'
        f'[[contact]]\nnode = "p"\nbeam = "s"\nside = "left"\nsurface = "face"\n{friction}'
    )


CASES = {
    "line": lambda h: scene(h, conditions=CLAMP + LOAD + "force_per_length = [0.0, -3 EI]\n"),
    "part": lambda h: scene(
        h, conditions=CLAMP + LOAD + "force_per_length = [3 EI, -4 EI]\npart = [0.3, 0.73]\n"
    ),
    "at": lambda h: scene(h, conditions=CLAMP + LOAD + "at = 0.41\nforce = [0.0, -4 EI]\n"),
    "moment": lambda h: scene(
        h, conditions=CLAMP + LOAD + "at = 0.413\nforce = [0.0, 3 EI]\nmoment = -3 EI\n"
    ),
    "weight": lambda h: scene(h, gravity="gravity = [0.0, -9.81]", conditions=CLAMP + "density = DENSITY\n"),
    "taper": lambda h: scene(
        h,
        **tapered(h),
        gravity="gravity = [0.0, -9.81]",
        conditions=CLAMP + "density = DENSITY\n",
    ),
    "springs": lambda h: scene(
        h,
        conditions='[[support]]\nbeam = "s"\nend = "start"\nfixed = ["x"]\n'
        '[[spring]]\nbeam = "s"\nend = "start"\nstiffness = [0.0, 5 EI]\nrotation = 3 EI\n'
        '[[spring]]\nbeam = "s"\nend = "end"\nstiffness = [0.0, 3 EI]\n'
        + LOAD
        + "force_per_length = [0.0, -3 EI]\n",
    ),
    "turn": lambda h: scene(
        h, conditions="turn = -1.4\n" + CLAMP + LOAD + 'end = "end"\nforce = [3 EI, -3 EI]\n'
    ),
    "other end": lambda h: scene(
        h, conditions='turn = 1.0\nclamped = ["end"]\n' + LOAD + "force_per_length = [0.0, -3 EI]\n"
    ),
    "arc": lambda h: scene(h, conditions="turn = -1.4\n" + CLAMP + over_arc(h)),
    "sliding": lambda h: scene(h, conditions="turn = -1.4\n" + CLAMP + over_arc(h, "friction = 0.2\n")),
    "face": lambda h: scene(
        h,
        **tapered(h),
        conditions=CLAMP
        + f'[[pin]]\nname = "p"\nstart = [0.8, {0.05 + 0.341 * h}]\ndisplacement = [-0.1, -0.35]\nradius = 0.05\n'
        '[[contact]]\nnode = "p"\nbeam = "s"\nside = "left"\nsurface = "face"\n',
    ),
}


def difference(make, height, mesh):
    """Largest distance of the tips over the length, with forces of contacts and springs over their largest."""
    at = make(height)
    solid, rod = solve(at, "solid", Options(mesh=mesh)), solve(at, "tsm", Options(element="exact"))
    assert solid.completed
    assert rod.completed
    assert list(solid.index) == list(rod.index)
    found = [np.abs(solid.tips["s"] - rod.tips["s"]).max()]
    for name in ("contacts", "springs"):
        for key, one in getattr(rod, name).items():
            other = getattr(solid, name)[key]
            found.append(np.abs(other.force - one.force).max() / np.abs(one.force).max())
    return max(found)


@pytest.mark.parametrize("name", CASES)
def test_the_solid_is_the_rod(name):
    assert difference(CASES[name], 0.02, (40, 1)) < 1e-3


def test_a_frame_with_hinges_is_the_rods():
    """A moment on a joint that names a hinged end, a spring in a hinge, and a clamp with a hinge, which is a pinned end."""
    EI = YOUNG * WIDTH * 0.02**3 / 12
    beam = 'name = "{}"\nstart = {}\nend = {}\n'
    rest = f'width = {WIDTH}\nheight = 0.02\nyoungs_modulus = {YOUNG}\npoissons_ratio = 0.3\nmaterial = "biot-linear"\n'
    beams = [("a", [0.0, 0.0], [0.0, 1.0]), ("b", [0.0, 1.0], [1.0, 1.0]), ("c", [1.0, 1.0], [1.0, 0.0])]
    text = '[scene]\nname = "frame"\nunits = "N, m"\nload_parameters = 2\n'
    for name, start, end in beams:
        held = {"a": 'clamped = ["start"]\n', "b": "", "c": 'clamped = ["end"]\n'}[name]
        text += "[[beam]]\n" + beam.format(name, start, end) + rest + held
    text += f'[[hinge]]\nbeam = "b"\nend = "start"\nstiffness = {EI}\n[[hinge]]\nbeam = "c"\nend = "end"\n'
    text += f'[[load]]\nbeam = "b"\nend = "start"\nforce = [{EI / 2}, 0.0]\nmoment = {EI / 2}\n'
    frame = read_scene(text, "frame")
    solid, rod = solve(frame, "solid", Options(mesh=(40, 1))), solve(frame, "tsm", Options(element="exact"))
    for node, one in rod.supports.items():
        np.testing.assert_allclose(solid.supports[node].force, one.force, atol=1e-3 * EI)
        np.testing.assert_allclose(solid.supports[node].moment, one.moment, atol=1e-3 * EI)
    for name, tip in rod.tips.items():
        np.testing.assert_allclose(solid.tips[name], tip, atol=1e-4)


def test_what_the_solid_cannot_state_costs_one_line_that_names_another_way():
    """A clamp behind a hinge with a spring; a pinned end with a spring against its rotation has the same forces, in both models."""
    load = LOAD + 'end = "end"\nforce = [0.0, 3 EI]\n'
    hinge = '[[hinge]]\nbeam = "s"\nend = "start"\nstiffness = 5.0\n'
    spring = '[[support]]\nbeam = "s"\nend = "start"\nkind = "pinned"\n[[spring]]\nbeam = "s"\nend = "start"\nrotation = 5.0\n'
    hinged, other = scene(0.02, conditions=CLAMP + load + hinge), scene(0.02, conditions=spring + load)
    why = 'at an end without a hinge, the support "s.start" has one; use a pinned support and a [[spring]] with a rotation, or --model tsm'
    with pytest.raises(ModelError, match=re.escape(why)):
        to_solid(hinged)
    one, same = (solve(item, "tsm", Options(element="exact")) for item in (hinged, other))
    np.testing.assert_allclose(one.tips["s"], same.tips["s"], atol=1e-12)
    to_solid(other)
    full = replace(hinged, beams=(replace(hinged.beams[0], solid_clamp="full"),))
    with pytest.raises(ModelError, match=r'"s\.start" is another; use solid_clamp = "rod"'):
        to_solid(full)

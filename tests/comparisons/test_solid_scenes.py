"""The solid by its end sections, with the rod's law, against exact elements: the difference is of the order of the height squared."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.answer import Response
from comparisons.models import certified, solve
from comparisons.models.options import Options
from comparisons.scene import Scene, load_scene, read_scene

FINDINGS = Path(__file__).parent / "findings"
EXACT = Options(element="exact")


def scene(
    height: float, conditions: str, more: str = "", size: str = "", axis: str = "start = [0, 0]\nend = [1, 0]"
) -> Scene:
    """A strip "s" of length 1, EI = 1 where it is thickest; `more` are beams of the same section."""
    width = 12.0 / height**3
    section = "youngs_modulus = 1.0\npoissons_ratio = 0.3\nmesh = [50, 2]\nmaterial = 'biot-linear'\n"
    whole = size or f"width = {width}\nheight = {height}\n"
    text = f'[scene]\nname = "s"\nload_parameters = 4\n[[beam]]\nname = "s"\n{axis}\n{whole}{section}{conditions}\n{more}'
    return read_scene(text.replace("SECTION", whole + section), "s")


CLAMP = 'clamped = ["start"]\n'
END = '[[load]]\nbeam = "s"\nend = "end"\n'
LINE = '[[load]]\nbeam = "s"\nforce_per_length = '
HELD = '[[support]]\nbeam = "{}"\nend = "{}"\n'
PIN = '[[pin]]\nname = "{0}"\nstart = [{1}, {2}]\ndisplacement = [{3}, {4}]\n[[contact]]\nnode = "{0}"\nbeam = "{5}"\nside = "{6}"\n'


def tapered(height: float) -> dict[str, str]:
    width = 12.0 / height**3
    return {"size": f"width = [{width}, {width / 2}]\nheight = [{height}, {0.6 * height}]\n"}


def over_arc(height: float, friction: float = 0.0) -> str:
    """A round pin above the top of an arc that turns by -1.4."""
    top = 0.5 * (1 - np.cos(0.7)) / np.sin(0.7) + height / 2
    pin = PIN.format("p", 0.5, top + 0.0501, 0.1, -0.2, "s", "left")
    return (
        pin.replace("[[contact]]", "radius = 0.05\n[[contact]]")
        + f'surface = "face"\nfriction = {friction}\n'
    )


def raised(height: float) -> Scene:
    """A beam hinged at its middle that rests on two pins, which rise: only their contact keeps it from turning."""
    pins = PIN.format("p", -1.0, 0.0, 0.0, 0.5, "s", "right") + PIN.format(
        "q", 1.0, 0.0, 0.0, 0.5, "t", "right"
    )
    other = (
        '[[beam]]\nname = "t"\nstart = [0, 0]\nend = [1.5, 0]\nSECTION'
        + pins
        + HELD.format("s", "end")
        + 'kind = "pinned"\n'
    )
    return scene(height, "", other, axis="start = [-1.5, 0]\nend = [0, 0]")


CASES: dict[str, Callable[[float], Scene]] = {
    "moved clamp": lambda h: scene(h, CLAMP + HELD.format("s", "end") + 'fixed = ["y", "rotation"]\ndisplacement = [0.0, 0.4]\nrotation = 1.0\n'),
    "turned pins": lambda h: scene(h, HELD.format("s", "start") + 'kind = "pinned"\n' + HELD.format("s", "end") + 'kind = "pinned"\ndisplacement = [-0.1, 0.0]\n[[load]]\nbeam = "s"\nend = "start"\nmoment = 1.0\n'),
    "pushed between": lambda h: scene(h, CLAMP + HELD.format("s", "end") + 'kind = "roller"\nfree = "x"\n' + PIN.format("p", 0.4, 0.0, 0.0, 0.1, "s", "right")),
    "raised": raised,
    "driven tip": lambda h: scene(
        h, CLAMP, '[[beam]]\nname = "t"\nstart = [0.6, 1.0]\nend = [0.6, 0.1]\nSECTION[[contact]]\nnode = "t.end"\nbeam = "s"\nside = "left"\n'
        + HELD.format("t", "start") + 'kind = "clamped"\ndisplacement = [-0.1, -0.25]\nrotation = 0.5\n'
    ),
    "frame": lambda h: scene(
        h, CLAMP + END + "force = [0.0, 0.3]\nmoment = 0.2\n",
        '[[beam]]\nname = "t"\nstart = [1, 0]\nend = [1, 1]\nSECTION' + HELD.format("t", "end") + 'kind = "roller"\nfree = "x"\n'
    ),
    "part": lambda h: scene(h, CLAMP + LINE + "[3.0, -4.0]\npart = [0.3, 0.73]\n"),
    "inside": lambda h: scene(h, CLAMP + '[[load]]\nbeam = "s"\nat = 0.413\nforce = [0.0, 3.0]\nmoment = -3.0\n'),
    "other end": lambda h: scene(h, 'turn = 1.0\nclamped = ["end"]\n' + LINE + "[0.0, -3.0]\n"),
    "sliding on an arc": lambda h: scene(h, "turn = -1.4\n" + CLAMP + over_arc(h, 0.2)),
    "on a sloping face": lambda h: scene(
        h, CLAMP + PIN.format("p", 0.8, 0.05 + 0.341 * h, -0.1, -0.35, "s", "left").replace("[[contact]]", "radius = 0.05\n[[contact]]")
        + 'surface = "face"\n', **tapered(h)
    ),
    "hinges": lambda h: scene(
        h, CLAMP + '[[load]]\nbeam = "t"\nend = "start"\nforce = [0.5, 0.0]\nmoment = 0.5\n',
        '[[beam]]\nname = "t"\nstart = [0, 1]\nend = [1, 1]\nSECTION[[beam]]\nname = "u"\nstart = [1, 1]\nend = [1, 0]\nclamped = ["end"]\nSECTION'
        '[[hinge]]\nbeam = "t"\nend = "start"\nstiffness = 1.0\n[[hinge]]\nbeam = "u"\nend = "end"\n', axis="start = [0, 0]\nend = [0, 1]"
    ),
}  # fmt: skip


def values(response: Response) -> tuple[np.ndarray, np.ndarray]:
    """Forces of contacts, supports and springs (s, n), and moments (s, m), at every load parameter."""
    held = (*response.supports.values(), *response.springs.values())
    forces = [contact.force[:, None] for contact in response.contacts.values()] + [
        item.force for item in held
    ]
    return np.hstack(forces), np.stack([item.moment for item in held], axis=1)


def distance(case: Scene, mesh: tuple[int, int] | None = None) -> float:
    """Largest difference of a force or moment, over the largest of the path, and of the tips over the length; certified and stable."""
    exact, solid = solve(case, "tsm", EXACT), solve(case, "solid", Options(mesh=mesh))
    assert exact.completed, exact.message
    assert certified(solid, case).completed, solid.message
    assert list(solid.index) == list(exact.index)
    found = [np.abs(solid.tips[beam.name] - exact.tips[beam.name]).max() / beam.length for beam in case.beams]
    for a, b in zip(values(solid), values(exact), strict=True):
        found.append(np.abs(a - b).max() / (np.abs(b).max() or 1.0))
    return float(max(found))


@pytest.mark.slow_at("turned pins", "moved clamp", "pushed between", "raised")
@pytest.mark.slow_at("other end", "sliding on an arc")
@pytest.mark.parametrize("case", CASES)
def test_forces_and_reactions_are_the_rods(case):
    """Within a thousandth at h/L = .02."""
    assert distance(CASES[case](0.02), (40, 1)) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("case", ["moved clamp", "driven tip", "frame"])
def test_the_difference_falls_as_the_height_squared(case):
    thick, thin = distance(CASES[case](0.02)), distance(CASES[case](0.01), (100, 2))
    assert np.log2(thick / thin) == pytest.approx(2.0, abs=0.25)


def test_a_frame_of_a_user_is_the_rods():
    """A portal stated by area and second moment."""
    portal = load_scene(str(FINDINGS / "portal.toml"))
    beams = tuple(replace(item, material="biot-linear") for item in portal.beams)
    assert distance(replace(portal, beams=beams)) < 1e-4

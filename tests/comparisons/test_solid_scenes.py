"""Scenes that the solid states by its end sections: against exact elements, with the law of the rod."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from comparisons.models import certified, solve
from comparisons.models.options import Options
from comparisons.response import Response
from comparisons.scene import BeamSpec, ContactSpec, LoadSpec, PinSpec, Scene, SupportSpec, load_scene

FINDINGS = Path(__file__).parent / "findings"


def beam(name: str = "a", **changes: object) -> BeamSpec:
    """A beam of length one, EI = 1, with the law of the rod."""
    height = float(str(changes.pop("height", 0.02)))
    given = {"start": (0.0, 0.0), "end": (1.0, 0.0), "height": height, "width": 12.0 / height**3}
    stated = {"youngs_modulus": 1.0, "poissons_ratio": 0.3, "mesh": (50, 2), "material": "biot-linear"}
    return BeamSpec(name=name, **(given | stated | changes))  # type: ignore[arg-type]


def hold(name: str, end: str, kind: str, **changes: object) -> SupportSpec:
    return SupportSpec(beam=name, end=end, kind=kind, **changes)  # type: ignore[arg-type]


def scene(*beams: BeamSpec, **changes: object) -> Scene:
    return Scene(**({"name": "scene", "load_parameters": 4, "beams": beams} | changes))  # type: ignore[arg-type]


def tip_load(h: float) -> Scene:
    load = LoadSpec(beam="a", end="end", force=(-1.0, 3.0), moment=-1.0)
    return scene(beam(height=h, clamped=("start",)), loads=(load,))


def moved_clamp(h: float) -> Scene:
    """One end is moved across and turned, and slides along."""
    moved = SupportSpec(beam="a", end="end", fixed=("y", "rotation"), displacement=(0.0, 0.4), rotation=1.0)
    return scene(beam(height=h, clamped=("start",)), supports=(moved,))


def turned_pins(h: float) -> Scene:
    supports = (hold("a", "start", "pinned"), hold("a", "end", "pinned", displacement=(-0.1, 0.0)))
    return scene(beam(height=h), supports=supports, loads=(LoadSpec(beam="a", end="start", moment=1.0),))


def pushed_between(h: float) -> Scene:
    """A pin presses the axis between a clamp and a roller; on a face two differences of the order h^2 nearly cancel."""
    pin = PinSpec(name="pin", start=(0.4, 0.0), displacement=(0.0, 0.1))
    contact = ContactSpec(node="pin", beam="a", side="right")
    roller = hold("a", "end", "roller", free="x")
    return scene(beam(height=h, clamped=("start",)), supports=(roller,), pins=(pin,), contacts=(contact,))


def raised(h: float) -> Scene:
    """A beam hinged at its middle that rests on two pins, which rise: only their contact keeps it from turning."""
    halves = (
        beam("left", height=h, start=(-1.5, 0.0), end=(0.0, 0.0)),
        beam("right", height=h, end=(1.5, 0.0)),
    )
    places = {"first": -1.0, "second": 1.0}
    pins = [PinSpec(name=name, start=(x, 0.0), displacement=(0.0, 0.5)) for name, x in places.items()]
    contacts = [
        ContactSpec(node=pin.name, beam=half.name, side="right")
        for pin, half in zip(pins, halves, strict=True)
    ]
    hinge = hold("left", "end", "pinned")
    return scene(*halves, supports=(hinge,), pins=tuple(pins), contacts=tuple(contacts))


def driven_tip(h: float) -> Scene:
    """A strip whose clamp is driven, so that its tip presses a cantilever."""
    upper = beam("b", height=h, start=(0.6, 1.0), end=(0.6, 0.1))
    drive = hold("b", "start", "clamped", displacement=(-0.1, -0.25), rotation=0.5)
    contact = ContactSpec(node="b.end", beam="a", side="left")
    return scene(beam(height=h, clamped=("start",)), upper, supports=(drive,), contacts=(contact,))


def frame(h: float) -> Scene:
    """An L-shaped frame on a clamp and a roller, loaded at its corner by a force and a moment."""
    other = beam("b", height=h, start=(1.0, 0.0), end=(1.0, 1.0))
    load = LoadSpec(beam="a", end="end", force=(0.0, 0.3), moment=0.2)
    roller = hold("b", "end", "roller", free="x")
    return scene(beam(height=h, clamped=("start",)), other, supports=(roller,), loads=(load,))


MAKERS = (tip_load, moved_clamp, turned_pins, pushed_between, raised, driven_tip, frame)


def actions(response: Response) -> tuple[np.ndarray, np.ndarray]:
    """Contact forces and reaction forces (s, n), and reaction moments (s, m), at every load parameter."""
    forces = [contact.force[:, None] for contact in response.contacts.values()]
    moments = []
    for history in response.supports.values():
        forces.append(history.force)
        moments.append(history.moment[:, None])
    return np.hstack(forces), np.hstack(moments)


def distance(case: Scene, mesh: tuple[int, int] | None = None) -> float:
    """Largest difference of solid and exact elements in a force or moment, relative to the largest of the path."""
    exact, solid = solve(case, "tsm", Options(element="exact")), solve(case, "solid", Options(mesh=mesh))
    assert exact.completed, exact.message
    assert certified(solid, case).completed, solid.message
    assert solid.index is not None
    assert np.all(solid.index == 0)
    pairs = zip(actions(solid), actions(exact), strict=True)
    return max(float(np.abs(a - b).max() / (np.abs(b).max() or 1.0)) for a, b in pairs)


@pytest.mark.slow_at("tip_load", "turned_pins")
@pytest.mark.parametrize("make", MAKERS)
def test_forces_and_reactions_are_the_rods(make: Callable[[float], Scene]) -> None:
    """Within a thousandth at h/L = .02, certified and stable."""
    assert distance(make(0.02)) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("make", MAKERS)
def test_the_difference_falls_as_the_height_squared(make: Callable[[float], Scene]) -> None:
    thick, thin = distance(make(0.02)), distance(make(0.01), (100, 2))
    assert np.log2(thick / thin) == pytest.approx(2.0, abs=0.25)


def with_the_rods_law(found: Scene, **changes: object) -> Scene:
    beams = tuple(replace(item, material="biot-linear", **changes) for item in found.beams)  # type: ignore[arg-type]
    return replace(found, beams=beams)


@pytest.mark.parametrize("name", ["two-pins", str(FINDINGS / "portal.toml")])
def test_scenes_of_users(name: str) -> None:
    """A beam on two supports under two pins, and a frame whose sections are stated by area and second moment."""
    assert distance(with_the_rods_law(load_scene(name))) < 1e-4


@pytest.mark.slow
def test_a_tip_that_its_support_moves() -> None:
    """Beyond buckling at the first step: a thousandth of the largest force on the path."""
    assert distance(with_the_rods_law(load_scene("ks-tied-tip"))) < 1.1e-3


def test_a_strut_on_a_beam_buckles_where_the_rods_does() -> None:
    """The strut's clamp drives its tip on the beam: both paths end at a bifurcation, within 1 % of the motion."""
    crossed = with_the_rods_law(load_scene(FINDINGS / "crossed.toml"))
    exact, solid = (solve(crossed, *model) for model in (("tsm", Options(element="exact")), ("solid",)))
    assert exact.status == solid.status == "BIFURCATION"
    ends = [response.critical[0].load_parameter for response in (exact, solid)]
    assert ends[1] == pytest.approx(ends[0], rel=1e-2)
    pressed = [response.contacts["upper.end->lower"].force for response in (exact, solid)]
    np.testing.assert_allclose(pressed[1], pressed[0], rtol=5e-4)

"""The scenes of the manual that are not built in."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from comparisons.scene import BeamSpec, ContactSpec, PinSpec, Scene, load_scene

Point = tuple[float, float]

PAIR = "pin->cantilever"
MM = ("x [mm]", "y [mm]")
"""Axes of the pictures of scenes in millimetres."""
INFINITE = 1e10
"""EA and GA of a beam without stretch and shear, over EI/L^2."""
UNIT: dict[str, Any] = {"youngs_modulus": 1.0, "second_moment": 1.0, "area": INFINITE, "shear_modulus": 1.0}
"""A section with EI = 1 N m^2 that neither stretches nor shears."""
ELASTICA_TEXT = (
    f"L = 1 m, EI = 1 N m^2, neither stretch nor shear (EA = GA = {INFINITE:g} EI/L^2 in their place)"
)
STRIP_TEXT = ELASTICA_TEXT.replace("L = 1 m, EI = 1 N m^2", "L = 100 mm, EI = 175,000 N mm^2")


def cantilever(*, length: float = 1.0, **section: Any) -> BeamSpec:
    """Return a beam along x, clamped at its start at the origin; without a section the unit one."""
    return BeamSpec(
        name="cantilever", start=(0.0, 0.0), end=(length, 0.0), clamped=("start",), **(section or UNIT)
    )


def rigid(scene: Scene, ratio: float = INFINITE) -> Scene:
    """Return the scene with the same bending stiffness, and ``EA = GA = ratio EI/L^2`` in every beam."""
    return replace(
        scene,
        beams=tuple(
            BeamSpec(
                name=beam.name,
                start=beam.start,
                end=beam.end,
                clamped=beam.clamped,
                youngs_modulus=beam.EI,
                shear_modulus=beam.EI,
                second_moment=1.0,
                area=ratio / beam.length**2,
            )
            for beam in scene.beams
        ),
    )


def under_pin(
    beam: BeamSpec, *path: Point, load_parameters: int, name: str = "raised-pin", **contact: Any
) -> Scene:
    """Return a cantilever with a pin that comes from below and follows a path."""
    return Scene(
        name=name,
        load_parameters=load_parameters,
        beams=(beam,),
        pins=(PinSpec(name="pin", path=path),),
        contacts=(ContactSpec(node="pin", beam=beam.name, side="right", **contact),),
    )


def ks(name: str = "ks-cantilever", load_parameters: int = 20, **beam: Any) -> Scene:
    """Return a variant of the Konyukhov-Schweizerhof cantilever."""
    scene = load_scene(name)
    return replace(scene, beams=(replace(scene.beams[0], **beam),), load_parameters=load_parameters)


def half_way(scene: Scene, **contact: Any) -> Scene:
    """Return the scene with half of its pin's straight path and half of its load parameters."""
    pin, touched = scene.pins[0], scene.contacts[0]
    dx, dy = pin.displacement or (0.0, 0.0)
    return replace(
        scene,
        load_parameters=scene.load_parameters // 2,
        pins=(replace(pin, displacement=(dx / 2.0, dy / 2.0)),),
        contacts=(replace(touched, **contact),),
    )


def moved(scene: Scene, angle: float, shift: tuple[float, float]) -> Scene:
    """Return the scene turned about the origin by an angle [rad], then shifted."""
    c, s = math.cos(angle), math.sin(angle)
    return _placed(scene, lambda x, y: (c * x - s * y + shift[0], s * x + c * y + shift[1]))


def mirrored(scene: Scene) -> Scene:
    """Return the scene mirrored at the x axis: what came from the right comes from the left."""
    return _placed(scene, lambda x, y: (x, -y), contacts=_other_side(scene))


def reversed_(scene: Scene) -> Scene:
    """Return the scene with its beams named from their other ends."""
    other = {"start": "end", "end": "start"}
    beams = tuple(
        replace(beam, start=beam.end, end=beam.start, clamped=tuple(other[end] for end in beam.clamped))
        for beam in scene.beams
    )
    return replace(scene, beams=beams, contacts=_other_side(scene))


def _other_side(scene: Scene) -> tuple[ContactSpec, ...]:
    side = {"left": "right", "right": "left"}
    return tuple(replace(contact, side=side[contact.side]) for contact in scene.contacts)


def _placed(scene: Scene, place: Callable[[float, float], Point], **changes: Any) -> Scene:
    return replace(
        scene,
        beams=tuple(replace(beam, start=place(*beam.start), end=place(*beam.end)) for beam in scene.beams),
        pins=tuple(
            PinSpec(name=pin.name, path=tuple(place(*point) for point in pin.points), radius=pin.radius)
            for pin in scene.pins
        ),
        **changes,
    )

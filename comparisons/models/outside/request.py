"""The resolved scene: the JSON text that a program of others reads from its standard input."""

import json
from collections.abc import Sequence
from typing import Any

from comparisons.models.options import ModelError, Options
from comparisons.scene import BeamSpec, Scene
from comparisons.scene.keys import PROGRAMS, unstated


def request(scene: Scene, options: Options, load_parameters: Sequence[float]) -> str:
    """Return the resolved scene as JSON text; ``docs/reference/resolved-scene.schema.json`` is its schema.

    Parameters
    ----------
    scene : Scene
        The scene. All derived quantities are stated: stiffnesses, load parameters, offsets of contacts, positions of pins.
    options : Options
        Number of elements, in place of the scene's.
    load_parameters : sequence of float
        Load parameters to solve for; none asks only whether the program can state the scene.

    Raises
    ------
    ModelError
        If the scene uses a key that the resolved scene does not state.
    """
    unknown = unstated(scene, "the resolved scene", PROGRAMS)
    if unknown is not None:
        raise ModelError(unknown)
    data: dict[str, Any] = {
        "name": scene.name,
        "units": scene.units,
        "load_parameters": list(load_parameters),
        "beams": [_beam(scene, beam, options) for beam in scene.beams],
        "joints": joints(scene),
        "supports": [
            {"node": item.node, "beam": item.beam, "end": item.end, "motion": item.motion}
            for item in scene.all_supports
        ],
        "loads": [
            {
                "node": item.node,
                "beam": item.beam,
                "end": item.end,
                "force": item.force,
                "moment": item.moment,
            }
            for item in scene.loads
        ],
        "pins": [
            {
                "name": pin.name,
                "radius": pin.radius or 0.0,
                "path": pin.points if pin.moving else pin.points * 2,
                "corners": pin.corners,
                "positions": [pin.position(t) for t in load_parameters],
            }
            for pin in scene.pins
        ],
        "contacts": [
            {
                "pair": item.pair,
                "node": item.node,
                "beam": item.beam,
                "side": item.side,
                "offset": scene.offset(item),
                "keep": item.keep,
                "friction": item.friction,
            }
            for item in scene.contacts
        ],
    }
    return json.dumps(data, allow_nan=False, indent=1) + "\n"


def joints(scene: Scene) -> list[list[str]]:
    """Return the ends of beams that are rigidly joined, as ``column.end``, one list for each joint."""
    places: dict[tuple[float, float], list[str]] = {}
    for beam in scene.beams:
        places.setdefault(beam.start, []).append(f"{beam.name}.start")
        places.setdefault(beam.end, []).append(f"{beam.name}.end")
    return [ends for ends in places.values() if len(ends) > 1]


def _beam(scene: Scene, beam: BeamSpec, options: Options) -> dict[str, Any]:
    area, second_moment, shear_area = beam.cross_section
    return {
        "name": beam.name,
        "start": beam.start,
        "end": beam.end,
        "length": beam.length,
        "direction": beam.direction,
        "tip": scene.tip(beam.name),
        "EA": beam.EA,
        "GA": beam.GA,
        "EI": beam.EI,
        "youngs_modulus": beam.youngs_modulus,
        "shear_modulus": beam.GA / shear_area,
        "width": beam.width,
        "height": beam.height,
        "area": area,
        "second_moment": second_moment,
        "shear_area": shear_area,
        "elements": options.elements or beam.elements,
    }

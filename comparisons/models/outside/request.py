"""The resolved scene: the JSON text that a program of others reads from its standard input."""

import json
from collections.abc import Sequence
from typing import Any

from comparisons.models.options import ModelError, Options
from comparisons.models.shared import joints, kept
from comparisons.scene import BeamSpec, Scene
from comparisons.scene.keys import PROGRAMS, unstated

BEAM = "name start end length direction EA GA EI youngs_modulus width height"
SUPPORT, LOAD = "node beam end motion", "node beam end force moment"
CONTACT = "pair node beam side keep friction"
"""What a program gets of each record of a scene as it is."""


def request(scene: Scene, options: Options, load_parameters: Sequence[float]) -> str:
    """Return the resolved scene as JSON text; ``docs/reference/resolved-scene.schema.json`` is its schema.

    All derived quantities are stated: stiffnesses, load parameters, offsets of contacts, positions of pins. The options may have a number
    of elements in place of the scene's. No load parameters ask only whether the program can state the scene. A `ModelError` names a key
    that the resolved scene does not state.
    """
    unknown = unstated(scene, "the resolved scene", PROGRAMS)
    if unknown is not None:
        raise ModelError(unknown)
    data = {
        "name": scene.name,
        "units": scene.units,
        "load_parameters": list(load_parameters),
        "beams": [_beam(scene, beam, options) for beam in scene.beams],
        "joints": joints(scene),
        "supports": [kept(item, SUPPORT) for item in scene.all_supports],
        "loads": [kept(item, LOAD) for item in scene.loads],
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
        "contacts": [kept(item, CONTACT) | {"offset": scene.offset(item)} for item in scene.contacts],
    }
    return json.dumps(data, allow_nan=False, indent=1) + "\n"


def _beam(scene: Scene, beam: BeamSpec, options: Options) -> dict[str, Any]:
    area, second_moment, shear_area = beam.cross_section
    return kept(beam, BEAM) | {
        "tip": scene.tip(beam.name),
        "shear_modulus": beam.GA / shear_area,
        "area": area,
        "second_moment": second_moment,
        "shear_area": shear_area,
        "elements": options.elements or beam.divisions,
    }

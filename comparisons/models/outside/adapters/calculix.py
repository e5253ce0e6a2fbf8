"""CalculiX: a clamped strip of quadratic bricks in plane stress, under a transverse load at its end or a sharp pin on its face.

The contact is a penalty between the pin and the face. CalculiX goes on without contact where the pin slips through the face, and
reports success.
"""

from collections.abc import Iterator

import numpy as np

from comparisons.models.outside.adapters.exchange import Histories, StoppedError, Table, refined, serve
from comparisons.models.outside.adapters.strip import axes, foot, one_strip, way

ACROSS = 2
"""Elements over the height."""
LOAD_STEPS, PIN_STEPS = 20, 200
"""Least numbers of steps of a load and of a pin's way."""
PENALTY = 7e4
"""Contact stiffness, over EI/L^3."""


def refusal(scene: Table) -> str | None:
    """Return why the deck of bricks cannot state the scene."""
    beam, reason = scene["beams"][0], one_strip(scene)
    if reason is not None:
        return reason
    if len(scene["loads"]) + len(scene["contacts"]) != 1:
        return "the adapter has one load or one contact"
    for load in scene["loads"]:
        along, _ = axes(beam) @ load["force"]
        if load["end"] != "end" or load["moment"] or abs(along) > 1e-12 * max(map(abs, load["force"])):
            return "the adapter has a transverse force at the free end"
    for item in scene["contacts"]:
        pin = scene["pins"][0]
        if pin["radius"] or not item["offset"] or item["side"] != "right" or pin["corners"]:
            return "the adapter has a sharp pin on the right face, on a straight path"
    return None


def states(scene: Table, histories: Histories) -> Iterator[float]:
    """Solve and yield every load parameter."""
    from comparisons.models.outside.calculix import answer
    from comparisons.models.outside.ccx import CalculixError
    from comparisons.models.outside.deck import pin_deck, slab, tip_load_deck
    from fem_reference import Strip

    beam, times = scene["beams"][0], scene["load_parameters"]
    strip = Strip(
        name=beam["name"], start=(0.0, 0.0), end=(beam["length"], 0.0), height=beam["height"],
        width=beam["width"], youngs_modulus=beam["youngs_modulus"],
        poissons_ratio=beam["youngs_modulus"] / (2.0 * beam["shear_modulus"]) - 1.0,
        mesh=(beam["elements"], ACROSS),
    )  # fmt: skip
    mesh, penalty, frame = slab(strip), PENALTY * beam["EI"] / beam["length"] ** 3, axes(beam)
    increments = refined(scene, LOAD_STEPS if scene["loads"] else PIN_STEPS)
    steps = sum(map(len, increments))
    if scene["loads"]:
        deck = tip_load_deck(mesh, float((frame @ scene["loads"][0]["force"])[1]), steps)
    else:
        _, (start, end) = way(beam, scene["pins"][0])
        deck = pin_deck(mesh, tuple(start), tuple(end - start), steps, penalty)
    try:
        found = answer(mesh, deck, seconds=1e5)
    except CalculixError as error:
        raise StoppedError(error.reason) from error
    for number, t in enumerate(times):
        k = len(increments[0]) * (number + 1) - 1
        if k >= len(found.load_parameter):
            raise StoppedError(found.stopped or f"no increment at load parameter {t:.6g}")
        line, force = beam["start"] + found.axis[k] @ frame, found.force[k] @ frame
        histories.axis(beam["name"], mesh.axis[:, 0].tolist(), line)
        histories.support(scene["supports"][0]["node"], force, found.moment[k])
        for item in scene["contacts"]:
            size, at = float(np.hypot(*force)), foot(line, scene["pins"][0]["positions"][number])
            if size == 0.0:
                histories.open(item["pair"])
            else:
                arc = float(at.shape @ mesh.axis[at.first : at.first + 3, 0])
                histories.contact(item["pair"], -force, arc, -size / penalty)
        yield t


if __name__ == "__main__":
    serve(refusal, states, continuum=True)

"""CalculiX: a clamped strip of quadratic bricks in plane stress, under a transverse load at its end or a sharp pin on its face.

The contact is a penalty between the pin and the face. CalculiX goes on without contact where the pin slips through the face, and
reports success.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from comparisons.models.outside.adapters.exchange import Histories, StoppedError, Table, serve
from comparisons.models.outside.adapters.frame import projection

ACROSS = 2
"""Elements over the height."""
LOAD_STEPS, PIN_STEPS = 20, 200
"""Least numbers of steps of a load and of a pin's way."""
PENALTY = 7e4
"""Contact stiffness, over EI/L^3."""


def refusal(scene: Table) -> str | None:
    """Return why the deck of bricks cannot state the scene."""
    beam, support = scene["beams"][0], scene["supports"][0]
    if len(scene["beams"]) > 1 or len(scene["supports"]) > 1 or beam["height"] is None:
        return "the adapter has one strip of rectangular section with one support"
    if support["motion"] != [0.0, 0.0, 0.0] or support["end"] != "start":
        return "the adapter has a strip that is clamped at rest at its start"
    if len(scene["loads"]) + len(scene["contacts"]) != 1:
        return "the adapter has one load or one contact"
    for load in scene["loads"]:
        along, _ = _turned(beam, load["force"])
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
    mesh, penalty = slab(strip), PENALTY * beam["EI"] / beam["length"] ** 3
    inner = -(-(LOAD_STEPS if scene["loads"] else PIN_STEPS) // len(times))
    steps = inner * len(times)
    if scene["loads"]:
        deck = tip_load_deck(mesh, _turned(beam, scene["loads"][0]["force"])[1], steps)
    else:
        start, end = (_turned(beam, _from(beam, point)) for point in scene["pins"][0]["path"])
        deck = pin_deck(mesh, start, (end[0] - start[0], end[1] - start[1]), steps, penalty)
    try:
        found = answer(mesh, deck, seconds=1e5)
    except CalculixError as error:
        raise StoppedError(error.reason) from error
    arcs = [float(x) for x, _ in mesh.axis]
    for number, t in enumerate(times):
        k = inner * (number + 1) - 1
        if k >= len(found.load_parameter):
            raise StoppedError(found.stopped or f"no increment at load parameter {t:.6g}")
        line = [_placed(beam, point) for point in found.axis[k]]
        force = _turned(beam, found.force[k], back=True)
        histories.axis(beam["name"], arcs, line)
        histories.support(scene["supports"][0]["node"], force, found.moment[k])
        for item in scene["contacts"]:
            _add(histories, item, arcs, line, scene["pins"][0]["positions"][number], force, penalty)
        yield t


def _add(
    histories: Histories, item: Table, arcs: list[float], line: Any, pin: Any, force: Any, penalty: float
) -> None:
    """Add the contact force that the clamp balances, and the arc position of the nearest point of the axis."""
    size = (force[0] ** 2 + force[1] ** 2) ** 0.5
    if size == 0.0:
        histories.open(item["pair"])
        return
    feet = [projection(a, b, pin)[0] for a, b in pairwise(line)]
    k = min(range(len(feet)), key=lambda i: abs(feet[i] - 0.5))
    arc = arcs[k] + min(max(feet[k], 0.0), 1.0) * (arcs[k + 1] - arcs[k])
    histories.contact(item["pair"], (-force[0], -force[1]), arc, -size / penalty)


def _from(beam: Table, point: Any) -> tuple[float, float]:
    return point[0] - beam["start"][0], point[1] - beam["start"][1]


def _turned(beam: Table, vector: Any, *, back: bool = False) -> tuple[float, float]:
    """Return a vector in the frame of the strip, or back in the scene's."""
    (c, s), (x, y) = beam["direction"], (float(vector[0]), float(vector[1]))
    return (c * x - s * y, s * x + c * y) if back else (c * x + s * y, c * y - s * x)


def _placed(beam: Table, point: Any) -> tuple[float, float]:
    x, y = _turned(beam, point, back=True)
    return x + beam["start"][0], y + beam["start"][1]


if __name__ == "__main__":
    serve(refusal, states, continuum=True)

"""OpenSees: corotational Euler-Bernoulli beams, and `BeamContact2D` between a pin and every element of a beam.

The contact element keeps projection and normal from the last load step, so that its error falls with the step. Its normal is undefined
for a pin on the axis. There, pin and axis are `APART`. Its friction is Coulomb's law with an elastic stick; its slip is the distance times
the length of the element, so that its coefficient is the scene's over this length.
"""

from collections.abc import Iterator
from typing import Any

from comparisons.models.outside.adapters.exchange import Histories, StoppedError, Table, refined, serve
from comparisons.models.outside.adapters.frame import Frame, frame, projection

STEPS = 1000
"""Least number of load steps."""
APART, INSIDE = 5e-5, 1e-6
"""Distance of a point in contact from the axis, and of a pin's start from the beam's end, over the length."""
STICK = 1800.0
"""Tangential stiffness of a contact that sticks, over EI/L^3. The stiffer it is, the more often Newton's method fails where a stick ends."""


def refusal(scene: Table) -> str | None:
    """Return why OpenSees cannot state the scene."""
    ends = [item["node"] for item in scene["contacts"] if "." in item["node"]]
    return f"BeamContact2D touches beams with pins only, the scene with {ends[0]}" if ends else None


def states(scene: Table, histories: Histories) -> Iterator[float]:
    """Solve by load and displacement control and yield every load parameter."""
    import openseespy.opensees as ops

    mesh = frame(scene)
    _beams(ops, mesh)
    touching = {item["pair"]: _contact(ops, mesh, item) for item in scene["contacts"]}
    for method, kind in (("constraints", "Transformation"), ("numberer", "RCM"), ("system", "BandGeneral")):
        getattr(ops, method)(kind)
    ops.test("NormUnbalance", 1e-7 * min(beam["EI"] / beam["length"] ** 2 for beam in scene["beams"]), 50)
    ops.algorithm("Newton")
    for steps in refined(scene, STEPS):
        for t in steps:
            ops.integrator("LoadControl", t - ops.getTime())
            ops.analysis("Static")
            if ops.analyze(1):
                raise StoppedError(f"Newton's method does not converge at load parameter {t:.6g}")
        nodes = range(len(mesh.points))
        places = [_place(ops, node) for node in nodes]
        for pair, elements in touching.items():
            _add(ops, mesh, histories, pair, elements, places)
        ops.reactions()
        mesh.add(histories, places, [ops.nodeReaction(node) for node in nodes])
        yield steps[-1]


def _beams(ops: Any, mesh: Frame) -> None:
    """State nodes, elements, supports and loads."""
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", 1)
    for node, point in enumerate(mesh.points):
        ops.node(node, *point)
    for number, item in enumerate(mesh.elements):
        section = (item.beam["area"], item.beam["youngs_modulus"], item.beam["second_moment"])
        ops.element("elasticBeamColumn", number, *item.nodes, *section, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for support in mesh.scene["supports"]:
        ops.fix(mesh.node(support), *(int(value == 0.0) for value in support["motion"]))
        for component, value in enumerate(support["motion"], 1):
            if value:
                ops.sp(mesh.node(support), component, value)
    for load in mesh.scene["loads"]:
        ops.load(mesh.node(load), *load["force"], load["moment"])


def _contact(ops: Any, mesh: Frame, item: Table) -> dict[int, int]:
    """State the pin of a pair and its contact elements; return the numbers of the beam's elements by their numbers."""
    ops.model("basic", "-ndm", 2, "-ndf", 2)
    first = 1_000_000 * (1 + mesh.scene["contacts"].index(item))
    beam, pin = mesh.pair(item)
    (x, y), (c, s), side = pin["path"][0], beam["direction"], 1.0 if item["side"] == "left" else -1.0
    part, left = projection(beam["start"], beam["end"], (x, y))
    closed = side * left - item["offset"] < INSIDE * beam["length"]
    # the gap of the scene is one for the radius; the projection of a closed contact must lie inside an element
    radius = item["offset"] or APART * beam["length"]
    across, inward = side * (radius - item["offset"]), closed * (INSIDE if part < 0.5 else -INSIDE)
    (x0, y0), (x1, y1) = beam["start"], beam["end"]
    ops.node(first, x - across * s + inward * (x1 - x0), y + across * c + inward * (y1 - y0))
    times, ways = mesh.way(pin)
    for k, way in enumerate(ways):
        ops.timeSeries("Path", first + k, "-time", *times, "-values", *way)
        ops.pattern("Plain", first + k, first + k)
        ops.sp(first, k + 1, 1.0)
    touching = {first + k: k for k in mesh.elements_of(beam)}
    part, stiffness = beam["length"] / len(touching), STICK * beam["EI"] / beam["length"] ** 3
    ops.nDMaterial("ContactMaterial2D", first, item["friction"] / part, stiffness / part**2, 0.0, 0.0)
    for contact, k in touching.items():
        ops.node(contact + 500_000, 0.0, 0.0)
        nodes = (*mesh.elements[k].nodes, first, contact + 500_000)
        ops.element("BeamContact2D", contact, *nodes, first, 2.0 * radius, 1e-10, 1e-10, int(not closed))
    return touching


def _place(ops: Any, node: int) -> list[float]:
    return [ops.nodeCoord(node, k) + ops.nodeDisp(node, k) for k in (1, 2)]


def _add(
    ops: Any, mesh: Frame, histories: Histories, pair: str, elements: dict[int, int], places: Any
) -> None:
    """Add the sum of the forces of a pair's elements, and the arc position in the most loaded one."""
    forces = {contact: ops.eleResponse(contact, "force") for contact in elements}
    most = max(forces, key=lambda contact: sum(map(abs, forces[contact])))
    if not any(forces[most]):
        histories.open(pair)
        return
    one, pin = mesh.elements[elements[most]], _place(ops, ops.eleNodes(most)[2])
    part, _ = projection(places[one.nodes[0]], places[one.nodes[1]], pin)
    vector = [-sum(force[k] for force in forces.values()) for k in (0, 1)]
    histories.contact(pair, vector, one.arc + min(max(part, 0.0), 1.0) * one.length, 0.0)


if __name__ == "__main__":
    serve(refusal, states)

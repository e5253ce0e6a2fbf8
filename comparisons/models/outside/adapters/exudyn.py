"""Exudyn: ANCF cables without shear, and a sliding joint between a pin and a beam.

The joint holds the pin on the beam from the start, and may pull.
"""

from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from typing import Any

from numpy import interp, zeros

from comparisons.models.outside.adapters.exchange import (
    Histories,
    StoppedError,
    Table,
    named,
    refined,
    rough,
    serve,
)
from comparisons.models.outside.adapters.frame import Frame, frame, projection

STEPS, SHORTER, NEAR = 400, (1, 2, 4), 1e-6
"""Least number of load steps, parts of a step that are tried where Newton's method does not converge, and the largest gap of a pin
that a joint can hold, over the length."""
Held = dict[tuple[int, int, float], int]
"""Constraints by node, component and lever arm."""


def refusal(scene: Table) -> str | None:
    """Return why Exudyn cannot state the scene."""
    mesh = frame(scene)
    if scene["joints"]:
        return f"ANCF cables have no rigid joint, the scene has one at {scene['joints'][0][0]}"
    inclined = any(0.0 not in beam["direction"] for beam in scene["beams"])
    if inclined or any(support["motion"][2] for support in scene["supports"]):
        return "the adapter has beams along x or y, and turns no support"
    for item in scene["contacts"]:
        there = "." not in item["node"] and not item["offset"]
        if there:
            beam, pin = mesh.pair(item)
            part, left = projection(beam["start"], beam["end"], pin["path"][0])
            there = abs(left) <= NEAR * beam["length"] and -NEAR <= part <= 1.0 + NEAR
        if not there:
            return f"a sliding joint holds a pin on the axis from the start on, {item['node']} is not there"
    return rough(scene)


def states(scene: Table, histories: Histories) -> Iterator[float]:
    """Solve by static steps and yield every load parameter."""
    exu, ex = import_module("exudyn"), import_module("exudyn.utilities")

    mesh, system, quantity = frame(scene), exu.SystemContainer().AddSystem(), exu.OutputVariableType
    nodes, held, joints = _stated(ex, system, mesh)
    system.Assemble()
    settings, before = exu.SimulationSettings(), 0.0
    settings.solution.file.write, solver = False, settings.staticSolver
    solver.verboseMode, solver.adaptiveStep, solver.newton.maxIterations = 0, False, 100
    for steps in refined(scene, STEPS):
        t = steps[-1]
        solver.loadStepStart, solver.loadStepDuration = before, t - before
        for parts in SHORTER:
            solver.numberOfLoadSteps = parts * len(steps)
            with suppress(exu.SolverError, ValueError):
                exu.SolveStatic(system, settings, updateInitialValues=True, showHints=False)
                break
        else:
            raise StoppedError(f"Newton's method does not converge at load parameter {t:.6g}")
        before = t
        places = [system.GetNodeOutput(node, quantity.Position)[:2] for node in nodes]
        reactions: Any = zeros((len(nodes), 3))
        for (node, component, arm), constraint in held.items():
            reactions[node, component] = arm * system.GetObjectOutput(constraint, quantity.Force)
        mesh.add(histories, places, reactions)
        for pair, joint in joints.items():
            x, y, _ = system.GetObjectOutput(joint, quantity.Force)
            histories.contact(pair, (x, y), system.GetObjectOutput(joint, quantity.SlidingCoordinate), 0.0)
        yield t


def _stated(ex: Any, system: Any, mesh: Frame) -> tuple[list[int], Held, dict[str, int]]:
    """State the scene; return nodes, constraints, and sliding joints by pair."""
    nodes, cables = [], []
    for number, point in enumerate(mesh.points):
        along = next(one.beam["direction"] for one in mesh.elements if number in one.nodes)
        nodes.append(system.AddNode(ex.NodePoint2DSlope1(referenceCoordinates=[*point, *along])))
    for one in mesh.elements:
        section = {"bendingStiffness": one.beam["EI"], "axialStiffness": one.beam["EA"], "massPerLength": 1.0}
        section |= {"length": one.length, "nodeNumbers": [nodes[node] for node in one.nodes]}
        cables.append(system.AddObject(ex.ObjectANCFCable2D(**section)))
    held: Held = {}
    for support in mesh.scene["supports"]:
        node = mesh.node(support)
        c, s = named(mesh.scene, "beams", support["beam"])["direction"]
        for component, value in enumerate(support["motion"]):
            # a rotation is held by the slope across the beam
            coordinate, arm = (component, 1.0) if component < 2 else (3, c) if c else (2, -s)
            if value is not None:
                held[node, component, arm] = _moved(ex, system, nodes[node], coordinate, [0, 1], [0, value])
    for load in mesh.scene["loads"]:
        cable, one = next(item for item in enumerate(mesh.elements) if mesh.node(load) in item[1].nodes)
        place = [one.length * one.nodes.index(mesh.node(load)), 0.0, 0.0]
        marker = system.AddMarker(ex.MarkerBodyRigid(bodyNumber=cables[cable], localPosition=place))
        for kind, full in ((ex.Force, [*load["force"], 0.0]), (ex.Torque, [0.0, 0.0, load["moment"]])):
            ramp = {"loadVectorUserFunction": lambda _, t, vector: [t * value for value in vector]}
            system.AddLoad(kind(markerNumber=marker, loadVector=full, **ramp))
    return nodes, held, {one["pair"]: _joint(ex, system, mesh, one, cables) for one in mesh.scene["contacts"]}


def _moved(ex: Any, system: Any, node: int, coordinate: int, times: list[float], way: list[float]) -> int:
    """Prescribe a coordinate of a node."""
    ground = ex.MarkerNodeCoordinate(nodeNumber=system.AddNode(ex.NodePointGround()), coordinate=0)
    moved = ex.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)
    offset = (lambda _, t, *__: float(interp(t, times, way))) if any(way) else 0
    both = [system.AddMarker(ground), system.AddMarker(moved)]
    return int(system.AddObject(ex.CoordinateConstraint(markerNumbers=both, offsetUserFunction=offset)))


def _joint(ex: Any, system: Any, mesh: Frame, item: Table, cables: list[int]) -> int:
    """State the pin of a pair and its sliding joint."""
    beam, pin = mesh.pair(item)
    start, node = pin["path"][0], system.AddNode(ex.NodePoint2D(referenceCoordinates=pin["path"][0]))
    times, ways = mesh.way(pin)
    for k, way in enumerate(ways):
        _moved(ex, system, node, k, times, way)
    own = [cables[k] for k in mesh.elements_of(beam)]
    part = min(max(projection(beam["start"], beam["end"], start)[0], 0.0), 1.0)
    first = min(int(part * len(own)), len(own) - 1)
    data = ex.NodeGenericData(initialCoordinates=[first, part * beam["length"]], numberOfDataCoordinates=2)
    markers = [system.AddMarker(ex.MarkerBodyCable2DCoordinates(bodyNumber=cable)) for cable in own]
    body = system.AddObject(ex.MassPoint2D(mass=1.0, nodeNumber=node))
    joint = ex.ObjectJointSliding2D(
        markerNumbers=[system.AddMarker(ex.MarkerBodyPosition(bodyNumber=body)), markers[first]],
        slidingMarkerNumbers=markers, nodeNumber=system.AddNode(data),
        slidingMarkerOffsets=[beam["length"] / len(own) * k for k in range(len(own))],
    )  # fmt: skip
    return int(system.AddObject(joint))


if __name__ == "__main__":
    serve(refusal, states)

"""A scene as a frame of nodes and straight elements, for adapters of beam programs."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from comparisons.frozen import Value
from comparisons.models.outside.adapters.exchange import Histories, Table, named, points_along


class Element(NamedTuple):
    """A straight element."""

    beam: Table  #: Its beam in the resolved scene.
    nodes: tuple[int, int]
    arc: float  #: Arc position of its first node.
    length: float  #: Undeformed length.


class Frame(Value):
    """Nodes and elements of all beams; joined beams share a node."""

    scene: Table
    points: list[tuple[float, float]]  #: Undeformed positions of the nodes.
    numbers: dict[str, list[int]]  #: Indices of the nodes along each beam.
    elements: list[Element]

    def node(self, item: Table) -> int:
        """Return the node of a support or load."""
        return self.numbers[item["beam"]][0 if item["end"] == "start" else -1]

    def pair(self, contact: Table) -> tuple[Table, Table]:
        """Return the beam and the pin of a contact."""
        return named(self.scene, "beams", contact["beam"]), named(self.scene, "pins", contact["node"])

    def way(self, pin: Table) -> tuple[list[float], list[list[float]]]:
        """Return the load parameters of the corners of a pin's path, and the displacements x and y of the pin there."""
        start = pin["path"][0]
        return [0.0, *pin["corners"], 1.0], [[point[k] - start[k] for point in pin["path"]] for k in (0, 1)]

    def elements_of(self, beam: Table) -> list[int]:
        """Return the indices of the elements of a beam."""
        return [k for k, one in enumerate(self.elements) if one.beam is beam]

    def add(self, histories: Histories, places: Sequence[Any], reactions: Sequence[Any]) -> None:
        """Add positions (n, 2) of the nodes and reactions (n, 3), force and moment, of the supported ones to histories."""
        for beam in self.scene["beams"]:
            arcs, _ = points_along(beam, beam["elements"])
            histories.axis(beam["name"], arcs, [places[node] for node in self.numbers[beam["name"]]])
        for item in self.scene["supports"]:
            x, y, moment = reactions[self.node(item)]
            histories.support(item["node"], (x, y), moment)


def frame(scene: Table) -> Frame:
    """Return the frame of a resolved scene."""
    joint = {end: ends[0] for ends in scene["joints"] for end in ends}
    shared: dict[str, int] = {}
    mesh = Frame(scene=scene, points=[], numbers={}, elements=[])
    for beam in scene["beams"]:
        name, parts = beam["name"], beam["elements"]
        arcs, line = points_along(beam, parts)
        for k, point in enumerate(line):
            node = f"{name}.{ {0: 'start', parts: 'end'}.get(k, k) }"
            number = shared.setdefault(joint.get(node, node), len(mesh.points))
            if number == len(mesh.points):
                mesh.points.append(point)
            mesh.numbers.setdefault(name, []).append(number)
        ends = zip(pairwise(mesh.numbers[name]), arcs, strict=False)
        mesh.elements.extend(Element(beam, nodes, arc, beam["length"] / parts) for nodes, arc in ends)
    return mesh


def projection(a: Any, b: Any, point: Any) -> tuple[float, float]:
    """Return the foot of a point on the chord from `a` to `b`, as a part of the chord, and the distance to its left."""
    (x, y), (u, v) = (b[0] - a[0], b[1] - a[1]), (point[0] - a[0], point[1] - a[1])
    return (x * u + y * v) / (x * x + y * y), (x * v - y * u) / (x * x + y * y) ** 0.5

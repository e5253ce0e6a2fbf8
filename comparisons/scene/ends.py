"""Pins at the ends of beams. In the frame of an end, x points out of the beam and y across it."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from comparisons.scene.contact import ContactSpec
from comparisons.scene.rules import Point
from comparisons.scene.statement import Statement


class BeamEnd(NamedTuple):
    """An end that a contact's node may meet: the segment |y| <= half across it, and the radius of the contact's pin."""

    name: str
    place: Point
    inward: Point
    half: float
    radius: float

    def local(self, point: Point) -> Point:
        """Return a point in the frame of the end."""
        size, (x, y) = math.hypot(*self.inward), (point[0] - self.place[0], point[1] - self.place[1])
        c, s = -self.inward[0] / size, -self.inward[1] / size
        return c * x + s * y, c * y - s * x

    def room(self, point: Point) -> float:
        """Distance of the pin about a point from the segment; infinite where the point is not beyond the end."""
        x, y = self.local(point)
        return math.hypot(x, max(abs(y) - self.half, 0.0)) - self.radius if x > 0.0 else math.inf

    def meeting(self, start: Point, end: Point) -> float:
        """Part of a straight way at which the pin first meets the segment from beyond; nan if it does not."""
        (x, y), (x1, y1) = self.local(start), self.local(end)
        (dx, dy), found = (x1 - x, y1 - y), []
        if dx < 0.0:
            flat = (self.radius - x) / dx
            found += [flat] if abs(y + flat * dy) <= self.half else []
        square = dx * dx + dy * dy
        for corner in (self.half, -self.half) if square else ():
            middle = -(x * dx + (y - corner) * dy) / square
            left = middle**2 - (x**2 + (y - corner) ** 2 - self.radius**2) / square
            found += [middle - math.sqrt(left)] if left > 0.0 else []
        return min((part for part in found if 0.0 <= part <= 1.0 and x + part * dx >= 0.0), default=math.nan)


def free_ends(scene: Statement, spec: ContactSpec) -> Iterator[BeamEnd]:
    """Yield the ends of the touched undeformed beam that no other beam shares; none for a point on an axis."""
    beam, radius = scene.beam(spec.beam), scene.radius(spec)
    if spec.surface == "axis" and not radius:
        return
    for name, part, way in (("start", 0.0, 1.0), ("end", 1.0, -1.0)):
        offset, place = scene.offset(spec, part), beam.place(part)
        if not scene.joined(beam, name):
            x, y = beam.tangent(part)
            yield BeamEnd(name, place, (way * x, way * y), offset - radius, radius)


def near_ends(scene: Statement) -> Iterator[str]:
    """Yield one line for each undeformed end that the path of a pin in contact with its beam comes to within the pin's radius."""
    for spec in scene.contacts:
        ways = list(pairwise(scene.pin(spec.node).points)) if "." not in spec.node else []
        for end in free_ends(scene, spec):
            if any(end.meeting(a, b) >= 0.0 for a, b in ways):
                yield f"{spec.node} meets the {end.name} of {spec.beam}, if it has not moved: END_CONTACT ends the solution there"

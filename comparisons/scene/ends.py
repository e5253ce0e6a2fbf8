"""Pins at the ends of beams. In the frame of an end, x points out of the beam and y across it."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from comparisons.scene.contact import ContactSpec
    from comparisons.scene.records import Scene

Array = NDArray[np.float64]


class BeamEnd(NamedTuple):
    """An end that a contact's node may meet: the segment |y| <= half across it, and the radius of the contact's pin."""

    name: str
    place: Array
    inward: Array
    half: float
    radius: float

    def local(self, point: Array) -> Array:
        """Return points (..., 2) in the frame of the end."""
        x, y = -self.inward / np.hypot(*self.inward)
        return np.asarray((point - self.place) @ np.array([[x, -y], [y, x]]))

    def room(self, point: Array) -> float:
        """Distance of the pin about a point from the segment; infinite where the point is not beyond the end."""
        x, y = self.local(point)
        return math.hypot(x, max(abs(y) - self.half, 0.0)) - self.radius if x > 0.0 else math.inf

    def meeting(self, start: Array, end: Array) -> float:
        """Part of a straight way at which the pin first meets the segment from beyond; nan if it does not."""
        (x, y), way, found = self.local(start), self.local(end) - self.local(start), []
        if way[0] < 0.0:
            flat = float((self.radius - x) / way[0])
            found += [flat] if abs(y + flat * way[1]) <= self.half else []
        square = float(way @ way)
        for corner in (self.half, -self.half) if square else ():
            middle = -float(x * way[0] + (y - corner) * way[1]) / square
            left = middle**2 - (x**2 + (y - corner) ** 2 - self.radius**2) / square
            found += [middle - math.sqrt(left)] if left > 0.0 else []
        return min(
            (part for part in found if 0.0 <= part <= 1.0 and x + part * way[0] >= 0.0), default=math.nan
        )


def free_ends(scene: "Scene", spec: "ContactSpec") -> Iterator[BeamEnd]:
    """Yield the ends of the touched undeformed beam that no other beam shares; none for a point on an axis."""
    beam, radius = scene.beam(spec.beam), scene.radius(spec)
    if spec.surface == "axis" and not radius:
        return
    others = {place for item in scene.beams if item is not beam for place in (item.start, item.end)}
    for name, part, way in (("start", 0.0, 1.0), ("end", 1.0, -1.0)):
        offset, place = scene.offset(spec, part), beam.place(part)
        if getattr(beam, name) not in others:
            yield BeamEnd(name, np.array(place), way * np.array(beam.tangent(part)), offset - radius, radius)


def near_ends(scene: "Scene") -> Iterator[str]:
    """Yield one line for each undeformed end that the path of a pin in contact with its beam comes to within the pin's radius."""
    for spec in scene.contacts:
        ways = list(pairwise(map(np.array, scene.pin(spec.node).points))) if "." not in spec.node else []
        for end in free_ends(scene, spec):
            if any(end.meeting(a, b) >= 0.0 for a, b in ways):
                yield f"{spec.node} meets the {end.name} of {spec.beam}, if it has not moved: END_CONTACT ends the solution there"

"""Transformations of a scene, and of what an answer states: the two must commute."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.scene import BeamSpec, HingeSpec, LoadSpec, Scene, SpringSpec
from comparisons.scene.record import Record

OTHER = {"start": "end", "end": "start", "left": "right", "right": "left", "x": "y", "y": "x"}
STIFF = {HingeSpec: "hinge", SpringSpec: "spring"}
STATIONS = np.linspace(0.0, 1.0, 5)
"""Parts of a beam's length at which its axis is read."""
Readings = dict[str, tuple[str, np.ndarray]]
"""Kind and values of what an answer states, by names such as ``force pin->beam``."""


def rebuilt(record: Any, change: Callable[[Any, str, Any], Any]) -> Any:
    """Return a record, and those in it, with what it states changed by ``change(record, key, value)``."""
    new = {}
    for key in (item.name for item in fields(record)):
        value = getattr(record, key)
        if isinstance(value, tuple) and value and isinstance(value[0], Record):
            new[key] = tuple(rebuilt(one, change) for one in value)
        elif value is not None:
            new[key] = change(record, key, value)
    return replace(record, **new)


def pair(value: Any, change: Callable[[Any], Any]) -> Any:
    """Change a value, or each of several."""
    return tuple(map(change, value)) if isinstance(value, tuple) else change(value)


@dataclass(frozen=True, kw_only=True)
class Change:
    """Other units, another place and direction, and a mirror: x and y from the right-handed plane to the changed one."""

    length: float = 1.0
    force: float = 1.0
    angle: float = 0.0
    mirror: bool = False
    shift: tuple[float, float] = (0.0, 0.0)

    @property
    def sign(self) -> float:
        return -1.0 if self.mirror else 1.0

    @property
    def matrix(self) -> np.ndarray:
        c, s = (float(round(v, 15)) for v in (math.cos(self.angle), math.sin(self.angle)))
        return np.array([[c, -s * self.sign], [s, c * self.sign]])

    def turned(self, vector: Iterable[float], scale: float) -> tuple[float, float]:
        x, y = scale * (self.matrix @ np.array(tuple(vector)))
        return float(x), float(y)

    def vector(self, vector: Iterable[float]) -> tuple[float, float]:
        return self.turned(vector, self.length)

    def point(self, point: Iterable[float]) -> tuple[float, float]:
        x, y = self.vector(point)
        return x + self.length * self.shift[0], y + self.length * self.shift[1]

    def fits(self, scene: Scene) -> bool:
        """Whether the format states the changed scene: what holds x and y differently only turns by right angles."""
        if abs(math.remainder(self.angle, math.pi / 2)) < 1e-12:
            return True
        uneven = any(len({"x", "y"} & set(support.held)) == 1 for support in scene.all_supports)
        return not uneven and all(item.stiffness[0] == item.stiffness[1] for item in scene.springs)

    def scene(self, scene: Scene) -> Scene:
        """Return the changed scene."""
        L, F, sign, across = self.length, self.force, self.sign, abs(self.matrix[0, 0]) < 0.5
        factors = {
            "width": L, "height": L, "radius": L, "area": L**2, "shear_area": L**2, "second_moment": L**4, "density": F / L**3,
            "youngs_modulus": F / L**2, "shear_modulus": F / L**2, "penalty": F / L, "moment": sign * F * L, "turn": sign,
            "rotation": sign, "spring rotation": F * L, "hinge stiffness": F * L, "spring stiffness": F / L,
        }  # fmt: skip
        vectors = {"gravity": 1.0, "displacement": L, "force": F, "force_per_length": F / L}

        def direction(component: str) -> str:
            return OTHER.get(component, component) if across else component

        def changed(record: Record, key: str, value: Any) -> Any:
            key = f"{STIFF.get(type(record), '')} {key}" if key in ("stiffness", "rotation") else key
            if (factor := factors.get(key.strip())) is not None:
                scaled = pair(value, factor.__mul__)
                return scaled[::-1] if key == "spring stiffness" and across else scaled
            if key in vectors:
                return self.turned(value, vectors[key])
            if key in ("start", "end", "path") and not isinstance(value, str):
                return tuple(map(self.point, value)) if key == "path" else self.point(value)
            if key == "side":
                return OTHER[value] if self.mirror else value
            return pair(value, direction) if key in ("free", "fixed") else value

        return rebuilt(scene, changed)

    def readings(self, found: Readings) -> Readings:
        """Return what the answer to the changed scene states."""
        L, F = self.length, self.force
        factors = {"size": F, "moment": self.sign * F * L, "arc": L, "energy": F * L, "number": 1.0}
        changed = {}
        for name, (kind, values) in found.items():
            new = values
            if kind == "point":
                new = values @ (L * self.matrix.T) + L * np.array(self.shift)
            elif kind == "force":
                new = values @ (F * self.matrix.T)
            elif kind != "word":
                # a shear force is positive to the left
                new = factors[kind] * values * (self.sign if name.startswith("V ") else 1.0)
            changed[name] = kind, new
        return changed


def swapped(scene: Scene, beams: Iterable[str]) -> Scene:
    """Return the scene with start and end of some beams exchanged."""
    chosen = set(beams)

    def changed(record: Record, key: str, value: Any) -> Any:
        if key == "node":
            return other_end(value, chosen)
        if getattr(record, "name" if isinstance(record, BeamSpec) else "beam", None) not in chosen:
            return value
        if key in ("start", "end") and not isinstance(value, str):
            return getattr(record, OTHER[key])
        if key in ("width", "height", "nodes", "part") and isinstance(value, tuple):
            value = value[::-1]
        if key in ("at", "nodes", "part"):
            return pair(value, lambda part: 1.0 - part)
        if key == "turn":
            return -value
        return pair(value, OTHER.__getitem__) if key in ("clamped", "end", "side") else value

    return rebuilt(scene, changed)


def other_end(node: str, beams: Iterable[str]) -> str:
    """Name of a node after an exchange of ends."""
    beam, _, end = node.partition(".")
    return f"{beam}.{OTHER[end]}" if end and beam in beams else node


def swapped_readings(found: Readings, scene: Scene, beams: Iterable[str]) -> Readings:
    """Return what the answer states after an exchange of ends."""
    chosen, changed = set(beams), {}
    for name, (kind, values) in found.items():
        what, _, where = name.partition(" ")
        node, arrow, beam = where.partition("->")
        new = values
        if beam in chosen and kind == "arc":
            new = scene.beam(beam).length - values
        elif what in ("tangential", "slip") and beam in chosen:
            new = -values
        elif what == "axis" and node in chosen:
            new = values[:, ::-1]
        elif what in ("N", "V", "M") and node in chosen:
            new = values[:, ::-1] * (-1.0 if what == "M" else 1.0)
        changed[f"{what} {other_end(node, chosen)}{arrow}{beam}".strip()] = kind, new
    return changed


def reordered(scene: Scene) -> Scene:
    """Return the scene with all its lists in the other order."""
    lists = ("beams", "supports", "loads", "pins", "contacts", "hinges", "springs")
    return replace(scene, **{name: tuple(reversed(getattr(scene, name))) for name in lists})


def split(scene: Scene, name: str, part: float) -> Scene:
    """Return the scene with a beam that nothing touches stated as two, rigidly joined; the second is called ``NAME-2``."""
    beam, second = scene.beam(name), f"{name}-2"
    assert all(item.beam != name for item in scene.contacts)

    def half(a: float, b: float, called: str, clamped: str) -> BeamSpec:
        sizes = {
            key: tuple((1.0 - at) * value[0] + at * value[1] for at in (a, b))
            for key in ("width", "height")
            if isinstance(value := getattr(beam, key), tuple)
        }
        nodes = tuple((x - a) / (b - a) for x in beam.nodes if a < x < b)
        return replace(
            beam, name=called, start=beam.place(a), end=beam.place(b), turn=(b - a) * beam.turn, nodes=nodes,
            elements=round((b - a) * beam.divisions), clamped=tuple(end for end in beam.clamped if end == clamped), **sizes,
        )  # fmt: skip

    def at(item):  # type: ignore[no-untyped-def] - anything at an end
        return replace(item, beam=second) if (item.beam, item.end) == (name, "end") else item

    def loads(items: Iterable[LoadSpec]) -> Iterable[LoadSpec]:
        for item in items:
            if item.beam != name or item.end is not None:
                yield at(item)
            elif item.at is not None:
                first = item.at < part
                where = item.at / part if first else (item.at - part) / (1.0 - part)
                yield replace(item, beam=name if first else second, at=where)
            else:
                a, b = item.span
                if a < part:
                    yield replace(item, part=(a / part, min(b / part, 1.0)))
                if b > part:
                    yield replace(
                        item, beam=second, part=(max(a - part, 0.0) / (1.0 - part), (b - part) / (1.0 - part))
                    )

    halves = half(0.0, part, name, "start"), half(part, 1.0, second, "end")
    end = {f"{name}.end": f"{second}.end"}
    return replace(
        scene,
        beams=tuple(piece for item in scene.beams for piece in (halves if item is beam else (item,))),
        supports=tuple(map(at, scene.supports)), hinges=tuple(map(at, scene.hinges)), springs=tuple(map(at, scene.springs)),
        loads=tuple(loads(scene.loads)),
        contacts=tuple(replace(item, node=end.get(item.node, item.node)) for item in scene.contacts),
        stages=tuple(
            replace(stage, support=tuple(map(at, stage.support)), load=tuple(loads(stage.load))) for stage in scene.stages
        ),
    )  # fmt: skip


def readings(response: Response, scene: Scene) -> Readings:
    """Return what an answer states, by name."""
    steps = range(len(response.load_parameter))
    found: Readings = {
        "status": ("word", np.array([response.status])),
        "times": ("number", response.load_parameter),
        "critical": ("number", np.array([point.load_parameter for point in response.critical])),
        "index": ("word", np.array([] if response.index is None else response.index)),
    }
    for item, held in (*response.supports.items(), *response.springs.items()):
        found[f"support {item}"], found[f"moment {item}"] = ("force", held.force), ("moment", held.moment)
    for name, contact in response.contacts.items():
        found[f"contact {name}"], found[f"arc {name}"] = (
            ("size", contact.force),
            ("arc", contact.arc_position),
        )
        if contact.friction is not None:
            friction = contact.friction
            found[f"tangential {name}"] = "size", friction.tangential
            found[f"dissipated {name}"] = "energy", friction.dissipated
            found[f"slip {name}"] = "number", friction.slip.astype(float)
        own = [
            event for event in response.events or () if event.pair == name and event.kind != "pass-through"
        ]
        found[f"events {name}"] = "number", np.array([event.load_parameter for event in own])
        found[f"kinds {name}"] = "word", np.array([event.kind for event in own])
    if response.work is not None:
        found["work"] = "energy", response.work
    for beam in scene.beams:
        axes = [axis(response, beam, k) for k in steps]
        found[f"axis {beam.name}"] = "point", np.array(axes).reshape(-1, len(STATIONS), 2)
        if response.sections is not None:
            cut = [response.sections(beam.name, k) for k in steps]
            for letter, kind in (("N", "size"), ("V", "size"), ("M", "moment")):
                values = [[getattr(item, letter)[end] for end in (0, -1)] for item in cut]
                found[f"{letter} {beam.name}"] = kind, np.array(values).reshape(-1, 2)
    return found


def axis(response: Response, beam: BeamSpec, k: int) -> np.ndarray:
    """Return points of a beam's deformed axis."""
    arc, points = response.axis_line(beam.name, k)
    return np.stack([np.interp(STATIONS * beam.length, arc, coordinate) for coordinate in points.T], axis=-1)


def scales(scene: Scene, found: Mapping[str, tuple[str, np.ndarray]]) -> dict[str, float]:
    """Return the size of each kind: the longest beam, the largest force of the path, at least what bends by a part of 1e-3."""
    length = max(beam.length for beam in scene.beams)
    forces = [np.abs(values).max(initial=0.0) for kind, values in found.values() if kind in ("size", "force")]
    force = max(
        1e-3 * max(beam.EI / beam.length**2 for beam in scene.beams), max(map(float, forces), default=0.0)
    )
    sizes = {"point": length, "arc": length, "force": force, "size": force, "number": 1.0}
    return sizes | {"moment": force * length, "energy": force * length}


def apart(scene: Scene, expected: Readings, found: Readings) -> tuple[float, str]:
    """Return the largest difference of two answers, over the size of its kind, and its name; infinite if words differ."""
    assert expected.keys() == found.keys()
    sizes, largest = scales(scene, found), (0.0, "")
    for name, (kind, values) in expected.items():
        other = found[name][1]
        if values.shape != other.shape or (kind == "word" and list(values) != list(other)):
            return math.inf, f"{name}: {values.tolist()}, {other.tolist()}"
        if kind == "word":
            continue
        both = np.isnan(values) & np.isnan(other)
        off = np.where(both, 0.0, np.abs(values - other)).max(initial=0.0) / sizes[kind]
        largest = max(largest, (math.inf if math.isnan(off) else float(off), name))
    return largest

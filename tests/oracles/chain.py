"""An independent path: the equilibria of a chain of small straight rods under moving pins, followed in small steps.

A beam is many equal elements with linear displacements and rotations, stretch, shear and bending at the middle of each (error of second
order). Where a pin or a beam's end touches, the axis is a cubic curve through the nodes. A contact is a constraint with a multiplier, its
place is an unknown. The set of closed contacts changes where a gap closes, a force vanishes or a contact leaves the beam over its end.
Scene files are read by the second reader: nothing of the three packages is used.
"""

import math
import tomllib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.second_reader import Numbers, read

Array = NDArray[Any]
ROOT, SMALLEST, UNSTABLE, LONGEST = 1e-10, 1e-7, 1e-4, 1.0 / 40.0
"""Widths in the load parameter: of an event, of the shortest step, of the shortest one into an unstable state, of the longest."""
BEHIND = 1e-6
"""Gap behind a beam, over the length, in the smallest step, at which a node does not come from the beam's side."""
TURN, TENSE, KINK, NEAR_END = 0.3, 0.1, 0.01, 0.01
"""Largest rotation of a node in a step; tension over EI/h^2, kink F/GA of the axis and distance of a touch from an end that are resolved."""
GIVEN = {
    "scene": {"name", "units", "load_parameters"},
    "beam": {"name", "start", "end", "youngs_modulus", "poissons_ratio", "shear_modulus", "width", "height", "area", "second_moment", "shear_area", "clamped"},
    "support": {"beam", "end", "kind", "fixed", "free", "displacement", "rotation"},
    "load": {"beam", "end", "force", "moment"},
    "pin": {"name", "start", "displacement", "path", "radius"},
    "contact": {"node", "beam", "side"},
}  # fmt: skip
"""The keys that are understood."""
PLAIN = {"turn": 0.0, "nodes": [], "surface": "axis", "keep": False, "friction": 0.0}
"""Other keys with the values that change nothing; a mesh is nothing to a rod."""
MESH = {"elements", "mesh", "solid_clamp", "solid_element", "material"}


class NotStatedError(Exception):
    """The scene uses what this program does not know."""


@dataclass
class Contact:
    """A node that may touch a beam: a pin's path, or the number of a beam's end node."""

    pair: str
    beam: int
    sign: float
    radius: float = 0.0
    path: Array | None = None
    node: int = -1
    arc: float = 0.0
    force: Array = field(default_factory=lambda: np.zeros(2))


@dataclass
class Path:
    """What was followed: states at the load parameters reached, events, and where and why it ended."""

    states: list[dict[str, tuple[float, float]]]
    events: list[tuple[str, str, float]]
    end: float
    reason: str


class Chain:
    """The rods of a scene with `count` elements along every beam."""

    def __init__(self, text: str, count: int) -> None:
        data = tomllib.loads(text)
        self.data, self.count = data, count
        for kind, entries in data.items():
            for item in [entries] if kind == "scene" else entries:
                for key, value in item.items():
                    if key not in GIVEN.get(kind, ()) and key not in MESH and PLAIN.get(key, MESH) != value:
                        raise NotStatedError(f"{kind}.{key} = {value}")
        beams, self.places, self.lines = data["beam"], list[list[float]](), list[Array]()
        corners: dict[tuple[float, float], int] = {}
        self.names = [beam["name"] for beam in beams]
        for beam in beams:
            line = []
            for k, x in enumerate(np.linspace(0.0, 1.0, count + 1)):
                known = corners.get(tuple(beam["start" if k == 0 else "end"])) if k in (0, count) else None
                if known is None:
                    self.places.append(
                        list(np.array(beam["start"]) + x * np.subtract(beam["end"], beam["start"]))
                    )
                line.append(len(self.places) - 1 if known is None else known)
            corners |= {tuple(beam["start"]): line[0], tuple(beam["end"]): line[-1]}
            self.lines.append(np.array(line))
        self.left = np.concatenate([line[:-1] for line in self.lines])
        self.right = np.concatenate([line[1:] for line in self.lines])
        numbers = read(text)
        self.lengths = [numbers[f"{name} length"][0] for name in self.names]
        each = [
            [*(numbers[f"{name} {what}"][0] for what in ("EA", "GA", "EI")), L / count, math.atan2(*numbers[f"{name} tangents"][1::-1])]
            for name, L in zip(self.names, self.lengths, strict=True)
        ]  # fmt: skip
        self.EA, self.GA, self.EI, self.h, self.angle = np.repeat(each, count, axis=0).T
        self.dofs = (3 * np.stack([self.left, self.right], 1)[:, :, None] + np.arange(3)).reshape(-1, 6)
        self._conditions(numbers)
        self.contacts = [self._contact(item, numbers) for item in data.get("contact", [])]
        self.force_scale = max(b / L**2 for b, L in zip(self.EI[::count], self.lengths, strict=True))

    def _node(self, end: str) -> int:
        """Number of the node at a beam's end, as ``beam.start``."""
        beam, _, which = end.partition(".")
        return int(self.lines[self.names.index(beam)][0 if which == "start" else -1])

    def _conditions(self, numbers: Numbers) -> None:
        """Collect what is held, what it is moved by, and the loads, at the end of the path."""
        self.moved, self.load = np.full(3 * len(self.places), np.nan), np.zeros(3 * len(self.places))
        for name, values in numbers.items():
            place, _, what = name.rpartition(" ")
            if what in ("motion", "load"):
                node, ends = 3 * self._node(place.replace(" ", ".")), np.array(values[-3:])
                own = self.moved[node : node + 3]
                if what == "motion":
                    own[:] = np.where(np.isnan(ends), own, ends)
                else:
                    self.load[node : node + 3] += ends
        self.held = np.flatnonzero(~np.isnan(self.moved))

    def _contact(self, item: dict[str, Any], numbers: Numbers) -> Contact:
        name, pair = item["node"], f"{item['node']}->{item['beam']}"
        made = Contact(pair=pair, beam=self.names.index(item["beam"]), sign=numbers[f"{pair} side"][0])
        if "." in name:
            made.node = self._node(name)
            return made
        pin = next(pin for pin in self.data["pin"] if pin["name"] == name)
        points = pin.get("path") or [pin["start"], np.add(pin["start"], pin.get("displacement", (0, 0)))]
        made.path, made.radius = np.array(points, dtype=float), pin.get("radius", 0.0)
        return made

    def at(self, contact: Contact, x: Array, t: float) -> Array:
        """Position of the node of a contact."""
        if contact.path is None:
            return x[3 * contact.node : 3 * contact.node + 2]
        legs = np.hypot(*np.diff(contact.path, axis=0).T)
        ways = np.concatenate([[0.0], np.cumsum(legs)])
        return np.array([np.interp(t * ways[-1], ways, contact.path[:, k]) for k in (0, 1)])

    def curve(self, beam: int, arc: float) -> tuple[Array, tuple[Array, Array, Array]]:
        """Four nodes, and their weights in the position of a cubic axis and in its first and second derivative."""
        h, n = self.lengths[beam] / self.count, self.count
        e = min(max(int(arc / h), 0), n - 1)
        first = min(max(e - 1, 0), n - 3)
        u = arc / h - e
        ghosts = np.zeros((4, 4))
        for row, node in enumerate(range(e - 1, e + 3)):
            if node < 0:
                ghosts[row, :3] = 3.0, -3.0, 1.0
            elif node > n:
                ghosts[row, 1:] = 1.0, -3.0, 3.0
            else:
                ghosts[row, node - first] = 1.0
        m = 0.5 * np.array([[0, 2, 0, 0], [-1, 0, 1, 0], [2, -5, 4, -1], [-1, 3, -3, 1]])
        rows = ([1, u, u * u, u**3], [0, 1, 2 * u, 3 * u * u], [0, 0, 2, 6 * u])
        weights = tuple(np.array(row) @ m @ ghosts / h**k for k, row in enumerate(rows))
        return self.lines[beam][first : first + 4], weights  # type: ignore[return-value]

    def gap(self, contact: Contact, x: Array, t: float) -> tuple[float, float]:
        """Gap of an open contact and the arc length of the nearest point; infinite beside the beam's ends."""
        place, line = self.at(contact, x, t), self.lines[contact.beam]
        points = x.reshape(-1, 3)[line, :2]
        L = self.lengths[contact.beam]
        arc = float(np.argmin(np.hypot(*(points - place).T))) * L / self.count
        for _ in range(30):
            nodes, (w, d, dd) = self.curve(contact.beam, arc)
            own = x.reshape(-1, 3)[nodes, :2]
            apart = w @ own - place
            slope = d @ own @ (d @ own) + apart @ (dd @ own)
            step = apart @ (d @ own) / (slope if slope > 0.0 else d @ own @ (d @ own))
            arc -= float(np.clip(step, -L / self.count, L / self.count))
            if not -0.05 * L < arc < 1.05 * L:
                return math.inf, arc
            if abs(step) < 1e-14 * L:
                break
        tangent = d @ own / np.hypot(*(d @ own))
        normal = contact.sign * np.array([-tangent[1], tangent[0]])
        return (-float(apart @ normal) - contact.radius if 0.0 <= arc <= L else math.inf), arc

    def rods(self, v: Array) -> Array:
        """Gradient of the strain energy by six columns of every element."""
        d, turn = v[:, 3:5] - v[:, :2], self.angle + 0.5 * (v[:, 2] + v[:, 5])
        c, s = np.cos(turn), np.sin(turn)
        e1, e2 = (c * d[:, 0] + s * d[:, 1]) / self.h - 1.0, (c * d[:, 1] - s * d[:, 0]) / self.h
        N, V, M = self.EA * e1, self.GA * e2, self.EI * (v[:, 5] - v[:, 2]) / self.h
        fx, fy, m = c * N - s * V, s * N + c * V, 0.5 * self.h * (N * e2 - V * (1.0 + e1))
        return np.stack([-fx, -fy, m - M, fx, fy, m + M], 1)

    def touching(self, contact: Contact, z: Array, given: Array | None) -> Array:
        """Gradient of a contact's part by four nodes, the node that touches (if it is a beam's), arc length and multipliers."""
        _, (w, d, dd) = self.curve(contact.beam, contact.arc)
        step = z[10] - contact.arc  # the curve is a cubic: a complex step needs its derivatives alone
        place, w, d = z[8:10] if given is None else given, w + d * step, d + dd * step
        own = z[:8].reshape(4, 2)
        apart = w @ own - place
        if contact.radius == 0.0:
            pull = z[11:13]
            rest = [-(pull @ (d @ own)), -apart[0], -apart[1]]
        else:
            size = np.sqrt(apart @ apart)
            pull = z[11] * apart / size
            rest = [apart @ (d @ own), contact.radius - size, z[12]]
        return np.concatenate([-np.outer(w, pull).ravel(), pull if given is None else 0 * z[8:10], rest])

    def system(self, x: Array, t: float, closed: list[Contact]) -> tuple[Array, Array]:
        """Residual and tangent: nodes, then arc length and two multipliers of every closed contact."""
        n = 3 * len(self.places)
        K, r = np.zeros((n + 3 * len(closed),) * 2), np.zeros(n + 3 * len(closed))
        r[:n] -= t * self.load
        v = x[self.dofs]
        columns = [self.rods(v + 1e-30j * np.eye(6)[k]).imag / 1e-30 for k in range(6)]
        np.add.at(r, self.dofs, self.rods(v))
        np.add.at(K, (self.dofs[:, :, None], self.dofs[:, None, :]), np.stack(columns, 2))
        for i, contact in enumerate(closed):
            nodes, _ = self.curve(contact.beam, contact.arc)
            own = np.concatenate([(3 * nodes[:, None] + np.arange(2)).ravel(), 3 * max(contact.node, 0) + np.arange(2), n + 3 * i + np.arange(3)])  # fmt: skip
            given = None if contact.path is None else self.at(contact, x, t)
            z = np.concatenate([x[own[:10]], [contact.arc], contact.force]).astype(complex)
            np.add.at(r, own, self.touching(contact, z, given).real)
            for k in range(13):
                column = self.touching(contact, z + 1e-30j * np.eye(13)[k], given).imag / 1e-30
                np.add.at(K, (own, own[k]), 0.0 if given is not None and k in (8, 9) else column)
        r[self.held] = 0.0
        K[self.held], K[:, self.held] = 0.0, 0.0
        K[self.held, self.held] = 1.0
        return r, K

    def solved(self, x: Array, t: float, closed: list[Contact]) -> tuple[Array, float] | None:
        """Equilibrium at a load parameter near `x` and the sign of its determinant, 1 where it is stable; None if there is none."""
        x, n = x.copy(), 3 * len(self.places)
        x[self.held] = (
            np.array([[*p, 0.0] for p in self.places]).ravel()[self.held] + t * self.moved[self.held]
        )
        start = x.copy()
        for _ in range(14):
            r, K = self.system(x, t, closed)
            if not np.all(np.isfinite(K)):
                return None
            unit = np.sqrt(np.maximum(np.abs(K).max(axis=1), 1e-300))
            scaled = K / np.outer(unit, unit)
            sign = float(np.linalg.slogdet(scaled)[0])
            if not sign:
                return None
            dx = -np.linalg.solve(scaled, r / unit) / unit
            x += dx[:n]
            for i, contact in enumerate(closed):
                contact.arc += dx[n + 3 * i]
                contact.force = contact.force + dx[n + 3 * i + 1 : n + 3 * i + 3]
            turns = np.abs(x - start).reshape(-1, 3)[:, 2].max()
            if not turns < TURN or any(not -0.1 * self.lengths[c.beam] < c.arc < 1.1 * self.lengths[c.beam] for c in closed):  # fmt: skip
                return None
            if np.abs(dx[:n]).max() < 1e-11 * max(self.lengths):
                if any(self.through(contact, x, t) for contact in closed):
                    return None
                return x, sign * (-1) ** sum(c.radius > 0.0 for c in closed)
        return None

    def through(self, contact: Contact, x: Array, t: float) -> bool:
        """Whether the beam has jumped to the other side of a round pin."""
        nodes, (w, d, _) = self.curve(contact.beam, contact.arc)
        own = x.reshape(-1, 3)[nodes, :2]
        (tx, ty), (ax, ay) = d @ own, w @ own - self.at(contact, x, t)
        return contact.radius > 0.0 and contact.sign * (tx * ay - ty * ax) > 0.0

    def push(self, contact: Contact, x: Array) -> float:
        """Contact force, positive where it pushes the beam away."""
        if contact.radius:
            return float(contact.force[0])
        nodes, (_, d, _) = self.curve(contact.beam, contact.arc)
        tangent = d @ x.reshape(-1, 3)[nodes, :2]
        return float(-contact.sign * (tangent[0] * contact.force[1] - tangent[1] * contact.force[0]) / np.hypot(*tangent))  # fmt: skip

    def resolved(self, x: Array, t: float, closed: list[Contact]) -> bool:
        """Whether elements are short beside the layer sqrt(EI/N) of a tension, the axis has no kink, and no round pin nearly its curvature."""
        v = x[self.dofs]
        stretch = np.hypot(*(v[:, 3:5] - v[:, :2]).T) / self.h - 1.0
        if np.max(self.EA * stretch * self.h**2 / self.EI) > TENSE:
            return False
        for contact in closed:
            nodes, (w, d, dd) = self.curve(contact.beam, contact.arc)
            own = x.reshape(-1, 3)[nodes, :2]
            if self.push(contact, x) > KINK * self.GA[contact.beam * self.count]:
                return False
            if d @ own @ (d @ own) + (w @ own - self.at(contact, x, t)) @ (dd @ own) < 0.3:
                return False
        return True

    def margins(self, x: Array, t: float, closed: list[Contact]) -> dict[tuple[str, str], float]:
        """What must stay positive: gaps of open contacts, forces and distances to both ends of closed ones."""
        found: dict[tuple[str, str], float] = {}
        for contact in self.contacts:
            L = self.lengths[contact.beam]
            if contact in closed:
                found["release", contact.pair] = self.push(contact, x) / self.force_scale
                found["slip-off", contact.pair] = min(contact.arc, L - contact.arc) / L
            else:
                found["touch", contact.pair] = self.gap(contact, x, t)[0] / L
        return found

    def follow(self, longest: float = LONGEST) -> Path:  # noqa: C901, PLR0911, PLR0912 - one march, whose ends all have a name
        """Follow the path from rest, in steps of `longest` at most."""
        number = self.data["scene"]["load_parameters"]
        stops = [(k + 1) / number for k in range(number)]
        x, t, closed = np.array([[*p, 0.0] for p in self.places]).ravel(), 0.0, list[Contact]()
        found = Path([], [], 0.0, "")

        def ended(t: float, reason: str) -> Path:
            found.end, found.reason = t, reason
            return found

        before, step = self.margins(x, t, closed), longest
        at = [(*self.gap(contact, x, t), self.lengths[contact.beam]) for contact in self.contacts]
        if (
            any(gap < BEHIND * L and min(arc, L - arc) < NEAR_END * L for gap, arc, L in at)
            or math.inf in before.values()
        ):
            return ended(0.0, "starts beside an end")
        while len(found.states) < number:
            goal = min(t + step, stops[len(found.states)])
            kept = [(c.arc, c.force) for c in closed]
            tried = self.solved(x, goal, closed)
            if tried and tried[1] < 0.0 and goal - t > UNSTABLE:
                tried = None
            now = self.margins(tried[0], goal, closed) if tried else {}
            crossed = [key for key, value in now.items() if value < -1e-10 and before[key] < math.inf]
            if tried is None or (crossed and goal - t > ROOT):
                for contact, (arc, force) in zip(closed, kept, strict=True):
                    contact.arc, contact.force = arc, force
                step = 0.5 * (goal - t)
                if tried is not None:
                    key = crossed[0]
                    part = before[key] / (before[key] - now[key]) if before[key] > 0.0 else 0.0
                    step = (goal - t) * min(max(part if len(crossed) == 1 else 0.5, 0.02), 0.98)
                elif step < SMALLEST:
                    return ended(t, "no next step")
                continue
            x, t = tried[0], goal
            if tried[1] < 0.0 or not self.resolved(x, t, closed):
                return ended(t, "unstable" if tried[1] < 0.0 else "not resolved")
            for kind, pair in crossed[:1]:
                contact = next(c for c in self.contacts if c.pair == pair)
                if kind == "touch":
                    if now[kind, pair] < -BEHIND:
                        return ended(t, "comes from beyond an end to behind the beam")
                    contact.arc, contact.force = self.gap(contact, x, t)[1], np.zeros(2)
                    L = self.lengths[contact.beam]
                    if min(contact.arc, L - contact.arc) < NEAR_END * L:
                        return ended(t, "touches at an end")
                    closed.append(contact)
                found.events.append((kind, pair, t))
                if kind == "slip-off":
                    return ended(t, "slip-off")
                if kind == "release":
                    closed.remove(contact)
                if len(found.events) > 40:
                    return ended(t, "too many events")
                now = self.margins(x, t, closed)
            before = {key: max(value, 0.0) for key, value in now.items()}
            if not crossed and math.isclose(t, stops[len(found.states)]):
                found.states.append({c.pair: (self.push(c, x), c.arc) for c in closed})
            step = longest if crossed else min(1.7 * step, longest)
        return ended(1.0, "")

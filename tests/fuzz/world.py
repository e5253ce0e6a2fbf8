"""Scenes drawn over everything that the format can state but special keys, one for every seed: ``python -m tests.fuzz world SEED`` prints it.

Structures (cantilevers, struts, beams on two supports, chains, portals, forks, stacks, struts pressed on beams) in any place, size and
unit; slender and thick, soft and stiff in shear; dead loads, moved supports, point and round pins on straight and bent paths on either
side, on the axis or a face. Forces and motions are of a size that bends.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from random import Random
from typing import Any, TypeVar

from comparisons.scene import InputError, Scene, read_scene

# how a scene file writes a value, however broken: no reader of TOML writes
from comparisons.scene.rules import toml_value

Tables = dict[str, Any]
"""A scene as its TOML file holds it."""
Corner = tuple[float, float]
Item = TypeVar("Item")
CLAMPED, PINNED = {"kind": "clamped"}, {"kind": "pinned"}
STRIDE = 1_000_000
"""From the seed of a scene without contacts to one that stands in for it."""
ENDS = ("start", "end")
EULER = {"free": math.pi**2 / 4.0, "pinned": math.pi**2, "held": 4.0 * math.pi**2}
"""Buckling forces of slender struts, over EI/L^2, by the loaded end."""


def quoted(key: str) -> str:
    """The key as TOML writes it, bare if it can be."""
    return key if key.isascii() and key.replace("_", "").isalnum() else toml_value(key)


def toml_text(tables: Tables) -> str:
    """The file of a scene, however broken."""

    def lines(table: Tables) -> list[str]:
        return [f"{quoted(key)} = {toml_value(value)}" for key, value in table.items()]

    plain, headed = dict(tables), []
    for key, value in tables.items():
        several = isinstance(value, list) and value and all(isinstance(item, dict) for item in value)
        if several or isinstance(value, dict):
            header = f"[[{quoted(key)}]]" if several else f"[{quoted(key)}]"
            headed += [
                line for table in (value if several else [value]) for line in (header, *lines(table), "")
            ]
            del plain[key]
    return "\n".join([*lines(plain), *headed]) + "\n"


class Place:
    """Where a scene lies: turns parts of its length into coordinates."""

    def __init__(self, length: float, angle: float, origin: tuple[float, float]) -> None:
        self.length, self.origin = length, origin
        self.cos, self.sin = math.cos(angle), math.sin(angle)

    def vector(self, x: float, y: float) -> list[float]:
        turned = self.cos * x - self.sin * y, self.sin * x + self.cos * y
        return [self.length * value + 0.0 for value in turned]

    def point(self, x: float, y: float) -> list[float]:
        vx, vy = self.vector(x, y)
        return [self.origin[0] + vx, self.origin[1] + vy]


def drawn(seed: int) -> Scene:
    """Return the scene of a seed: the first that its numbers make and that breaks no rule."""
    random = Random(seed)  # noqa: S311 - nothing is secret
    while True:
        try:
            return read_scene(toml_text(_World(random).tables(f"drawn-{seed}")), f"seed {seed}")
        except InputError:
            continue


def drawn_with_friction(seed: int) -> Scene:
    """Return the scene of a seed, or the next one that has contacts, with friction at one of them at least."""
    while not (scene := drawn(seed)).contacts:
        seed += STRIDE
    random = Random(-1 - seed)  # noqa: S311 - nothing is secret
    contacts = scene.contacts
    while not any(contact.friction for contact in contacts):
        for k, contact in enumerate(contacts):
            mu = random.choice((0.0, random.uniform(0.0, 1.0), 10.0 ** random.uniform(-3.0, 0.5)))
            contacts = (*contacts[:k], replace(contact, friction=mu), *contacts[k + 1 :])
    return replace(scene, contacts=contacts)


class _World:
    """A scene on its way: beams in a plane whose unit is about a beam's length, turned and scaled at the end."""

    def __init__(self, random: Random) -> None:
        self.random = random
        length = self.one_of(1.0, 1.0, 300.0, 10.0 ** random.uniform(-1.0, 3.0))
        angle = self.one_of(0.0, 0.0, math.pi / 2, math.pi, 0.3, -2.1)
        origin = self.one_of((0.0, 0.0), (0.0, 0.0), (2.5, -1.0), (20.0, 30.0))
        self.place = Place(length, angle, (length * origin[0], length * origin[1]))
        self.beams: list[Tables] = []
        self.corners: dict[str, tuple[Corner, Corner]] = {}
        self.supports: list[Tables] = []
        self.loads: list[Tables] = []
        self.pins: list[Tables] = []
        self.contacts: list[Tables] = []
        self.height = 10.0 ** random.uniform(-3.0, -0.9)
        self.stiffness = self.one_of(2.1e5, 7e10, 10.0 ** random.uniform(-3.0, 12.0))
        self.soft = random.random() < 0.25

    def one_of(self, *items: Item) -> Item:
        return items[self.random.randrange(len(items))]

    def chance(self, part: float) -> bool:
        return self.random.random() < part

    def tables(self, name: str) -> Tables:
        """Draw structure and causes."""
        structures: tuple[Callable[[], None], ...] = (
            self.cantilever, self.cantilever, self.on_two_supports, self.chain, self.portal, self.fork, self.stack,
            self.crossed, self.strut, self.over_a_drum,
        )  # fmt: skip
        self.one_of(*structures)()
        while not self.caused():
            if self.chance(0.5):
                self.pin()
            if self.chance(0.3):
                self.load()
            if self.chance(0.2):
                self.moved()
        if self.chance(0.3):
            self.pin()
        if self.chance(0.15):
            self.load()
        head = {"name": name, "units": self.one_of("N, m", "N, mm")}
        head["load_parameters"] = self.one_of(1, 2, 3, 4, 5, 7, 8, 10)
        tables: Tables = {"scene": head, "beam": self.beams}
        lists = {"support": self.supports, "load": self.loads, "pin": self.pins, "contact": self.contacts}
        return tables | {key: items for key, items in lists.items() if items}

    def caused(self) -> bool:
        """Whether anything happens: a bending force, a motion or a pin."""
        return bool(self.pins or self.loads) or any(
            "displacement" in item or "rotation" in item for item in self.supports
        )

    # structures

    def beam(self, start: Corner, end: Corner) -> str:
        """Add a beam between two corners, stated from either end."""
        name = f"b{len(self.beams)}"
        if self.chance(0.3):
            start, end = end, start
        self.corners[name] = (start, end)
        self.beams.append(
            {
                "name": name, "start": self.place.point(*start), "end": self.place.point(*end),
                **self.section(math.dist(start, end)),
                "elements": self.one_of(16, 20, 30, 40),
                "mesh": [self.one_of(30, 40), 2],
            }
        )  # fmt: skip
        if self.chance(0.1):
            inner = sorted(round((k + self.random.uniform(0.2, 0.8)) / 20, 6) for k in range(1, 19))
            self.beams[-1]["nodes"] = inner
        return name

    def section(self, length: float) -> Tables:
        """Draw a section: a rectangle, or one whose shear stiffness is anything."""
        height = self.height * length * self.place.length * self.one_of(1.0, 1.0, 0.5)
        width = height * self.one_of(1.0, 1.0, 10.0 ** self.random.uniform(-1.0, 1.0))
        section: Tables = {"youngs_modulus": self.stiffness * self.one_of(1.0, 1.0, 3.0)}
        if not self.soft:
            nu = self.one_of(0.3, 0.0, 0.49, -0.3)
            return section | {"width": width, "height": height, "poissons_ratio": nu}
        area, inertia = width * height, width * height**3 / 12.0
        shear = 10.0 ** self.random.uniform(0.3, 5.0) * inertia / (length * self.place.length) ** 2
        section |= {"area": area, "second_moment": inertia, "shear_area": shear}
        return section | {"shear_modulus": section["youngs_modulus"]}

    def end_at(self, name: str, corner: Corner) -> str:
        return ENDS[self.corners[name].index(corner)]

    def support(self, name: str, corner: Corner, kind: Tables) -> None:
        self.supports.append({"beam": name, "end": self.end_at(name, corner), **kind})

    def roller(self) -> Tables:
        return {"kind": "roller", "free": self.one_of("x", "y")}

    def cantilever(self) -> None:
        self.support(self.beam((0.0, 0.0), (1.0, 0.0)), (0.0, 0.0), CLAMPED)

    def on_two_supports(self) -> None:
        name = self.beam((0.0, 0.0), (1.0, 0.0))
        self.support(name, (0.0, 0.0), self.one_of(CLAMPED, PINNED))
        self.support(
            name, (1.0, 0.0), self.one_of(CLAMPED, PINNED, self.roller(), {"fixed": ["rotation"]}, {"fixed": ["y", "rotation"]})
        )  # fmt: skip

    def strut(self) -> None:
        """A straight strut under an axial force or motion near or past buckling, perfect or not."""
        name = self.beam((0.0, 0.0), (1.0, 0.0))
        far = self.one_of("free", "pinned", "held")
        self.support(name, (0.0, 0.0), PINNED if far == "pinned" else CLAMPED)
        if far != "free" and self.chance(0.5):
            shortened, aside = 10.0 ** self.random.uniform(-4.0, -0.5), self.one_of(0.0, 1e-6, 1e-3, 0.02)
            kind = PINNED if far == "pinned" else CLAMPED
            self.support(name, (1.0, 0.0), kind | {"displacement": self.place.vector(-shortened, aside)})
            return
        if far != "free":
            # what is free must be a global direction
            x, y = self.place.vector(1.0, 0.0)
            free = "x" if abs(x) > abs(y) else "y"
            other = "y" if free == "x" else "x"
            self.support(name, (1.0, 0.0), {"fixed": [other] if far == "pinned" else [other, "rotation"]})
        size = -EULER[far] * self.one_of(0.5, 0.9, 0.999, 1.001, 1.02, 1.3, 2.0, 8.0)
        side = size * self.one_of(0.0, 0.0, 1e-6, 1e-4, 1e-2)
        self.loaded(name, (1.0, 0.0), self.scaled(name, size, side), 0.0)

    def chain(self) -> None:
        """Rigidly joined beams one behind the other."""
        corners, direction = [(0.0, 0.0)], 0.0
        for _ in range(self.random.randint(2, 4)):
            size = self.one_of(1.0, 1.0, 0.5)
            x, y = corners[-1]
            way = math.cos(direction), math.sin(direction)
            corners.append((round(x + size * way[0], 6), round(y + size * way[1], 6)))
            direction += self.one_of(0.0, math.pi / 2, -math.pi / 2, self.random.uniform(-1.5, 1.5))
        names = [self.beam(a, b) for a, b in pairwise(corners)]
        self.support(names[0], corners[0], self.one_of(CLAMPED, CLAMPED, PINNED))
        if self.chance(0.6) or self.supports[0]["kind"] == "pinned":
            self.support(names[-1], corners[-1], self.one_of(CLAMPED, PINNED, self.roller()))

    def portal(self) -> None:
        height, width = self.one_of(1.0, 0.6), self.one_of(1.0, 1.5)
        corners = [(0.0, 0.0), (0.0, height), (width, height), (width, 0.0)]
        names = [self.beam(a, b) for a, b in pairwise(corners)]
        self.support(names[0], corners[0], self.one_of(CLAMPED, PINNED))
        self.support(names[2], corners[3], self.one_of(CLAMPED, PINNED, self.roller()))

    def fork(self) -> None:
        """Three beams that meet in one joint."""
        joint = (0.6, 0.0)
        up, down = (round(self.random.uniform(0.05, 0.6), 3) for _ in range(2))
        tips = [(0.0, 0.0), (1.2, up), (1.0, -down)]
        names = [self.beam(joint, tip) for tip in tips]
        self.support(names[0], tips[0], CLAMPED)
        if self.chance(0.4):
            self.support(names[1], tips[1], self.one_of(CLAMPED, PINNED, self.roller()))

    def stack(self) -> None:
        """Cantilevers one above the other: a pin presses the first, ends meet the next beam."""
        gap = self.one_of(0.01, 0.05, 0.2)
        number = self.random.randint(2, 3)
        names = []
        for k in range(number):
            mirrored = k > 0 and self.chance(0.3)
            root, tip = (1.6, 0.1) if mirrored else (0.0, 1.0 + 0.1 * k)
            names.append(self.beam((root, -gap * k), (tip, -gap * k)))
            self.support(names[-1], (root, -gap * k), CLAMPED)
        for k in range(number - 1):
            upper, lower = names[k], names[k + 1]
            self.touch(f"{upper}.{self.tip(upper)}", lower, above=True)
        if self.chance(0.8):
            self.pin(names[0], above=True)
        if self.chance(0.3):
            self.load(names[0])

    def crossed(self) -> None:
        """A strut or an inclined cantilever whose tip is pressed on a beam."""
        below = self.beam((0.0, 0.0), (1.0, 0.0))
        self.support(below, (0.0, 0.0), CLAMPED)
        if self.chance(0.5):
            self.support(below, (1.0, 0.0), self.one_of(CLAMPED, PINNED))
        x, gap = self.random.uniform(0.2, 0.9), self.one_of(0.0, 0.001, 0.02)
        top = (round(x + self.one_of(0.0, 1e-4, self.random.uniform(-0.6, 0.6)), 6), 1.0)
        tip = (round(x, 6), gap)
        above = self.beam(top, tip)
        aside, down = self.one_of(0.0, self.random.uniform(-0.3, 0.3)), self.one_of(0.01, 0.1, 0.3)
        moved = {"displacement": self.place.vector(aside, -down)}
        self.support(above, top, self.one_of(CLAMPED, CLAMPED, PINNED) | moved)
        self.touch(f"{above}.{self.end_at(above, tip)}", below, above=True)

    def over_a_drum(self) -> None:
        """A cantilever bent over a round pin by its tip's load, a pin or a moved clamp."""
        name = self.beam((0.0, 0.0), (1.0, 0.0))
        self.support(name, (0.0, 0.0), CLAMPED)
        x, radius = self.random.uniform(0.1, 0.7), 10.0 ** self.random.uniform(-2.0, 0.0)
        self.pin(name, above=False, x=x, radius=radius)
        if self.chance(0.7):
            size = -(10.0 ** self.random.uniform(-0.5, 1.6))
            self.loaded(name, (1.0, 0.0), self.scaled(name, 0.0, size), 0.0)
        else:
            self.pin(name, above=True, x=self.random.uniform(0.75, 1.0))

    def tip(self, name: str) -> str:
        """The end of a beam that no support holds."""
        held = {item["end"] for item in self.supports if item["beam"] == name}
        return next(end for end in ENDS if end not in held)

    # causes

    def scaled(self, name: str, along: float, across: float) -> list[float]:
        """A force stated over EI/L^2 in the plane of the corners."""
        x, y = self.place.vector(along, across)
        unit = self.bending(name) / self.place.length
        return [unit * x, unit * y]

    def bending(self, name: str) -> float:
        """EI/L^2 of a beam."""
        beam = next(item for item in self.beams if item["name"] == name)
        inertia = beam.get("second_moment") or beam["width"] * beam["height"] ** 3 / 12.0
        return float(beam["youngs_modulus"] * inertia / math.dist(beam["start"], beam["end"]) ** 2)

    def loaded(self, name: str, corner: Corner, force: list[float], moment: float) -> None:
        end = self.end_at(name, corner)
        if (name, end) not in {(item["beam"], item["end"]) for item in self.loads} and any((*force, moment)):
            self.loads.append({"beam": name, "end": end, "force": force, "moment": moment})

    def load(self, name: str | None = None) -> None:
        """Load a beam's end."""
        name = name or self.one_of(*self.corners)
        size = 10.0 ** self.random.uniform(-2.0, 1.2)
        direction = self.one_of(math.pi / 2, -math.pi / 2, math.pi, self.random.uniform(-math.pi, math.pi))
        force, moment = [0.0, 0.0], 0.0
        if self.chance(0.8):
            force = self.scaled(name, size * math.cos(direction), size * math.sin(direction))
        if self.chance(0.3) or not any(force):
            moment = self.bending(name) * self.place.length * self.one_of(1.0, -1.0) * min(size, 6.0)
        self.loaded(name, self.corners[name][self.random.randrange(2)], force, moment)

    def moved(self) -> None:
        """Move a support that rests."""
        support = self.one_of(*self.supports)
        if support.get("kind") not in ("clamped", "pinned"):
            return
        size = 10.0 ** self.random.uniform(-3.0, -0.4)
        direction = self.random.uniform(-math.pi, math.pi)
        support["displacement"] = self.place.vector(size * math.cos(direction), size * math.sin(direction))
        if support["kind"] == "clamped" and self.chance(0.5):
            support["rotation"] = self.random.uniform(-1.5, 1.5)

    def pin(
        self,
        name: str | None = None,
        *,
        above: bool | None = None,
        x: float | None = None,
        radius: float | None = None,
    ) -> None:
        """Add a pin that starts near a beam and moves into it, or along it and into it."""
        name = name or self.one_of(*self.corners)
        start, end = self.corners[name]
        above = self.chance(0.5) if above is None else above
        left = above == (end[0] > start[0] or (end[0] == start[0] and end[1] > start[1]))
        size = math.dist(start, end)
        tx, ty = (end[0] - start[0]) / size, (end[1] - start[1]) / size
        sign = 1.0 if left else -1.0
        if radius is None and self.chance(0.3):
            radius = 10.0 ** self.random.uniform(-3.0, -0.3)
        beam = next(item for item in self.beams if item["name"] == name)
        face = "height" in beam and self.chance(0.3)
        offset = (radius or 0.0) + (0.5 * beam["height"] / self.place.length if face else 0.0)
        along = size * (self.one_of(self.random.uniform(0.02, 1.0), 0.5, 0.25, 1.0) if x is None else x)
        away = offset * (1.0 + 1e-12) + self.one_of(0.0, 0.0, 0.01, 0.1)
        points = [(along, away)]
        for _ in range(self.one_of(1, 1, 2, 3)):
            last = points[-1]
            points.append((last[0] + size * self.one_of(0.0, self.random.uniform(-0.4, 0.3)),
                           last[1] - size * self.random.uniform(-0.05, 0.35)))  # fmt: skip
        path = [
            self.place.point(start[0] + s * tx - sign * g * ty, start[1] + s * ty + sign * g * tx) for s, g in points
        ]  # fmt: skip
        pin: Tables = {"name": f"p{len(self.pins)}"}
        if radius is not None:
            pin["radius"] = radius * self.place.length
        if len(path) == 2:
            pin |= {"start": path[0], "displacement": [path[1][0] - path[0][0], path[1][1] - path[0][1]]}
        else:
            pin["path"] = path
        self.pins.append(pin)
        self.contacts.append({"node": pin["name"], "beam": name, "side": "left" if left else "right"})
        if face:
            self.contacts[-1]["surface"] = "face"
        if self.chance(0.05):
            self.contacts[-1]["keep"] = True

    def touch(self, node: str, name: str, *, above: bool) -> None:
        """Let a beam's end meet a beam."""
        start, end = self.corners[name]
        self.contacts.append(
            {"node": node, "beam": name, "side": "left" if above == (end[0] > start[0]) else "right"}
        )
        beam = next(item for item in self.beams if item["name"] == name)
        if "height" in beam and self.chance(0.2):
            self.contacts[-1]["surface"] = "face"

"""Scenes that obey every rule: one to three beams, frames, supports, loads, pins, contacts, of any magnitude.

A scene is drawn as the dictionary that its TOML file holds; lengths are drawn as parts of the beam's length and turned, scaled and
shifted as a whole. Few elements, cells and load parameters: what runs long here runs too long.
"""

import math
from typing import Any

from hypothesis import strategies as st
from hypothesis.internal.conjecture import providers

# draws depend on the seed alone, not on the numbers that the imported modules hold
providers._get_local_constants = providers.Constants

Tables = dict[str, Any]
SCENES = ("cantilever", "tied", "frame", "stack")


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    """Positive numbers, equally likely in every decade between ``10^low`` and ``10^high``."""
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


def parts(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers with three decimals: as people write them, and often equal, zero or at an end."""
    return st.integers(round(1000 * low), round(1000 * high)).map(lambda number: number / 1000)


@st.composite
def frames_of_reference(draw: st.DrawFn) -> tuple[float, float, tuple[float, float]]:
    """Length of a scene, its angle to the x axis and its origin."""
    length = draw(st.one_of(st.just(1.0), powers(-3, 3), powers(-60, 60)))
    angle = draw(st.sampled_from([0.0, 0.0, math.pi / 2, math.pi, 0.3, -2.1]))
    origin = draw(st.sampled_from([(0.0, 0.0), (0.0, 0.0), (2.5, -1.0), (1e3, 1e3)]))
    return length, angle, (length * origin[0], length * origin[1])


class Place:
    """Where a scene lies: turns parts of its length into coordinates."""

    def __init__(self, length: float, angle: float, origin: tuple[float, float]) -> None:
        self.length, self.origin = length, origin
        self.cos, self.sin = math.cos(angle), math.sin(angle)

    def vector(self, x: float, y: float) -> list[float]:
        return [
            self.length * (self.cos * x - self.sin * y) + 0.0,
            self.length * (self.sin * x + self.cos * y) + 0.0,
        ]

    def point(self, x: float, y: float) -> list[float]:
        vx, vy = self.vector(x, y)
        return [self.origin[0] + vx, self.origin[1] + vy]


places = frames_of_reference().map(lambda drawn: Place(*drawn))


@st.composite
def sections(draw: st.DrawFn, length: float) -> Tables:
    """Section and material of a beam."""
    height = length * draw(st.one_of(st.sampled_from([0.02, 0.05, 0.005]), powers(-4, -0.3)))
    width = height * draw(st.one_of(st.just(1.0), powers(-2, 2)))
    stiffness = draw(st.one_of(st.sampled_from([2.1e4, 7e10]), powers(-9, 15)))
    section: Tables = {"youngs_modulus": stiffness}
    if draw(st.booleans()):
        section |= {"width": width, "height": height}
    else:
        section |= {"area": width * height, "second_moment": width * height**3 / 12.0}
        if draw(st.booleans()):
            section["shear_area"] = 0.8 * width * height
    if draw(st.booleans()):
        section["poissons_ratio"] = draw(st.sampled_from([0.3, 0.0, 0.49, -0.5, 0.4999]))
    else:
        section["shear_modulus"] = stiffness * draw(st.sampled_from([0.385, 0.5, 0.05, 10.0]))
    return section


@st.composite
def beams(draw: st.DrawFn, name: str, start: list[float], end: list[float], clamped: list[str]) -> Tables:
    """A beam with few elements."""
    beam: Tables = {"name": name, "start": start, "end": end, **draw(sections(math.dist(start, end)))}
    if clamped:
        beam["clamped"] = clamped
    beam["elements"] = draw(st.integers(1, 8))
    if draw(st.booleans()) and draw(st.booleans()):
        beam["nodes"] = sorted(set(draw(st.lists(parts(0.05, 0.95), min_size=1, max_size=4))))
    beam["mesh"] = [draw(st.integers(2, 10)), draw(st.integers(1, 2))]
    beam["material"] = draw(st.sampled_from(["st-venant-kirchhoff", "biot-linear", "neo-hookean"]))
    beam["solid_clamp"] = draw(st.sampled_from(["rod", "full"]))
    beam["solid_element"] = draw(st.sampled_from(["Q2", "Q2", "Q2-full", "Q1"]))
    return beam


def head(draw: st.DrawFn) -> Tables:
    """Name, units and number of load parameters of a scene."""
    return {
        "name": draw(st.sampled_from(["mine", "Balken-2", "梁"])),
        "units": draw(st.sampled_from(["N, m", "kN, cm"])),
        "load_parameters": draw(st.integers(1, 5)),
    }


@st.composite
def pin_paths(draw: st.DrawFn, place: Place, side: float, offset: float) -> Tables:
    """A pin that starts above or on the surface of a beam of length 1 along x and moves on, through it or along it."""
    x = draw(st.one_of(parts(0.05, 1.0), st.sampled_from([0.5, 0.25, 1.0, 1.2])))
    y = side * (offset + draw(st.sampled_from([0.0, 0.0, 0.0, 0.01, 0.1])))
    legs = draw(st.lists(st.tuples(parts(-0.5, 0.3), parts(-0.2, 0.5)), min_size=1, max_size=3))
    points = [(x, y)]
    for dx, dy in legs:
        points.append((points[-1][0] + dx, points[-1][1] - side * dy))
    if len(points) == 2 and points[0] != points[1]:
        step = place.vector(points[1][0] - x, points[1][1] - y)
        return {"start": place.point(x, y), "displacement": step}
    return {"path": [place.point(*point) for point in points]}


frictions = st.one_of(
    st.just({}),
    st.just({}),
    st.one_of(parts(0.0, 1.0), st.just(0.0), powers(-9, 2)).map(lambda mu: {"friction": mu}),
)
"""Coefficient of friction of a contact, if it has one."""


@st.composite
def cantilevers(draw: st.DrawFn) -> Tables:
    """One clamped beam under one pin: what the exact rod can state."""
    place = draw(places)
    at_start = draw(st.booleans())
    ends = [place.point(0.0, 0.0), place.point(1.0, 0.0)]
    beam = draw(beams("beam", *(ends if at_start else ends[::-1]), ["start" if at_start else "end"]))
    side = draw(st.sampled_from([1.0, -1.0]))
    left = (side > 0) == at_start
    contact: Tables = {"node": "pin", "beam": "beam", "side": "left" if left else "right"}
    offset = 0.0
    if "height" in beam and draw(st.booleans()):
        contact["surface"] = "face"
        offset = 0.5 * beam["height"] / place.length
    pin: Tables = {"name": "pin"}
    if draw(st.booleans()) and draw(st.booleans()):
        radius = draw(powers(-3, -1))
        pin["radius"] = radius * place.length
        offset += radius
    if draw(st.booleans()) and draw(st.booleans()):
        contact["keep"] = True
    contact |= draw(frictions)
    return {
        "scene": head(draw),
        "beam": [beam],
        "pin": [pin | draw(pin_paths(place, side, offset))],
        "contact": [contact],
    }


@st.composite
def tied_tips(draw: st.DrawFn) -> Tables:
    """One clamped beam whose other end a pinned support moves."""
    place = draw(places)
    beam = draw(beams("beam", place.point(0.0, 0.0), place.point(1.0, 0.0), ["start"]))
    motion = place.vector(draw(parts(-0.8, 0.02)), draw(parts(-0.7, 0.7)))
    support = {"beam": "beam", "end": "end", "kind": "pinned", "displacement": motion}
    return {"scene": head(draw), "beam": [beam], "support": [support]}


@st.composite
def loads(draw: st.DrawFn, beam: Tables, end: str) -> Tables:
    """A dead load on a beam's end of a size that bends it, or much more or less."""
    length = math.dist(beam["start"], beam["end"])
    inertia = beam.get("second_moment") or beam["width"] * beam["height"] ** 3 / 12.0
    scale = beam["youngs_modulus"] * inertia / length**2 * draw(st.one_of(parts(0.0, 5.0), powers(-6, 3)))
    force = [scale * draw(parts(-1.0, 1.0)), scale * draw(parts(-1.0, 1.0))]
    return {
        "beam": beam["name"],
        "end": end,
        "force": force,
        "moment": scale * length * draw(parts(-1.0, 1.0)),
    }


@st.composite
def frames(draw: st.DrawFn) -> Tables:
    """A chain of one to three rigidly joined beams with supports and dead loads, perhaps under a pin."""
    place = draw(places)
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.2, 1.4)][: 1 + draw(st.integers(1, 3))]
    points = [place.point(*corner) for corner in corners]
    names = ["a", "b", "c"]
    chain = [draw(beams(names[i], points[i], points[i + 1], [])) for i in range(len(points) - 1)]
    last = chain[-1]
    supports: list[Tables] = [
        {"beam": "a", "end": "start", "kind": draw(st.sampled_from(["clamped", "pinned"]))}
    ]
    if supports[0]["kind"] == "pinned" or draw(st.booleans()):
        other: Tables = {"beam": last["name"], "end": "end"}
        kind = draw(st.sampled_from(["clamped", "pinned", "roller", "fixed"]))
        extra = {
            "roller": {"kind": kind, "free": draw(st.sampled_from("xy"))},
            "fixed": {"fixed": ["rotation"]},
        }
        supports.append(other | extra.get(kind, {"kind": kind}))
        if kind == "clamped" and draw(st.booleans()):
            supports[-1] |= {
                "displacement": place.vector(draw(parts(-0.2, 0.2)), 0.05),
                "rotation": draw(parts(-1, 1)),
            }
    scene: Tables = {"scene": head(draw), "beam": chain, "support": supports}
    scene["load"] = [draw(loads(chain[0], "end"))]
    if draw(st.booleans()):
        scene["pin"] = [{"name": "pin", **draw(pin_paths(place, 1.0, 0.0))}]
        scene["contact"] = [{"node": "pin", "beam": "a", "side": "left", **draw(frictions)}]
    return scene


@st.composite
def stacks(draw: st.DrawFn) -> Tables:
    """Two or three cantilevers one above the other: a pin presses the first, whose end meets the next."""
    place = draw(places)
    number = draw(st.integers(2, 3))
    gap = draw(parts(0.01, 0.3))
    levels = [-gap * i for i in range(number)]
    chain = [
        draw(beams(f"b{i}", place.point(0.0, y), place.point(1.0 + 0.1 * i, y), ["start"]))
        for i, y in enumerate(levels)
    ]
    contacts: list[Tables] = [{"node": "pin", "beam": "b0", "side": "left"}]
    contacts += [{"node": f"b{i}.end", "beam": f"b{i + 1}", "side": "left"} for i in range(number - 1)]
    if draw(st.booleans()):
        contacts.append({"node": "pin", "beam": "b1", "side": "left"})
    contacts = [contact | draw(frictions) for contact in contacts]
    return {
        "scene": head(draw),
        "beam": chain,
        "pin": [{"name": "pin", **draw(pin_paths(place, 1.0, 0.0))}],
        "contact": contacts,
    }


@st.composite
def extended(draw: st.DrawFn, scenes: st.SearchStrategy[Tables]) -> Tables:
    """A scene, perhaps with springs, loads along a beam, a weight, a hinge with a stiffness, a taper, a curvature and a stage."""
    scene = draw(scenes)
    wanted = draw(st.sets(st.sampled_from(sorted(EXTENSIONS)), max_size=3))
    for name in sorted(wanted):
        EXTENSIONS[name](draw, scene, draw(st.sampled_from(scene["beam"])))
    return scene


def _bending(beam: Tables, power: int) -> float:
    """EI over a power of the length."""
    inertia = beam.get("second_moment") or beam["width"] * beam["height"] ** 3 / 12.0
    return float(beam["youngs_modulus"] * inertia / math.dist(beam["start"], beam["end"]) ** power)


def _spring(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    size = draw(powers(-3, 3))
    stiffness = [size * _bending(beam, 3), draw(st.sampled_from([0.0, 1.0])) * size * _bending(beam, 3)]
    rotation = draw(st.sampled_from([0.0, size])) * _bending(beam, 1)
    end = draw(st.sampled_from(["start", "end"]))
    scene["spring"] = [{"beam": beam["name"], "end": end, "stiffness": stiffness, "rotation": rotation}]


def _along(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    size = draw(powers(-3, 1))
    load: Tables = {"beam": beam["name"]}
    if draw(st.booleans()):
        load |= {"at": draw(parts(0.05, 0.95)), "force": [0.0, size * _bending(beam, 2)]}
    else:
        load |= {"force_per_length": [size * _bending(beam, 3), 0.5 * size * _bending(beam, 3)]}
        if draw(st.booleans()):
            load["part"] = [0.25, draw(parts(0.3, 1.0))]
    scene.setdefault("load", []).append(load)


def _weight(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    area = beam.get("area") or beam["width"] * beam["height"]
    beam["density"] = draw(powers(-3, 1)) * _bending(beam, 3) / area
    scene["scene"]["gravity"] = [0.0, -1.0]


def _hinge(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    """Hinge an end that is clamped."""
    if beam.get("clamped"):
        stiffness = draw(powers(-2, 3)) * _bending(beam, 1)
        scene["hinge"] = [{"beam": beam["name"], "end": beam["clamped"][0], "stiffness": stiffness}]


def _taper(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    faces = any(contact.get("surface") == "face" for contact in scene.get("contact", ()))
    if isinstance(beam.get("height"), float) and "shear_area" not in beam and not faces:
        beam["height"] = [beam["height"], draw(parts(0.3, 1.5)) * beam["height"]]


def _turn(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    """Curve a beam that nothing touches."""
    if not scene.get("contact"):
        beam["turn"] = draw(parts(-3.0, 3.0))


def _stage(draw: st.DrawFn, scene: Tables, beam: Tables) -> None:
    stage: Tables = {"load_parameters": draw(st.integers(1, 3))}
    length = math.dist(beam["start"], beam["end"])
    if scene.get("pin"):
        way = [length * draw(parts(-0.2, 0.2)), length * 0.05]
        stage["pin"] = [{"name": scene["pin"][0]["name"], "displacement": way}]
    else:
        stage["load"] = [{"beam": beam["name"], "end": "end", "moment": 0.3 * _bending(beam, 1)}]
    if draw(st.booleans()):
        stage["name"] = "onward"
    scene["stage"] = [stage]


EXTENSIONS = {
    "along": _along, "hinge": _hinge, "spring": _spring, "stage": _stage, "turn": _turn, "weight": _weight, "with taper": _taper,
}  # fmt: skip
"""Changes of a scene that keep it valid, in an order in which each finds the section as it is drawn: the taper after all that use it."""


valid_scenes = extended(st.one_of(cantilevers(), cantilevers(), tied_tips(), frames(), stacks()))

"""Strips, problems and solutions that several tests share."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference as fr

STRIP, PAIR, CLAMP, TIP = "cantilever", "pin->cantilever", "cantilever.start", "cantilever.end"
E, B, NU, H = 2.1e4, 0.02, 0.3, 0.02
EA, EI, GA = E * B * H, E * B * H**3 / 12, 5 / 6 * E / (2 * (1 + NU)) * B * H
surfaces = pytest.mark.parametrize("surface", ["axis", "face"])
elements = pytest.mark.parametrize("element", fr.ELEMENTS)


def loads(n):
    """Load parameters ``1/n, 2/n, ..., 1``."""
    return np.arange(1, n + 1) / n


def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def make_strip(**changes):
    ends = {"name": STRIP, "start": (0.0, 0.0), "end": (1.0, 0.0), "mesh": (50, 2)}
    section = {"height": H, "width": B, "youngs_modulus": E, "poissons_ratio": NU}
    return fr.Strip(**(ends | section | changes))


def make_problem(path=None, radius=0.0, contact=None, **changes):
    """The KS cantilever, or another path and other strips."""
    values = {"node": "pin", "strip": STRIP, "penalty": 1e4} | (contact or {})
    y = (-0.01 if values.get("surface") == "face" else 0.0) - radius
    pin = fr.Pin(name="pin", path=path or ((1.0, y), (0.0, y + 2 / np.pi)), radius=radius)
    return fr.SolidProblem(strips=(make_strip(**changes),), pins=(pin,), contacts=(fr.Contact(**values),))


KINDS = {fr.Support: "supports", fr.Spring: "springs", fr.LineLoad: "loads", fr.PointLoad: "loads"}


def held(*conditions, **changes):
    """One strip, clamped only if the changes say so, with its supports, springs and loads."""
    found = {field: [] for field in KINDS.values()}
    for condition in conditions:
        found[KINDS[type(condition)]].append(condition)
    strip = make_strip(**({"clamped": ()} | changes))
    return fr.SolidProblem(strips=(strip,), **{field: tuple(part) for field, part in found.items()})


def pressed(problem, path, radius=0.0, **contact):
    """The strip of a problem, also under a pin."""
    pin = fr.Pin(name="pin", path=path, radius=radius)
    contacts = (fr.Contact(node="pin", strip=STRIP, **contact),)
    return replace(problem, pins=(pin,), contacts=contacts)


def support(end="start", motion=(0.0, 0.0, 0.0), **values):
    return fr.Support(strip=STRIP, end=end, motion=motion, **values)


def load(**values):
    return fr.PointLoad(**({"strip": STRIP} | values))


def portal():
    """A frame on a moving clamp and a roller, with a moment at a corner and a pin on its girder."""
    part = {"mesh": (6, 1), "height": 0.06, "clamped": ()}
    corners = (0.0, 0.0), (0.0, 0.8), (1.0, 0.8), (1.1, 0.0)
    ends = {"left": corners[:2], "girder": corners[1:3], "right": corners[2:]}
    return fr.SolidProblem(
        strips=tuple(make_strip(name=name, start=a, end=b, **part) for name, (a, b) in ends.items()),
        pins=(fr.Pin(name="pin", path=((0.5, 0.83), (0.5, 0.7))),),
        contacts=(fr.Contact(node="pin", strip="girder", side="left", surface="face"),),
        supports=(
            fr.Support(strip="left", end="start", motion=(0.01, 0.02, -0.1)),
            fr.Support(strip="right", end="end", motion=(None, -0.01, None)),
        ),
        joints=(fr.Joint(ends=("left.end", "girder.start")), fr.Joint(ends=("right.start", "girder.end"))),
        loads=(fr.PointLoad(strip="girder", at=0.0, force=(1e-4, 0.0), moment=2e-5),),
    )


def upper_on_lower(mesh, friction=0.0, **contact):
    """The end of an upper strip that a load presses on a lower strip of the opposite direction."""
    upper = make_strip(name="upper", start=(0.0, 0.1), end=(0.8, 0.05), mesh=mesh)
    lower = make_strip(name="lower", start=(1.0, 0.0), end=(0.1, 0.0), mesh=mesh)
    values = {"node": "upper.end", "strip": "lower", "surface": "face", "friction": friction}
    pressed = fr.PointLoad(strip="upper", force=(0.0, -4e-3))
    return fr.SolidProblem(
        strips=(upper, lower), contacts=(fr.Contact(**(values | contact)),), loads=(pressed,)
    )

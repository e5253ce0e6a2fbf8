"""What is to be solved: a clamped strip, a pin on a path, and their contact."""

from dataclasses import dataclass
from math import hypot, isfinite

import numpy as np

from fem_reference.arrays import Array, Floats
from fem_reference.material import MATERIALS, PLANES

Point = tuple[float, float]


def _require(condition: bool, owner: str, field: str, value: object, rule: str) -> None:
    if not condition:
        raise ValueError(f"{owner}.{field} = {value!r}: {rule}")


def _require_positive(owner: str, field: str, value: float) -> None:
    _require(isfinite(value) and value > 0, owner, field, value, "must be positive and finite")


def _require_point(owner: str, field: str, value: Point) -> None:
    _require(len(value) == 2 and all(map(isfinite, value)), owner, field, value, "must be two finite numbers")


@dataclass(frozen=True, kw_only=True)
class Strip:
    """A straight strip of rectangular section, clamped at one end.

    Parameters
    ----------
    name
        How results refer to it.
    start, end
        Ends of the axis [m]; its direction is from start to end.
    height, width
        Dimensions of the section in the plane and out of it [m].
    youngs_modulus, poissons_ratio
        Elastic constants [Pa, -].
    clamped
        The clamped end, ``("start",)`` or ``("end",)``.
    clamp
        ``"rod"``: no axial displacement on the edge, no transverse one at its middle (the clamp of a rod; Poisson's
        contraction stays free). ``"full"``: both displacements vanish on the edge.
    mesh
        Numbers of biquadratic elements along the axis (at least 2) and over the height.
    material
        A key of `fem_reference.material.MATERIALS`.
    plane
        ``"stress"``: free to contract out of the plane; ``"strain"``: not.

    Raises
    ------
    ValueError
        If a value breaks its rule.
    """

    name: str
    start: Point
    end: Point
    height: float
    width: float
    youngs_modulus: float
    poissons_ratio: float
    clamped: tuple[str, ...] = ("start",)
    clamp: str = "rod"
    mesh: tuple[int, int] = (50, 2)
    material: str = "st-venant-kirchhoff"
    plane: str = "stress"

    def __post_init__(self) -> None:
        owner = f"Strip({self.name!r})"
        _require_point(owner, "start", self.start)
        _require_point(owner, "end", self.end)
        _require(self.length > 0, owner, "end", self.end, "must differ from start")
        for field in ("height", "width", "youngs_modulus"):
            _require_positive(owner, field, getattr(self, field))
        nu = self.poissons_ratio
        _require(-1 < nu < 0.5, owner, "poissons_ratio", nu, "must lie between -1 and 0.5")
        clamps = (("start",), ("end",))
        _require(self.clamped in clamps, owner, "clamped", self.clamped, 'must be ("start",) or ("end",)')
        _require(self.clamp in ("rod", "full"), owner, "clamp", self.clamp, 'must be "rod" or "full"')
        whole = all(isinstance(n, int) for n in self.mesh) and len(self.mesh) == 2
        _require(
            whole and self.mesh[0] >= 2 and self.mesh[1] >= 1,
            owner,
            "mesh",
            self.mesh,
            "must be two whole numbers, >= 2 and >= 1",
        )
        _require(
            self.material in MATERIALS,
            owner,
            "material",
            self.material,
            f"must be one of {', '.join(MATERIALS)}",
        )
        _require(self.plane in PLANES, owner, "plane", self.plane, f"must be one of {', '.join(PLANES)}")

    @property
    def length(self) -> float:
        """Length of the axis [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    @property
    def bending_stiffness(self) -> float:
        """``E b h^3 / 12`` [N m^2]."""
        return self.youngs_modulus * self.width * self.height**3 / 12

    @property
    def frame(self) -> Floats:
        """Rotation ``Q (2, 2)`` from the strip's frame (x along the axis, origin at start) to the global one."""
        c = (self.end[0] - self.start[0]) / self.length
        s = (self.end[1] - self.start[1]) / self.length
        return np.array([[c, -s], [s, c]])

    def to_local(self, points: Array) -> Array:
        """Points ``(..., 2)`` from the global frame to the strip's."""
        local: Array = (points - np.array(self.start)) @ self.frame
        return local

    def to_global(self, points: Array) -> Array:
        """Points ``(..., 2)`` from the strip's frame to the global one."""
        placed: Array = points @ self.frame.T + np.array(self.start)
        return placed


@dataclass(frozen=True, kw_only=True)
class Pin:
    """A sharp rigid pin led along a polyline at constant speed.

    Parameters
    ----------
    name
        How contacts refer to it.
    path
        At least two points [m]. The load parameter t in [0, 1] is the fraction of the path's length.

    Raises
    ------
    ValueError
        If a point is not finite or the path has no length.
    """

    name: str
    path: tuple[Point, ...]

    def __post_init__(self) -> None:
        owner = f"Pin({self.name!r})"
        for point in self.path:
            _require_point(owner, "path", point)
        _require(len(self.path) >= 2, owner, "path", self.path, "must have at least two points")
        _require(len(set(self.path)) > 1, owner, "path", self.path, "must have a positive length")

    def position(self, t: float) -> Floats:
        """Return the pin's position ``(2,)`` at the load parameter ``t``."""
        points = np.array(self.path, dtype=float)
        legs = np.hypot(*np.diff(points, axis=0).T)
        fractions = np.concatenate([[0.0], np.cumsum(legs)]) / legs.sum()
        return np.array([np.interp(t, fractions, points[:, i]) for i in range(2)])


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Frictionless unilateral contact of a pin with a strip.

    Parameters
    ----------
    pin, strip
        Names of the two.
    side
        Side of the strip, looking from start to end, that the pin comes from: ``"right"`` or ``"left"``.
    surface
        ``"axis"``: the curve of section-mean positions; ``"face"``: the face on the pin's side.
    penalty
        Contact stiffness eps of the energy ``eps |x_c - r|^2 / 2`` [N/m]; see `default_penalty`.

    Raises
    ------
    ValueError
        If a value breaks its rule.
    """

    pin: str
    strip: str
    side: str = "right"
    surface: str = "axis"
    penalty: float

    def __post_init__(self) -> None:
        owner = f"Contact({self.name!r})"
        _require(self.side in ("right", "left"), owner, "side", self.side, 'must be "right" or "left"')
        _require(self.surface in ("axis", "face"), owner, "surface", self.surface, 'must be "axis" or "face"')
        _require_positive(owner, "penalty", self.penalty)

    @property
    def name(self) -> str:
        """Name of the pair, ``"pin->strip"``."""
        return f"{self.pin}->{self.strip}"

    @property
    def sign(self) -> float:
        """Sign s of the gap ``g = s n . (x_c - r)``, n the left normal: +1 on the left, -1 on the right."""
        return 1.0 if self.side == "left" else -1.0


@dataclass(frozen=True, kw_only=True)
class SolidProblem:
    """One strip, one pin and their contact.

    Raises
    ------
    ValueError
        If the contact names another pin or strip, or if the pin starts on the wrong side of the strip.
    """

    strip: Strip
    pin: Pin
    contact: Contact

    def __post_init__(self) -> None:
        owner = f"Contact({self.contact.name!r})"
        _require(
            self.contact.pin == self.pin.name, owner, "pin", self.contact.pin, "must name the problem's pin"
        )
        _require(
            self.contact.strip == self.strip.name,
            owner,
            "strip",
            self.contact.strip,
            "must name the problem's strip",
        )
        axial, transverse = self.strip.to_local(np.array(self.pin.path[0], dtype=float))
        height = self.strip.height / 2 if self.contact.surface == "face" else 0.0
        gap = self.contact.sign * transverse - height
        length = self.strip.length
        _require(
            gap >= -1e-9 * length or not 0 < axial < length,
            f"Pin({self.pin.name!r})",
            "path[0]",
            self.pin.path[0],
            f"must not start beyond the {self.contact.side} {self.contact.surface} of the strip (gap {gap:.3g})",
        )


def default_penalty(strip: Strip) -> float:
    """Return 25 E b [N/m]: a contact spring 25 times as stiff as the material under a line load.

    Local indentation scales with F / (E b), so the penetration stays small beside it in every strip; against the
    bending stiffness ``3 E I / L^3 = E b (h / L)^3 / 4`` it is smaller still.
    """
    return 25 * strip.youngs_modulus * strip.width

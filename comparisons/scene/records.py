"""A beam and the whole scene, as hashable records without arrays that check their values at construction."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

from comparisons.scene import rules
from comparisons.scene.conditions import LoadSpec, SupportSpec
from comparisons.scene.contact import ContactSpec, PinSpec
from comparisons.scene.rules import (
    Count,
    FieldError,
    Name,
    Point,
    Positive,
    Vector,
    apply_rules,
    exactly_one_of,
)


@dataclass(frozen=True, kw_only=True)
class BeamSpec:
    """A straight, uniform beam.

    The section is a rectangle `width` x `height` (effective shear area 5/6 of the area), or `area` and `second_moment`
    (effective shear area equal to the area); `shear_area` overrides the effective shear area. The material is isotropic:
    Young's modulus and either Poisson's ratio or the shear modulus, ``G = E/(2 (1 + nu))``.

    Parameters
    ----------
    name : str
        Letters, digits, ``-`` and ``_``.
    start, end : (float, float)
        The ends of the undeformed axis [length].
    youngs_modulus : float
        Young's modulus [force/length^2].
    poissons_ratio : float
        Poisson's ratio.
    shear_modulus : float
        Shear modulus, instead of `poissons_ratio` [force/length^2].
    width : float
        Width of the section, out of plane [length].
    height : float
        Height of the section, in plane [length].
    area : float
        Area of the section, with `second_moment` instead of `width` and `height` [length^2].
    second_moment : float
        Second moment of area, with `area` [length^4].
    shear_area : float
        Effective shear area [length^2].
    clamped : tuple of {"start", "end"}
        Clamped ends, none by default: the short form of a `SupportSpec`.
    elements : int
        Number of TSM elements, all of one length.
    nodes : tuple of float
        Positions of the inner TSM nodes as parts of the length, instead of `elements`.
    mesh : (int, int)
        Elements of the solid along and across.
    solid_clamp : {"rod", "full"}
        Clamp of the solid: free to contract, or both displacements of the whole edge held.
    solid_element : {"Q1", "Q2", "Q2-full"}
        Elements of the solid.
    solid_mesh_file : str, optional
        File with a mesh of the solid in the beam's frame and with named edges, instead of `mesh`: see
        `fem_reference.mesh_file.read_mesh`.
    material : {"st-venant-kirchhoff", "biot-linear", "neo-hookean"}
        Material law of the solid.

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    name: Name
    start: Vector
    end: Vector
    youngs_modulus: Positive
    poissons_ratio: Annotated[float, rules.poissons_ratio] | None = None
    shear_modulus: Positive | None = None
    width: Positive | None = None
    height: Positive | None = None
    area: Positive | None = None
    second_moment: Positive | None = None
    shear_area: Positive | None = None
    clamped: Annotated[tuple[str, ...], rules.ends] = ()
    elements: Count = 20
    nodes: Annotated[tuple[float, ...], rules.parts] = ()
    mesh: Annotated[tuple[int, int], rules.mesh] = (50, 2)
    solid_clamp: Annotated[str, rules.choice("rod", "full")] = "rod"
    solid_mesh_file: Annotated[str, rules.text] | None = None
    solid_element: Annotated[str, rules.choice("Q1", "Q2", "Q2-full")] = "Q2"
    material: Annotated[str, rules.choice("st-venant-kirchhoff", "biot-linear", "neo-hookean")] = (
        "st-venant-kirchhoff"
    )

    def __post_init__(self) -> None:
        apply_rules(self)
        exactly_one_of(vars(self), (("poissons_ratio",), ("shear_modulus",)))
        exactly_one_of(vars(self), (("width", "height"), ("area", "second_moment")))
        shortest = 1.0 / rules.LARGEST
        if not shortest <= self.length <= rules.LARGEST:
            rule = f"must differ from start, the distance {self.length:g} must lie between {shortest:g} and {rules.LARGEST:g}"
            raise FieldError("end", self.end, rule)
        least, most = rules.RANGE
        for name in ("EA", "GA", "EI"):
            stiffness = getattr(self, name)
            if not least <= stiffness <= most:
                rule = f"{name} = {stiffness:g} must lie between {least:g} and {most:g}"
                raise FieldError("youngs_modulus", self.youngs_modulus, rule)

    @property
    def length(self) -> float:
        """Length of the undeformed axis."""
        return math.dist(self.start, self.end)

    @property
    def direction(self) -> Point:
        """Unit vector from start to end."""
        (x0, y0), (x1, y1) = self.start, self.end
        return (x1 - x0) / self.length, (y1 - y0) / self.length

    @property
    def EA(self) -> float:
        """Stretching stiffness [force]."""
        return self.youngs_modulus * self.cross_section[0]

    @property
    def GA(self) -> float:
        """Shear stiffness G A_e [force]."""
        G = self.shear_modulus or self.youngs_modulus / (2.0 * (1.0 + (self.poissons_ratio or 0.0)))
        return G * self.cross_section[2]

    @property
    def EI(self) -> float:
        """Bending stiffness [force length^2]."""
        return self.youngs_modulus * self.cross_section[1]

    @property
    def cross_section(self) -> tuple[float, float, float]:
        """Area, second moment of area and effective shear area."""
        if self.width and self.height:
            A, inertia, kappa = self.width * self.height, self.width * _cube(self.height) / 12.0, 5.0 / 6.0
        else:
            A, inertia, kappa = self.area or 0.0, self.second_moment or 0.0, 1.0
        return A, inertia, self.shear_area or kappa * A

    @property
    def rectangle_height(self) -> float:
        """Height of the section, or ``sqrt(12 I/A)`` of the rectangle with its area and second moment."""
        area, inertia, _ = self.cross_section
        return self.height or math.sqrt(12.0 * inertia / area)


def _cube(number: float) -> float:
    """Third power; infinite where Python's power raises OverflowError."""
    try:
        return number**3
    except OverflowError:
        return math.inf


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Beams with supports and loads, pins and contacts, and the load parameters ``t_k = k/n`` that every model hits exactly.

    Beams whose ends have the same coordinates are rigidly joined there.

    Parameters
    ----------
    name : str
        Letters, digits, ``-`` and ``_``.
    units : str
        Units of force and length, as ``"N, m"``.
    load_parameters : int
        Number n of load parameters.
    beams : tuple of BeamSpec
        At least one.
    supports, loads, pins, contacts : tuple of SupportSpec, LoadSpec, PinSpec, ContactSpec
        Every pin is in a contact. At least one pin, load or moving support is needed, and no beam may be free.

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    name: Name
    units: Annotated[str, rules.units] = "N, m"
    load_parameters: Count
    beams: Annotated[tuple[BeamSpec, ...], rules.records(BeamSpec, at_least=1)]
    supports: Annotated[tuple[SupportSpec, ...], rules.records(SupportSpec)] = ()
    loads: Annotated[tuple[LoadSpec, ...], rules.records(LoadSpec)] = ()
    pins: Annotated[tuple[PinSpec, ...], rules.records(PinSpec)] = ()
    contacts: Annotated[tuple[ContactSpec, ...], rules.records(ContactSpec)] = ()

    def __post_init__(self) -> None:
        from comparisons.scene.consistency import check_scene

        apply_rules(self)
        check_scene(self)

    @cached_property
    def _beams(self) -> dict[str, BeamSpec]:
        return {beam.name: beam for beam in self.beams}

    @cached_property
    def _pins(self) -> dict[str, PinSpec]:
        return {pin.name: pin for pin in self.pins}

    def beam(self, name: str) -> BeamSpec:
        """Return the beam called `name`."""
        return self._beams[name]

    def pin(self, name: str) -> PinSpec:
        """Return the pin called `name`."""
        return self._pins[name]

    def offset(self, contact: ContactSpec) -> float:
        """Distance of the contact's node, or of its pin's centre, from the axis where they touch."""
        height = self.beam(contact.beam).height
        surface = 0.0 if contact.surface == "axis" or height is None else height / 2.0
        return surface + self.radius(contact)

    def radius(self, contact: ContactSpec) -> float:
        """Radius of the contact's pin, zero for a point."""
        pin = self._pins.get(contact.node)
        return (pin and pin.radius) or 0.0

    @cached_property
    def all_supports(self) -> tuple[SupportSpec, ...]:
        """The clamped ends of the beams, then `supports`."""
        clamps = (
            SupportSpec(beam=beam.name, end=end, kind="clamped")
            for beam in self.beams
            for end in beam.clamped
        )
        return (*clamps, *self.supports)

    @cached_property
    def _supports_of(self) -> dict[str, tuple[SupportSpec, ...]]:
        own: dict[str, list[SupportSpec]] = {beam.name: [] for beam in self.beams}
        for support in self.all_supports:
            own[support.beam].append(support)
        return {
            beam: tuple(sorted(all_own, key=lambda support: (-len(support.held), support.end == "end")))
            for beam, all_own in own.items()
        }

    def place(self, node: str) -> Point:
        """Return the undeformed position of a beam's end, ``upper.end``."""
        name, end = node.split(".")
        beam = self.beam(name)
        return beam.start if end == "start" else beam.end

    def supports_of(self, beam: str) -> tuple[SupportSpec, ...]:
        """Return the supports of a beam by falling number of held components; at equality the support at the start is first."""
        return self._supports_of[beam]

    def tip(self, beam: str) -> str:
        """Return the end of a beam with fewer held components, "end" at equality."""
        own = self.supports_of(beam)
        more = bool(own) and own[0].end == "end" and (len(own) == 1 or own[0].held != own[1].held)
        return "start" if more else "end"

    @property
    def times(self) -> tuple[float, ...]:
        """The load parameters k/n, k = 1..n."""
        n = self.load_parameters
        return tuple(k / n for k in range(1, n + 1))

"""Supports and loads of beam ends, as hashable records without arrays that check their values at construction."""

from dataclasses import dataclass
from typing import Annotated

from comparisons.scene import rules
from comparisons.scene.rules import MISSING, FieldError, Name, Number, Vector, apply_rules, exactly_one_of

COMPONENTS = ("x", "y", "rotation")
"""Components of an end's motion, in the order of `SupportSpec.motion`."""


@dataclass(frozen=True, kw_only=True)
class SupportSpec:
    """A support of a beam's end. A held component stays at rest, or moves by a prescribed amount times the load parameter.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end. Beams that share an end are rigidly joined there: one support holds the joint.
    kind : {"clamped", "pinned", "roller"}
        A clamped end has position and rotation held, a pinned end the position, a roller one component of the position.
    free : {"x", "y"}
        The direction in which a roller is free.
    fixed : tuple of {"x", "y", "rotation"}
        The components held, instead of `kind`.
    displacement : (float, float)
        Prescribed displacement of the end at load parameter 1 [length]; zero in a free direction.
    rotation : float
        Prescribed rotation at load parameter 1, anticlockwise [rad].

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    beam: Name
    end: Annotated[str, rules.choice("start", "end")]
    kind: Annotated[str, rules.choice("clamped", "pinned", "roller")] | None = None
    free: Annotated[str, rules.choice("x", "y")] | None = None
    fixed: Annotated[tuple[str, ...], rules.subset(*COMPONENTS)] | None = None
    displacement: Vector | None = None
    rotation: Number | None = None

    def __post_init__(self) -> None:
        apply_rules(self)
        exactly_one_of(vars(self), (("kind",), ("fixed",)))
        if self.kind == "roller" and self.free is None:
            raise FieldError("free", MISSING, 'must be given, a roller is free in "x" or in "y"')
        if self.kind != "roller" and self.free is not None:
            raise FieldError("free", self.free, 'belongs to kind = "roller"')
        for component, value in zip("xy", self.displacement or (), strict=False):
            if value != 0.0 and component not in self.held:
                raise FieldError(
                    "displacement", self.displacement, f"must be zero in {component}, which is free"
                )
        if self.rotation is not None and "rotation" not in self.held:
            raise FieldError("rotation", self.rotation, "must not be given, the rotation is free")

    @property
    def node(self) -> str:
        """Name of the end, as ``upper.end``."""
        return f"{self.beam}.{self.end}"

    @property
    def held(self) -> tuple[str, ...]:
        """The components held."""
        if self.kind == "clamped":
            return COMPONENTS
        if self.kind == "pinned":
            return ("x", "y")
        if self.kind == "roller":
            return ("y",) if self.free == "x" else ("x",)
        return self.fixed or ()

    @property
    def motion(self) -> tuple[float | None, float | None, float | None]:
        """Displacement x, y and rotation at load parameter 1, None where free."""
        x, y = self.displacement or (0.0, 0.0)
        given = dict(zip(COMPONENTS, (x, y, self.rotation or 0.0), strict=True))
        x_, y_, rotation = (given[name] if name in self.held else None for name in COMPONENTS)
        return x_, y_, rotation

    @property
    def moves(self) -> bool:
        """Whether a prescribed component is not zero."""
        return any(self.motion)


@dataclass(frozen=True, kw_only=True)
class LoadSpec:
    """A dead force and moment on a beam's end, scaled by the load parameter.

    Parameters
    ----------
    beam : str
        Name of the beam.
    end : {"start", "end"}
        Which end.
    force : (float, float)
        At load parameter 1; it keeps its direction [force].
    moment : float
        At load parameter 1, anticlockwise [force length].

    Raises
    ------
    FieldError
        A ``ValueError`` that names field, value and rule.
    """

    beam: Name
    end: Annotated[str, rules.choice("start", "end")]
    force: Vector = (0.0, 0.0)
    moment: Number = 0.0

    def __post_init__(self) -> None:
        apply_rules(self)
        if not any((*self.force, self.moment)):
            raise FieldError("force", self.force, "force or moment must not be zero")

    @property
    def node(self) -> str:
        """Name of the end, as ``upper.end``."""
        return f"{self.beam}.{self.end}"

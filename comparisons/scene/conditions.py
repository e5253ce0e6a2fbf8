"""Supports, loads, hinges and springs of beams."""

from typing import Any

from comparisons.scene import rules
from comparisons.scene.record import Record, key, one_of, optional, refused
from comparisons.scene.rules import FieldError, Mistakes, Point

COMPONENTS = ("x", "y", "rotation")
"""Components of an end's motion, in the order of `SupportSpec.motion`."""
HELD = {"clamped": COMPONENTS, "pinned": ("x", "y")}
END = rules.choice("start", "end")
ROLLS = 'must be given, a roller is free in "x" or in "y"'
APART = "must not be given with force_per_length: it belongs to end or at"


class AtEnd(Record):
    """What is at one end of a beam."""

    beam: str = key(rules.name, "Name of the beam.")
    end: str = key(END, "Which end.")

    @property
    def node(self) -> str:
        """Name of the end, as ``upper.end``."""
        return f"{self.beam}.{self.end}"


class SupportSpec(AtEnd):
    """A support of a beam's end. A held component stays at rest, or moves by a prescribed amount times the load parameter."""

    end: str = key(END, "Which end. Beams that share an end are joined there: one support holds the joint.")
    kind: str | None = optional(
        rules.choice("clamped", "pinned", "roller"),
        "A clamped end has position and rotation held, a pinned end the position, a roller one component of the position.",
    )
    free: str | None = optional(rules.choice("x", "y"), "The direction in which a roller is free.")
    fixed: tuple[str, ...] | None = optional(
        rules.subset(*COMPONENTS, at_least=1), "The components held, instead of `kind`."
    )
    displacement: Point | None = optional(
        rules.point, "Prescribed displacement at load parameter 1 [length]; zero in a free direction."
    )
    rotation: float | None = optional(
        rules.number, "Prescribed rotation at load parameter 1, anticlockwise [rad]."
    )

    obeys = (
        one_of(("kind",), ("fixed",)),
        refused("free", ROLLS, lambda it: it.kind == "roller" and it.free is None),
        refused("free", 'belongs to kind = "roller"', lambda it: it.kind != "roller" and it.free is not None),
        lambda support: moved_where_free(support, support.held),
    )

    @property
    def held(self) -> tuple[str, ...]:
        """The components held."""
        if self.kind == "roller":
            return ("y",) if self.free == "x" else ("x",)
        return HELD[self.kind] if self.kind else self.fixed or ()

    @property
    def motion(self) -> tuple[float | None, float | None, float | None]:
        """Displacement x, y and rotation at load parameter 1, None where free."""
        x, y, rotation = (value if name in self.held else None for name, value in _motion(self).items())
        return x, y, rotation

    @property
    def moves(self) -> bool:
        """Whether a prescribed component is not zero at load parameter 1."""
        return any(self.motion)


def _motion(moved: Any) -> dict[str, float]:
    """Return the components of the displacement and rotation that a record states, zero where it states none."""
    return dict(zip(COMPONENTS, (*(moved.displacement or (0.0, 0.0)), moved.rotation or 0.0), strict=True))


def moved_where_free(moved: Any, held: tuple[str, ...]) -> Mistakes:
    """Yield a mistake for every component of a prescribed displacement and rotation that is not held."""
    for component, value in _motion(moved).items():
        if value and component not in held:
            key = "rotation" if component == "rotation" else "displacement"
            yield FieldError(key, getattr(moved, key), f"must be zero in {component}, which is free")


class LoadSpec(Record):
    """A dead load scaled by the load parameter: a force and moment on a beam's end or inside the beam, or a force per length."""

    beam: str = key(rules.name, "Name of the beam.")
    end: str | None = optional(END, "The end on which `force` and `moment` act.")
    at: float | None = optional(
        rules.fraction,
        "The fraction of the undeformed length at which they act inside the beam, instead of `end`.",
    )
    force: Point = optional(rules.point, "At load parameter 1; it keeps its direction [force].", (0.0, 0.0))
    moment: float = optional(rules.number, "At load parameter 1, anticlockwise [force length].", 0.0)
    force_per_length: Point | None = optional(
        rules.point,
        "Force per undeformed length, instead of `end` and `at`; it keeps its direction [force/length].",
    )
    part: Point | None = optional(
        rules.span, "The fractions of the length between which `force_per_length` acts; else the whole beam."
    )

    obeys = (
        one_of(("end",), ("at",), ("force_per_length",)),
        refused("part", "belongs to force_per_length", lambda it: it.part and not it.force_per_length),
        refused("force", APART, lambda it: it.force_per_length and any(it.force)),
        refused("moment", APART, lambda it: it.force_per_length and it.moment),
        refused(
            "force",
            "force or moment must not be zero",
            lambda it: not (it.force_per_length or any(it.amount)),
        ),
        refused("force_per_length", "must not be zero", lambda it: it.force_per_length == (0.0, 0.0)),
    )

    @property
    def amount(self) -> tuple[float, float, float]:
        """Force x, y and moment, or the force per length and zero."""
        return (*self.force, self.moment) if self.force_per_length is None else (*self.force_per_length, 0.0)

    @property
    def span(self) -> Point:
        """Fractions of the length between which the force per length acts."""
        return self.part or (0.0, 1.0)

    @property
    def key(self) -> str:
        """The key that says where the load acts."""
        return "end" if self.end else "at" if self.at else "force_per_length"

    @property
    def node(self) -> str:
        """Name of the place: ``upper.end``, ``upper at 0.5`` or ``upper from 0 to 1``."""
        if self.end:
            return f"{self.beam}.{self.end}"
        return self.beam + (f" at {self.at!r}" if self.at else " from {!r} to {!r}".format(*self.span))


class HingeSpec(AtEnd):
    """A hinge between a beam's end and its joint: the end turns against the joint without a moment, or against a spring."""

    end: str = key(
        END,
        "Which end. It is joined to another beam, or a support holds its rotation. Supports, springs and loads that name the end act "
        "on the joint, not on the beam behind the hinge.",
    )
    stiffness: float = optional(
        rules.not_negative, "Stiffness of a rotational spring between joint and end [force length/rad].", 0.0
    )


class SpringSpec(AtEnd):
    """Linear springs between a beam's end and the ground, free of force in the undeformed state."""

    end: str = key(END, "Which end; the springs act on the joint of all beams that share it.")
    stiffness: Point = optional(
        rules.stiffnesses, "Stiffnesses against displacement in x and in y [force/length].", (0.0, 0.0)
    )
    rotation: float = optional(rules.not_negative, "Stiffness against rotation [force length/rad].", 0.0)

    obeys = (refused("stiffness", "stiffness or rotation must not be zero", lambda it: not it.held),)

    @property
    def held(self) -> tuple[str, ...]:
        """The components of motion that the springs resist."""
        stiffness = zip(COMPONENTS, (*self.stiffness, self.rotation), strict=True)
        return tuple(name for name, value in stiffness if value)

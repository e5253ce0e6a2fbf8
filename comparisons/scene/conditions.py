"""Supports, loads, hinges and springs of beams."""

from collections.abc import Iterable, Iterator

from comparisons.scene import rules
from comparisons.scene.record import Record, exactly_one_of, key
from comparisons.scene.rules import MISSING, FieldError, Point

COMPONENTS = ("x", "y", "rotation")
"""Components of an end's motion, in the order of `SupportSpec.motion`."""
HELD = {"clamped": COMPONENTS, "pinned": ("x", "y")}
END = rules.choice("start", "end")


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

    end: str = key(
        END, "Which end. Beams that share an end are rigidly joined there: one support holds the joint."
    )
    kind: str | None = key(
        rules.choice("clamped", "pinned", "roller"),
        "A clamped end has position and rotation held, a pinned end the position, a roller one component of the position.",
        default=None,
    )
    free: str | None = key(rules.choice("x", "y"), "The direction in which a roller is free.", default=None)
    fixed: tuple[str, ...] | None = key(
        rules.subset(*COMPONENTS), "The components held, instead of `kind`.", default=None
    )
    displacement: Point | None = key(
        rules.point,
        "Prescribed displacement of the end at load parameter 1 [length]; zero in a free direction.",
        default=None,
    )
    rotation: float | None = key(
        rules.number, "Prescribed rotation at load parameter 1, anticlockwise [rad].", default=None
    )

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rules: one way to state what is held, a direction for a roller, motion only where it is held."""
        return exactly_one_of(self, ("kind",), ("fixed",)), self._direction(), self._moved(), self._turned()

    def _direction(self) -> Iterator[FieldError]:
        if self.kind == "roller" and self.free is None:
            yield FieldError("free", MISSING, 'must be given, a roller is free in "x" or in "y"')
        if self.kind != "roller" and self.free is not None:
            yield FieldError("free", self.free, 'belongs to kind = "roller"')

    def _moved(self) -> Iterator[FieldError]:
        for component, value in zip("xy", self.displacement or (), strict=False):
            if value and component not in self.held:
                rule = f"must be zero in {component}, which is free"
                yield FieldError("displacement", self.displacement, rule)

    def _turned(self) -> Iterator[FieldError]:
        if self.rotation is not None and "rotation" not in self.held:
            yield FieldError("rotation", self.rotation, "must not be given, the rotation is free")

    @property
    def held(self) -> tuple[str, ...]:
        """The components held."""
        if self.kind == "roller":
            return ("y",) if self.free == "x" else ("x",)
        return HELD[self.kind] if self.kind else self.fixed or ()

    @property
    def motion(self) -> tuple[float | None, float | None, float | None]:
        """Displacement x, y and rotation at load parameter 1, None where free."""
        given = zip(COMPONENTS, (*(self.displacement or (0.0, 0.0)), self.rotation or 0.0), strict=True)
        x, y, rotation = (value if name in self.held else None for name, value in given)
        return x, y, rotation

    @property
    def moves(self) -> bool:
        """Whether a prescribed component is not zero at load parameter 1."""
        return any(self.motion)


class LoadSpec(Record):
    """A dead load scaled by the load parameter: a force and moment on a beam's end or inside the beam, or a force per length."""

    beam: str = key(rules.name, "Name of the beam.")
    end: str | None = key(END, "The end on which `force` and `moment` act.", default=None)
    at: float | None = key(
        rules.fraction,
        "The fraction of the undeformed length at which `force` and `moment` act inside the beam, instead of `end`.",
        default=None,
    )
    force: Point = key(
        rules.point, "At load parameter 1; it keeps its direction [force].", default=(0.0, 0.0)
    )
    moment: float = key(rules.number, "At load parameter 1, anticlockwise [force length].", default=0.0)
    force_per_length: Point | None = key(
        rules.point,
        "Force per undeformed length at load parameter 1, instead of `end` and `at`; it keeps its direction [force/length].",
        default=None,
    )
    part: Point | None = key(
        rules.span,
        "The fractions of the undeformed length between which `force_per_length` acts; the whole beam if not given.",
        default=None,
    )

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rules: one way to state where the load acts, what belongs to it, and a load that is not zero."""
        return exactly_one_of(self, ("end",), ("at",), ("force_per_length",)), self._belongs(), self._acts()

    def _belongs(self) -> Iterator[FieldError]:
        if self.force_per_length is None and self.part is not None:
            yield FieldError("part", self.part, "belongs to force_per_length")
        for name in ("force", "moment") if self.force_per_length is not None else ():
            if any(self.force) if name == "force" else self.moment:
                rule = "must not be given with force_per_length: it belongs to end or at"
                yield FieldError(name, getattr(self, name), rule)

    def _acts(self) -> Iterator[FieldError]:
        if self.force_per_length is None:
            if not any((*self.force, self.moment)):
                yield FieldError("force", self.force, "force or moment must not be zero")
        elif not any(self.force_per_length):
            yield FieldError("force_per_length", self.force_per_length, "must not be zero")

    @property
    def amount(self) -> tuple[float, float, float]:
        """Force x, y and moment, or the force per length and zero."""
        if self.force_per_length is not None:
            return (*self.force_per_length, 0.0)
        return (*self.force, self.moment)

    @property
    def span(self) -> Point:
        """Fractions of the length between which the force per length acts."""
        return self.part or (0.0, 1.0)

    @property
    def key(self) -> str:
        """The key that says where the load acts."""
        return "end" if self.end is not None else "at" if self.at is not None else "force_per_length"

    @property
    def node(self) -> str:
        """Name of the place: ``upper.end``, ``upper at 0.5`` or ``upper from 0 to 1``."""
        if self.end is not None:
            return f"{self.beam}.{self.end}"
        if self.at is not None:
            return f"{self.beam} at {self.at!r}"
        return "{} from {!r} to {!r}".format(self.beam, *self.span)


class HingeSpec(AtEnd):
    """A hinge between a beam's end and its joint: the end turns against the joint without a moment, or against a spring."""

    end: str = key(
        END,
        "Which end. It is joined to another beam, or a support holds its rotation. Supports, springs and loads that name the end act "
        "on the joint, not on the beam behind the hinge.",
    )
    stiffness: float = key(
        rules.not_negative,
        "Stiffness of a rotational spring between the joint and the end [force length/rad].",
        default=0.0,
    )


class SpringSpec(AtEnd):
    """Linear springs between a beam's end and the ground, free of force in the undeformed state."""

    end: str = key(END, "Which end; the springs act on the joint of all beams that share it.")
    stiffness: Point = key(
        rules.stiffnesses,
        "Stiffnesses against displacement in x and in y [force/length].",
        default=(0.0, 0.0),
    )
    rotation: float = key(rules.not_negative, "Stiffness against rotation [force length/rad].", default=0.0)

    def own_rules(self) -> Iterable[Iterator[FieldError]]:
        """Return the rule: some stiffness is not zero."""
        return (self._resists(),)

    def _resists(self) -> Iterator[FieldError]:
        if not self.held:
            yield FieldError("stiffness", self.stiffness, "stiffness or rotation must not be zero")

    @property
    def held(self) -> tuple[str, ...]:
        """The components of motion that the springs resist."""
        stiffness = zip(COMPONENTS, (*self.stiffness, self.rotation), strict=True)
        return tuple(name for name, value in stiffness if value)

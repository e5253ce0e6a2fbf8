"""Beams by the tangent stiffness method."""

from collections.abc import Callable
from functools import cache
from itertools import accumulate
from math import hypot, nan, sqrt
from typing import Any

import numpy as np

import tsm
from comparisons.answer import (
    ContactEvent,
    ContactHistory,
    Deformation,
    FrictionHistory,
    Grid,
    Response,
    Sections,
)
from comparisons.models import theory
from comparisons.models.model import Model, ModelError, Options, Reached, Style, Watch
from comparisons.models.shared import kept, line_loads, of_result, rows, ways
from comparisons.scene import BeamSpec, ContactSpec, Scene
from comparisons.scene.keys import SPECIAL
from tsm.elements import ELEMENTS, ClosedForm, ElementType

EXACT, MIXED, PAPER = "exact", "mixed", "timoshenko"
"""The elements of `tsm` that a comparison runs: without a mesh error, recommended, and the paper's."""


class Tsm(Model):
    """Beams by the tangent stiffness method, with any type of element that `tsm.ELEMENTS` or another package has."""

    name = "tsm"
    label = "TSM"
    options = ("elements", "element", "integration_tolerance", "branch")
    libraries = ("tsm",)
    refinable = True
    keys = SPECIAL.keys()
    reference = Options(element=EXACT)

    def element(self, options: Options) -> ElementType:
        """Return the type of the elements, `mixed` if none is chosen; raise `ModelError` if there is no such type."""
        name = options.element or MIXED
        if name not in ELEMENTS:
            from comparisons.models.outside.programs import loaded, offered

            others = offered("crossval.elements")
            if name not in others:
                raise ModelError(f"element = {name}: must be one of {', '.join({**ELEMENTS, **others})}")
            ELEMENTS[name] = loaded(others[name], ElementType)
        return ELEMENTS[name]

    def rule(self, scene: Scene, options: Options) -> str:
        """Return the element that suits and why: `exact`, unless the options or the scene give a number of elements."""
        if options.element is not None:
            return ""
        if options.integration_tolerance is not None:
            return f"{EXACT}, since a tolerance of the integration is given"
        if options.elements or any(beam.elements or beam.nodes for beam in scene.beams):
            return f"{MIXED}, since a number of elements is given"
        return f"{EXACT}, since no number of elements is given: one a beam, without a mesh error"

    def kind(self, scene: Scene, options: Options) -> ElementType:
        """Return the type of the elements, by `rule` where the options name none."""
        suited = options.element or self.rule(scene, options).partition(",")[0]
        return self.element(Options(element=suited))

    def refusal(self, scene: Scene) -> str | None:
        """Return why no element of the tangent stiffness method states `scene`; None if one does."""
        refused = (item.pair for item in scene.contacts if item.friction and _face_slope(scene, item))
        words = (
            "the tangent stiffness method does not state friction on the face of a beam whose height tapers"
        )
        use = 'use --model solid, surface = "axis" or one height'
        return next((f"contact {pair}: {words}; {use}" for pair in refused), None)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked; a tolerance is for elements that integrate."""
        kind, tolerance = self.kind(scene, options), options.integration_tolerance
        structure = to_structure(scene, elements=options.elements, element=kind.name)
        if tolerance is not None and kind.meshed:
            integrated = ", ".join(name for name, other in tsm.ELEMENTS.items() if not other.meshed)
            raise ModelError(f"integration_tolerance = {tolerance:g}: belongs to element = {integrated}")
        own = {} if tolerance is None else {"integration_tolerance": tolerance}
        settings, report = tsm.Settings(branch=options.branch or "stop", **own), _reporter(structure, watch)
        result = tsm.solve(structure, np.array(scene.times), settings, throw=False, watch=report)

        def sections(beam: str, k: int) -> Sections:
            stations = result.stations(beam, k)
            N, V, M = stations.forces.reshape(-1, 3).T
            return Sections(arc=stations.arc.ravel(), N=N, V=V, M=M)

        events = tuple(
            ContactEvent(**vars(event) | {"kind": event.kind.value, "element": int(event.element)})
            for event in result.events
        )
        slipped = {one.pair: one.load_parameter for one in reversed(events) if one.kind == "slip-off"}
        contacts = {
            pair: ContactHistory(
                **kept(item, "force arc_position gap"),
                slip_off=slipped.get(pair, nan),
                vector=rows([state.system.forces.get(number, (0.0, 0.0)) for state in result.equilibria], 2),
                friction=None if item.friction is None else FrictionHistory(**vars(item.friction)),
            )
            for number, (pair, item) in enumerate(result.contacts.items())
        }
        return of_result(
            scene,
            result,
            cache(result.axis_line),
            lambda beam, k: result.shape(beam, k)[:, :2],
            grid=lambda beam, k: _grid(scene, result, beam, k),
            contacts=contacts,
            events=events,
            integration_error=result.integration_error,
            work=result.work if result.model.rubbed else None,
            deformation=None if result.deformation is None else Deformation(**vars(result.deformation)),
            sections=sections,
        )

    def styles(self) -> dict[str, Style]:
        """Return one style for every type of element."""
        styles = {kind.name: Style(colour=kind.colour, marker=kind.marker) for kind in ELEMENTS.values()}
        return {f"{self.label} {name}": style for name, style in styles.items()}

    def run_label(self, options: Options) -> str:
        """Return the label of one run, as ``TSM mixed, 20 elements``."""
        own = f"{self.label} {self.element(options).name}"
        return super().run_label(options).replace(self.label, own, 1)

    def setting(self, scene: Scene, options: Options) -> str:
        """Return element type, numbers of elements and tolerance, as ``mixed 20``."""
        kind, tolerance = self.kind(scene, options), options.integration_tolerance
        counts = {options.elements or (beam.divisions if kind.meshed else 1) for beam in scene.beams}
        words = [kind.name, "+".join(map(str, sorted(counts)))]
        return " ".join([*words, f"tolerance {tolerance:g}"] if tolerance is not None else words)

    def family(self, scene: Scene, options: Options) -> str:
        """Return the type of the elements, as ``TSM mixed``."""
        return f"{self.label} {self.kind(scene, options).name}"

    def compared(self) -> tuple[Options, ...]:
        """Return the paper's element, the recommended one, and the exact one."""
        return _counted({PAPER: (10, 20, 50), MIXED: (10, 20), EXACT: (1,)})

    def resolutions(self, *, quick: bool) -> tuple[Options, ...]:
        """Return numbers of exact elements, of `mixed`, and of the paper's element."""
        if quick:
            return _counted({EXACT: (1,), MIXED: (2, 3, 5, 10, 20, 40), PAPER: (10, 20, 50)})
        return _counted(
            {EXACT: (1, 2, 4), MIXED: (2, 3, 5, 10, 20, 40, 80, 160), PAPER: (5, 10, 20, 50, 100)}
        )

    def error_parts(self, scene: Scene, options: Options, bent: theory.Bending) -> dict[str, float]:
        """Return the allowed error from the element's order, contact and shear."""
        kind, beam = self.kind(scene, options), scene.beams[0]
        if not isinstance(kind, ClosedForm):
            return {"accuracy of the integration": theory.EXACT}
        longest, shortest = theory.element_lengths(beam, options.elements)
        turn = min(bent.curvature * longest, bent.turn)
        force = bent.force * beam.EI / beam.length**2
        slip, stretch = force / beam.GA, force / beam.EA
        last_bit = 4 * np.finfo(float).eps
        term = float(theory.chord_term(turn, kind.order))
        order, newton = f"{theory.ordinal(kind.order)} order of the element", "tolerance of Newton's method"
        if not kind.contact_unknowns:
            return {
                order: theory.MESH * term,
                "force normal to the chord, not to the mean tangent of the kink F/GA": slip * kind.sheared,
                "stretch left out of the lever arms": stretch,
                newton: theory.FLOOR,
                "round-off of positions, felt by EI/l^3": last_bit / shortest**3 / max(bent.force, 1.0),
            }
        inside = min(longest / bent.nearest, 1.0)
        return {
            order: theory.CURVED * term,
            "third power of the shear strain": slip**3,
            "jump of the shear strain within the element": inside * slip**2 / 2,
            newton: theory.FLOOR,
            "round-off of positions, a kink of eps/l": theory.CHANGE * last_bit / shortest,
        }


def _counted(counts: dict[str, tuple[int, ...]]) -> tuple[Options, ...]:
    return tuple(Options(element=name, elements=n) for name in counts for n in counts[name])


def _reporter(structure: tsm.Structure, watch: Watch) -> Callable[[Any], None]:
    """Return a function that passes accepted steps on to `watch`; elements are counted from 1."""
    counts = {beam.name: beam.elements for beam in structure.beams}
    first = dict(zip(counts, accumulate(counts.values(), initial=0), strict=False))

    def report(step: Any) -> None:
        state = step.equilibrium.state
        touching = tuple(
            f"{pair.name} on element {touch.element - first[pair.beam] + 1} of {counts[pair.beam]}"
            for pair, touch in zip(structure.contacts, state.touches, strict=True)
            if touch is not None
        )
        watch(Reached(state.load_parameter, step.iterations, touching))

    return report


def _grid(scene: Scene, result: Any, beam: str, k: int) -> Grid:
    """Return the elements of a beam as lines, which share no points, because section forces jump at a contact.

    The field `arc` is the distance along the undeformed axis. Axial stresses are given at
    the right and the left face, seen along the beam. `height` is 0 where the section has no height.
    """
    spec, stations = scene.beam(beam), result.stations(beam, k)
    arc, deformed = stations.arc.ravel(), stations.position.reshape(-1, 2)
    places = [(spec.place(part), spec.section(part), spec.height_at(part)) for part in arc / spec.length]
    points, section, height = (np.array(column) for column in zip(*places, strict=True))
    (area, inertia, _), (N, V, M) = section.T, stations.forces.reshape(-1, 3).T
    bending = M * height / (2.0 * inertia)
    data = {
        "displacement": deformed - points, "deformed": deformed,
        "rotation": stations.rotation.ravel(), "N": N, "V": V, "M": M, "arc": arc, "height": height,
        "axial_stress_right": N / area + bending, "axial_stress_left": N / area - bending,
    }  # fmt: skip
    return Grid(points=points, cells={"line": np.arange(len(arc)).reshape(-1, 2)}, point_data=data)


def to_structure(scene: Scene, *, elements: int | None = None, element: str | None = None) -> tsm.Structure:
    """Return the `tsm.Structure` of `scene`: sections on the axis, rigid joints, dead loads.

    Parameters
    ----------
    scene : Scene
        Any scene; a `ModelError` says which of its keys the beams do not state.
    elements : int, optional
        Elements of every beam. By default the scene's number, or one exact element.
    element : str, optional
        Key of `tsm.ELEMENTS`, `mixed` if not given.
    """
    if (refused := TSM.refusal(scene)) is not None:
        raise ModelError(refused)
    kind = TSM.element(Options(element=element))
    return tsm.Structure(
        beams=tuple(_beam(scene, beam, elements, kind) for beam in scene.beams),
        supports=tuple(
            tsm.Support(ux=ux, uy=uy, rotation=turn, onward=later[1:], **kept(own, "beam end"))
            for own, later in scene.prescribed_motions.values()
            for ux, uy, turn in [own.motion]
        ),
        loads=tuple(
            tsm.Load(
                stage=stage,
                arc=None if load.at is None else load.at * scene.beam(load.beam).length,
                **kept(load, "beam end force moment"),
            )
            for stage, load in scene.numbered_loads()
            if load.force_per_length is None
        ),
        line_loads=tuple(
            tsm.LineLoad(
                beam=beam.name, force=force, start=start * beam.length, end=end * beam.length, stage=stage
            )
            for beam, stage, force, (start, end) in line_loads(scene)
        ),
        hinges=tuple(tsm.Hinge(**kept(item, "beam end stiffness")) for item in scene.hinges),
        springs=tuple(
            tsm.Spring(x=item.stiffness[0], y=item.stiffness[1], **kept(item, "beam end rotation"))
            for item in scene.springs
        ),
        pins=tuple(tsm.Pin(name=pin.name, **ways(pin)) for pin in scene.pins),
        contacts=tuple(_pair(scene, contact) for contact in scene.contacts),
    )


def _face_slope(scene: Scene, contact: ContactSpec) -> float:
    """Derivative of the radius of the circles whose envelope is the face, ``h'/2 / sqrt(1 + (h'/2)^2)``."""
    rise = scene.offset(contact, 1.0) - scene.offset(contact, 0.0)
    return rise / hypot(scene.beam(contact.beam).length, rise)


def _pair(scene: Scene, contact: ContactSpec) -> tsm.ContactPair:
    """Contact pair. The face of a beam whose height tapers lies at half the height from the undeformed axis, see `_face_slope`."""
    slope, radius = _face_slope(scene, contact), scene.radius(contact)
    inner = 1.0 - sqrt(1.0 - slope**2)
    start, end = (
        offset - inner * (offset - radius) for part in (0.0, 1.0) for offset in [scene.offset(contact, part)]
    )
    own = kept(contact, "node beam side keep friction")
    return tsm.ContactPair(offset=start, end_offset=end if slope else None, radius=radius, **own)


def _beam(scene: Scene, spec: BeamSpec, elements: int | None, kind: ElementType) -> tsm.Beam:
    """Beam with nodes where loads inside it begin, end or act."""

    def section(fraction: float) -> tsm.Section:
        EA, GA, EI = spec.stiffness(fraction)
        return tsm.Section(EA=EA, GA=GA, EI=EI)

    nodes = spec.nodes if kind.meshed and not elements else ()
    count = elements or (spec.divisions if kind.meshed else 1)
    own = [load for _, load in scene.numbered_loads() if load.beam == spec.name]
    places = [part for load in own for part in (load.span if load.at is None else (load.at,))]
    return tsm.Beam(
        **kept(spec, "name start end turn"),
        section=section(0.0),
        end_section=section(1.0) if spec.tapers else None,
        elements=count,
        element=kind.name,
        nodes=nodes,
    ).divided(*(part * spec.length for part in places))


TSM = Tsm()
MODELS = (TSM,)

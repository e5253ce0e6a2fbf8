"""Responses of the two discrete models: TSM beams and the solid."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.base import Model
from comparisons.models.j_integral import j_integrals
from comparisons.models.options import ModelError, Options
from comparisons.models.progress import Reached, Watch, unwatched
from comparisons.models.solid import SOLID
from comparisons.models.translate import to_solid, to_structure
from comparisons.models.tsm import TSM
from comparisons.response import (
    Array,
    ContactEvent,
    ContactHistory,
    CriticalPoint,
    Deformation,
    FrictionHistory,
    Grid,
    Response,
    Sections,
    SupportHistory,
)
from comparisons.response.deferred import Deferred
from comparisons.scene import Scene

if TYPE_CHECKING:
    from tsm.elements import ElementType


def solve_tsm(scene: Scene, options: Options, kind: "ElementType", watch: Watch = unwatched) -> Response:
    """Solve `scene` by the tangent stiffness method.

    Raises
    ------
    ModelError
        If a tolerance is given for closed-form elements, which do not integrate.
    """
    import tsm

    structure = to_structure(scene, elements=options.elements, element=kind.name)
    settings = tsm.Settings(branch=options.branch or "stop")
    if options.integration_tolerance is not None:
        if kind.meshed:
            integrated = ", ".join(name for name, other in tsm.ELEMENTS.items() if not other.meshed)
            raise ModelError(
                f"integration_tolerance = {options.integration_tolerance:g}: belongs to element = {integrated}"
            )
        settings = replace(settings, integration_tolerance=options.integration_tolerance)
    try:
        result = tsm.solve(structure, np.array(scene.times), settings, watch=_reporter(structure, watch))
    except tsm.SolveError as error:
        result = error.result

    def grid(k: int) -> Grid:
        return _beam_grid(scene, result, k)

    def sections(beam: str, k: int) -> Sections:
        stations = result.stations(beam, k)
        N, V, M = stations.forces.reshape(-1, 3).T
        return Sections(arc=stations.arc.ravel(), N=N, V=V, M=M)

    response = _response(TSM, scene, result, cache(result.axis_line), grid)
    return replace(
        response,
        tips=_tips(scene, response, lambda beam, k: result.shape(beam, k)[:, :2]),
        springs={
            end: SupportHistory(force=item.force, moment=item.moment) for end, item in result.springs.items()
        },
        contacts=_beam_contacts(response, result),
        events=tuple(_event(event) for event in result.events),
        integration_error=result.integration_error,
        work=result.work if result.model.rubbed else None,
        deformation=None if result.deformation is None else Deformation(**vars(result.deformation)),
        sections=sections,
    )


def _reporter(structure: Any, watch: Watch) -> Callable[[Any], None]:
    """Return a function that passes accepted steps on to `watch`; elements are counted from 1."""
    first, count = {}, 0
    for beam in structure.beams:
        first[beam.name], count = count, count + beam.elements
    elements = {beam.name: beam.elements for beam in structure.beams}

    def report(step: Any) -> None:
        state = step.equilibrium.state
        touching = tuple(
            f"{pair.name} on element {touch.element - first[pair.beam] + 1} of {elements[pair.beam]}"
            for pair, touch in zip(structure.contacts, state.touches, strict=True)
            if touch is not None
        )
        watch(Reached(state.load_parameter, step.iterations, touching))

    return report


def _event(event: Any) -> ContactEvent:
    return ContactEvent(
        kind=event.kind.value,
        load_parameter=event.load_parameter,
        pair=event.pair,
        element=int(event.element),
        arc_position=event.arc_position,
        force=event.force,
        released=event.released,
        stage=event.stage,
    )


def _beam_contacts(response: Response, result: Any) -> dict[str, ContactHistory]:
    """Add the force vectors, the first slip-off of each pair, and its friction."""
    slipped = {
        event.pair: event.load_parameter for event in reversed(result.events) if event.kind.name == "SLIP_OFF"
    }
    return {
        pair: replace(
            history,
            slip_off=slipped.get(pair, np.nan),
            vector=_rows([state.system.forces.get(number, (0.0, 0.0)) for state in result.equilibria], 2),
            friction=_friction(result.contacts[pair].friction),
        )
        for number, (pair, history) in enumerate(response.contacts.items())
    }


def _friction(history: Any) -> FrictionHistory | None:
    return None if history is None else FrictionHistory(**vars(history))


def _solid_friction(history: Any) -> FrictionHistory:
    return FrictionHistory(
        tangential=history.tangential_force,
        normal=history.normal_force,
        slip=history.direction,
        dissipated=history.dissipated,
    )


def _rows(rows: list[Any], width: int) -> Array:
    return np.array(rows, dtype=np.float64).reshape(-1, width)


def solve_solid(scene: Scene, options: Options, watch: Watch = unwatched) -> Response:
    """Solve `scene` with solid elements in contact."""
    import fem_reference

    problem = to_solid(scene, mesh=options.mesh)
    settings = fem_reference.Settings(branch=options.branch or "stop")

    def report(step: Any) -> None:
        touching = tuple(
            f"{touch.pair.name} at {float(touch.projection.zeta):.4g}" for touch in step.state.closed
        )
        watch(Reached(step.load_parameter, step.iterations, touching))

    try:
        result = fem_reference.solve(problem, np.array(scene.times), settings, watch=report)
    except fem_reference.SolveError as error:
        result = error.result

    def axis_line(beam: str, k: int) -> tuple[Array, Array]:
        return fem_reference.axis_stations(result, beam), fem_reference.axis_line(result, beam, k)

    beam = np.repeat(np.arange(len(scene.beams)), [part.stop - part.start for part in result.model.parts])

    def grid(k: int) -> Grid:
        displacement = result.displacement[k]
        xx, yy, xy = fem_reference.nodal_stress(result, k).T
        data = {
            "displacement": displacement,
            "deformed": result.mesh_points + displacement,
            "beam": beam,
            "stress_xx": xx,
            "stress_yy": yy,
            "stress_xy": xy,
            "von_mises": np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2),
            "axial_stress": fem_reference.fibre_stress(result, k),
        }
        return Grid(points=result.mesh_points, cells=result.mesh_cells, point_data=data)

    def sections(beam: str, k: int) -> Sections:
        found = fem_reference.section_forces(result, beam, k)
        inner = Sections(arc=found.stations, N=found.N, V=found.V, M=found.M)
        return _with_clamps(scene, result, beam, k, inner)

    response = _response(SOLID, scene, result, axis_line, grid)
    contacts = {
        contact.name: replace(
            response.contacts[contact.name],
            compliance=1.0 / problem.penalty(contact) if contact.penetration is None else 0.0,
            slip_off=result.contacts[contact.name].slip_off,
            vector=result.contacts[contact.name].vector,
            friction=_solid_friction(result.contacts[contact.name]) if contact.friction else None,
        )
        for contact in problem.contacts
    }
    turn = 2 * np.max([_half_turns(response, beam.name) for beam in scene.beams], axis=0)
    deformation = Deformation(
        load_parameter=result.load_parameter, turn=turn, strain=np.zeros_like(turn), bearable=1.0
    )
    return replace(
        response,
        contacts=contacts,
        tips=_tips(scene, response, lambda beam, k: axis_line(beam, k)[1]),
        springs={
            end: SupportHistory(force=item.force, moment=item.moment) for end, item in result.springs.items()
        },
        material_force=Deferred(lambda: j_integrals(scene, result)),
        round_off=result.round_off,
        events=_solid_events(result) if any(contact.friction for contact in problem.contacts) else None,
        deformation=deformation,
        sections=sections,
    )


def _with_clamps(scene: Scene, result: Any, beam: str, k: int, at: Sections) -> Sections:
    """Add the sections of clamped ends that nothing else is joined to or acts on, where the reaction is the section force."""
    taken = [load.load.node for load in scene.load_histories] + [spring.node for spring in scene.springs]
    table, own = np.stack([at.arc, at.N, at.V, at.M]), scene.beam(beam)
    for support in scene.supports_of(beam):
        place, turn = (
            scene.place(support.node),
            scene.prescribed_motions[support.node].at(float(result.load_parameter[k]))[2],
        )
        joined = sum(place in (other.start, other.end) for other in scene.beams) > 1
        if turn is None or joined or support.node in taken:
            continue
        first, held = support.end == "start", result.supports[support.node]
        tx, ty = own.tangent(0.0 if first else 1.0)
        c, s, sign = (
            tx * np.cos(turn) - ty * np.sin(turn),
            ty * np.cos(turn) + tx * np.sin(turn),
            1 - 2 * first,
        )
        x, y, moment = sign * held.force[k, 0], sign * held.force[k, 1], sign * held.moment[k]
        column = [0.0 if first else own.length, c * x + s * y, c * y - s * x, moment]
        table = np.insert(table, 0 if first else table.shape[1], column, axis=1)
    return Sections(arc=table[0], N=table[1], V=table[2], M=table[3])


def _solid_events(result: Any) -> tuple[ContactEvent, ...]:
    """Return the events of a scene with friction, whose load parameters are located; no element owns a contact."""
    found = (
        ContactEvent(
            kind=event.kind,
            load_parameter=event.load_parameter,
            pair=pair,
            element=-1,
            arc_position=event.arc_position,
            force=event.force,
            released=0.0,
            stage=max(1, math.ceil(event.load_parameter)),
        )
        for pair, contact in result.contacts.items()
        for event in contact.events
    )
    return tuple(sorted(found, key=lambda event: event.load_parameter))


def _half_turns(response: Response, beam: str) -> Array:
    """Largest angle (s,) between neighbouring chords of the axis; a quadratic element has two chords."""
    lines = [response.axis_line(beam, k)[1] for k in range(len(response.load_parameter))]
    chords = [np.diff(line, axis=0) @ (1, 1j) for line in lines]
    return np.array([np.abs(np.angle(chord[1:] / chord[:-1])).max() for chord in chords])


def _response(
    model: Model,
    scene: Scene,
    result: Any,
    axis_line: Callable[[str, int], tuple[Array, Array]],
    grid: Callable[[int], Grid],
) -> Response:
    """Return the response with the fields that the results of both solvers share; it has no tips."""
    contacts = {
        pair: ContactHistory(
            force=history.force,
            arc_position=history.arc_position,
            gap=history.gap,
        )
        for pair, history in result.contacts.items()
    }
    return Response(
        model=model.name,
        continuum=model.continuum,
        scene=scene.name,
        status=result.status.name,
        message=result.message,
        completed=result.status.name == "COMPLETED",
        load_parameter=result.load_parameter,
        contacts=contacts,
        supports={
            node: SupportHistory(force=one.force, moment=one.moment)
            for node, one in ((item.node, result.supports[item.node]) for item in scene.all_supports)
        },
        tips={},
        newton_iterations=result.newton_iterations,
        cutbacks=result.cutbacks,
        unknowns=result.unknowns,
        wall_seconds=result.wall_seconds,
        axis_line=axis_line,
        grid=grid,
        index=result.index,
        critical=tuple(
            CriticalPoint(kind=str(point.kind), load_parameter=point.load_parameter, mode=point.mode)
            for point in result.critical
        ),
    )


def _beam_grid(scene: Scene, result: Any, k: int) -> Grid:
    """Return the TSM elements as lines. Elements do not share points, because section forces jump at a contact.

    The field `arc` is the distance along the undeformed axis. Axial stresses are given at
    the right and the left face, seen along the beam. `height` is 0 where the section has no height.
    """
    parts = [_one_beam(scene, number, result, k) for number in range(len(scene.beams))]
    data = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    points = data.pop("reference")
    return Grid(points=points, cells={"line": np.arange(len(points)).reshape(-1, 2)}, point_data=data)


def _one_beam(scene: Scene, number: int, result: Any, k: int) -> dict[str, Array]:
    beam = scene.beams[number]
    stations = result.stations(beam.name, k)
    arc, deformed = stations.arc.ravel(), stations.position.reshape(-1, 2)
    fraction = arc / beam.length
    reference = np.array([beam.place(part) for part in fraction])
    N, V, M = stations.forces.reshape(-1, 3).T
    area, inertia, _ = np.array([beam.section(part) for part in fraction]).T
    height = np.array([beam.height_at(part) for part in fraction])
    return {
        "reference": reference,
        "displacement": deformed - reference,
        "deformed": deformed,
        "rotation": stations.rotation.ravel(),
        "N": N,
        "V": V,
        "M": M,
        "beam": np.full(len(arc), number),
        "arc": arc,
        "height": height,
        "axial_stress_right": N / area + M * height / (2.0 * inertia),
        "axial_stress_left": N / area - M * height / (2.0 * inertia),
    }


def _tips(scene: Scene, response: Response, line: Callable[[str, int], Array]) -> dict[str, Array]:
    """Deformed positions (s, 2) of the tips, the ends of beams with fewer held components, from the points of every axis."""
    steps = range(len(response.load_parameter))
    tips = {beam.name: 0 if scene.tip(beam.name) == "start" else -1 for beam in scene.beams}
    return {beam: _rows([line(beam, k)[end] for k in steps], 2) for beam, end in tips.items()}

"""The two-dimensional solid."""

from collections.abc import Iterator
from functools import lru_cache
from math import ceil, nan
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.answer import (
    Array,
    ContactEvent,
    ContactHistory,
    Deformation,
    FrictionHistory,
    Grid,
    Response,
    Sections,
)
from comparisons.answer.material import AWAY, Deferred, clamped
from comparisons.models import theory
from comparisons.models.model import Model, ModelError, Options, Reached, Style, Watch, refused
from comparisons.models.shared import joints, kept, line_loads, occupied, of_result, ways
from comparisons.scene import BeamSpec, LoadSpec, Scene, SupportSpec
from comparisons.scene.conditions import COMPONENTS
from comparisons.scene.keys import SPECIAL

if TYPE_CHECKING:
    from fem_reference import SolidProblem, Strip

REFINED = ((25, 1), (50, 2), (100, 4), (200, 8))
"""Meshes refined alike in both directions, to which an order of convergence can be fitted."""
COARSE = ((8, 1), (12, 1), (16, 1), (25, 2))
LEAST_RATIO = -0.999
"""Least Poisson's ratio. There the shear modulus is 500 times Young's modulus; a solid that is stiffer in shear locks."""
DEFAULT_PENALTY = 25.0
"""Default penalty stiffness of the solid, over E b."""
SLENDER = 0.125
"""Largest height over length of the rectangle that replaces a section given by area and second moment."""
SHARE = 0.25
"""Largest part of the distance between clamp and contact that is left out at either end."""


class Solid(Model):
    """Beams as two-dimensional solid elements in contact."""

    name = "solid"
    label = "solid"
    options = ("mesh", "branch")
    libraries = ("fem_reference", "skfem")
    refinable = True
    continuum = True
    keys = SPECIAL.keys()

    def refusal(self, scene: Scene) -> str | None:
        """Return why the solid cannot state `scene`; None if it can."""
        return refused(to_solid, scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        import fem_reference

        def report(step: Any) -> None:
            touching = (f"{touch.pair.contact.name} at {touch.at.zeta:.4g}" for touch in step.state.closed)
            watch(Reached(step.load_parameter, step.iterations, tuple(touching)))

        problem = to_solid(scene, mesh=options.mesh)
        settings = fem_reference.Settings(branch=options.branch or "stop")
        result = fem_reference.solve(problem, np.array(scene.times), settings, throw=False, watch=report)

        def axis_line(beam: str, k: int) -> tuple[Array, Array]:
            return fem_reference.axis_stations(result, beam), fem_reference.axis_line(result, beam, k)

        @lru_cache(maxsize=1)  # one load parameter, of which every beam is asked for
        def stresses(k: int) -> Array:
            return np.column_stack(
                [fem_reference.nodal_stress(result, k), fem_reference.fibre_stress(result, k)]
            )

        def grid(beam: str, k: int) -> Grid:
            own = result.model.body(beam).part
            points, displacement = result.mesh_points[own], result.displacement[k][own]
            xx, yy, xy, along = stresses(k)[own].T
            data = {
                "displacement": displacement, "deformed": points + displacement,
                "stress_xx": xx, "stress_yy": yy, "stress_xy": xy, "von_mises": np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2),
                "axial_stress": along,
            }  # fmt: skip
            nodes = np.arange(own.start, own.stop)
            cells = {
                kind: table[np.isin(table[:, 0], nodes)] - own.start
                for kind, table in result.mesh_cells.items()
            }
            return Grid(points=points, cells=cells, point_data=data)

        def half_turns(beam: str) -> Array:
            """Largest angle between neighbouring chords of the axis; a quadratic element has two chords."""
            lines = [axis_line(beam, k)[1] for k in range(len(result.load_parameter))]
            chords = [np.diff(line, axis=0) @ (1, 1j) for line in lines]
            return np.array([np.abs(np.angle(chord[1:] / chord[:-1])).max() for chord in chords])

        contacts = {}
        for spec in problem.contacts:
            item, friction = result.contacts[spec.name], None
            if spec.friction:
                forces = {"tangential": item.tangential_force, "normal": item.normal_force}
                friction = FrictionHistory(slip=item.direction, dissipated=item.dissipated, **forces)
            own = kept(item, "force arc_position gap slip_off vector")
            contacts[spec.name] = ContactHistory(**own, friction=friction)
        turn = 2 * np.max([half_turns(beam.name) for beam in scene.beams], axis=0)
        return of_result(
            scene,
            result,
            axis_line,
            lambda beam, k: axis_line(beam, k)[1],
            grid=grid,
            contacts=contacts,
            material_force=Deferred(lambda: j_integrals(scene, result)),
            round_off=result.round_off,
            events=_events(result) if any(spec.friction for spec in problem.contacts) else None,
            deformation=Deformation(
                load_parameter=result.load_parameter, turn=turn, strain=np.zeros_like(turn), bearable=1.0
            ),
            sections=lambda beam, k: section_forces(scene, result, beam, k),
        )

    def styles(self) -> dict[str, Style]:
        """Return one style for every order of the elements."""
        markers = {"": "h", " Q2": "h", " Q2-full": "P", " Q1": "X"}
        return {
            f"{self.label}{order}": Style(colour="#56B4E9", marker=marker, width=6.0, unbroken=True)
            for order, marker in markers.items()
        }

    def setting(self, scene: Scene, options: Options) -> str:
        """Return element order, mesh and contact, as ``Q2 50x2``."""
        meshes = {options.mesh or beam.solid_mesh_file or beam.mesh for beam in scene.beams}
        names = sorted(mesh if isinstance(mesh, str) else f"{mesh[0]}x{mesh[1]}" for mesh in meshes)
        given = "".join(
            f" {name} {value:g}"
            for name in ("penalty", "penetration")
            for value in sorted({getattr(item, name) for item in scene.contacts} - {None})
        )
        return f"{_order(scene)} {'+'.join(names)}{given}"

    def family(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - the scene has the order
        """Return the order of the elements, as ``solid Q2``."""
        return f"{self.label} {_order(scene)}"

    def resolutions(self, *, quick: bool) -> Iterator[Options]:
        """Yield meshes, coarse to fine."""
        yield from (Options(mesh=mesh) for mesh in (*COARSE, *REFINED[: 2 if quick else 3]))

    def error_parts(self, scene: Scene, options: Options, bent: theory.Bending) -> dict[str, float]:
        """Return the parts of the difference between a strip and the rod."""
        beam = scene.beams[0]
        length = 1 / (options.mesh or beam.mesh)[0]
        turn = min(bent.curvature * length, bent.turn)
        width, height = rectangle(beam)
        slender = height / beam.length
        strain = slender * bent.curvature / 2
        contraction = theory.CHANGE * (abs(beam.poissons_ratio or 0.0) * strain * slender / 4)
        kink = bent.force * (length / 2) ** 2 / 12
        penalty = DEFAULT_PENALTY * beam.youngs_modulus * width
        return {
            "a bent strip, softer by 4/5 of the square of its strain": strain**2,
            "shear and dent of a strip of this height": 2 * slender**2,
            "clamp at the middle of a section that contracts, nu kappa h^2/8 beside the fibre that keeps its length": contraction,
            "square of the slope's error in a biquadratic element": theory.MESH * (turn**2 / 12) ** 2,
            "kink of the curvature at the contact, F/EI, rounded by the axis's spline": kink,
            "default penalty": theory.MESH * bent.force * beam.EI / beam.length**3 / penalty,
            "tolerance of Newton's method": theory.FLOOR,
        }


def _order(scene: Scene) -> str:
    return "+".join(sorted({beam.solid_element for beam in scene.beams}))


def _events(result: Any) -> tuple[ContactEvent, ...]:
    """Return the events of a scene with friction, whose load parameters are located; no element owns a contact."""
    found = [
        ContactEvent(pair=pair, element=-1, released=0.0, stage=max(1, ceil(event.load_parameter)), **own)
        for pair, contact in result.contacts.items()
        for event in contact.events
        for own in [kept(event, "kind load_parameter arc_position force")]
    ]
    return tuple(sorted(found, key=lambda event: event.load_parameter))


def to_solid(scene: Scene, *, mesh: tuple[int, int] | None = None) -> "SolidProblem":
    """Return the `fem_reference.SolidProblem` of `scene`: plane stress, thickness equal to the width, unilateral contact.

    Parameters
    ----------
    scene : Scene
        Any scene whose supports, with the pins that touch at the start, hold every structure; a `ValueError` says in one line why the
        solid cannot state another.
    mesh : (int, int), optional
        Elements along and across of every beam, in place of the scene's.
    """
    import fem_reference as fem

    joints = _Joints(scene)
    clamps = {spec.node for spec in scene.all_supports if _is_clamp(scene, spec)}
    return fem.SolidProblem(
        strips=tuple(_strip(beam, clamps, mesh) for beam in scene.beams),
        supports=tuple(
            fem.Support(strip=spec.beam, end=spec.end, motion=(x, y, turned), onward=later[1:])
            for spec, later in scene.prescribed_motions.values()
            if spec.node not in clamps
            for x, y, rotation in [spec.motion]
            for turned in [joints.turned(spec.node, "support", rotation)]
        ),
        joints=tuple(
            fem.Joint(ends=tuple(ends), hinged=tuple(hinged), stiffness=tuple(hinged.values()))
            for ends in joints.meeting
            for hinged in [{end: joints.hinges[end] for end in ends[1:] if end in joints.hinges}]
        ),
        springs=tuple(
            fem.Spring(strip=spec.beam, end=spec.end, stiffness=stiffness)
            for spec in scene.springs
            for turned in [joints.turned(spec.node, "spring", spec.rotation or None)]
            for stiffness in [(*spec.stiffness, turned or 0.0)]
            if any(stiffness)
        ),
        loads=(
            *(
                fem.PointLoad(strip=beam, at=at, stage=stage, **kept(load, "force moment"))
                for stage, load in scene.numbered_loads()
                if load.force_per_length is None
                for beam, at in [joints.loaded(load)]
            ),
            *(
                fem.LineLoad(strip=beam.name, force=force, part=part, stage=stage)
                for beam, stage, force, part in line_loads(scene)
            ),
        ),
        pins=tuple(fem.Pin(name=pin.name, radius=pin.radius or 0.0, **ways(pin)) for pin in scene.pins),
        contacts=tuple(
            fem.Contact(strip=item.beam, **kept(item, "node side surface penalty penetration keep friction"))
            for item in scene.contacts
        ),
    )


class _Joints:
    """The ends that meet, joint by joint, those with a hinge last, and the stiffnesses of the hinges."""

    def __init__(self, scene: Scene) -> None:
        self.hinges = {hinge.node: hinge.stiffness for hinge in scene.hinges}
        self.meeting = [sorted(ends, key=self.hinges.__contains__) for ends in joints(scene)]

    def at(self, node: str) -> list[str]:
        """Return the ends that meet at one of them."""
        return next((ends for ends in self.meeting if node in ends), [node])

    def plain(self, node: str) -> str | None:
        """Return an end without a hinge at the joint of an end."""
        return next((end for end in self.at(node) if end not in self.hinges), None)

    def turned(self, node: str, kind: str, rotation: float | None) -> float | None:
        """Return what a condition states on the rotation of a joint; None where all of its ends turn freely in hinges."""
        if rotation is None or node not in self.hinges:
            return rotation
        plain = self.plain(node)
        if plain or any(self.hinges[end] for end in self.at(node)):
            way = (
                f'state it at "{plain}"' if plain else "use a pinned support and a [[spring]] with a rotation"
            )
            raise ModelError(
                f'the solid model states the rotation of a joint at an end without a hinge, the {kind} "{node}" has one; {way}, or --model tsm'
            )
        return None

    def loaded(self, load: LoadSpec) -> tuple[str, float]:
        """Return beam and part of its length at which a load acts; a moment acts on an end without a hinge."""
        if load.at is not None:
            return load.beam, load.at
        plain = self.plain(load.node) if load.moment else load.node
        if plain is None:
            raise ModelError(
                f'the solid model states a moment on a joint with an end without a hinge, "{load.node}" has none'
            )
        beam, end = (plain if load.node in self.hinges else load.node).split(".")
        return beam, float(end == "end")


def _is_clamp(scene: Scene, spec: SupportSpec) -> bool:
    """Whether a support clamps the edge itself, a single end at rest without load and spring; others hold the section's mean motion."""
    if len(spec.held) < len(COMPONENTS):
        return False
    if not (scene.prescribed_motions[spec.node].moves or spec.node in occupied(scene)):
        return True
    if scene.beam(spec.beam).solid_clamp == "full":
        raise ModelError(
            f'the solid model has a full clamp at rest without joint, load and spring, "{spec.node}" is another; use solid_clamp = "rod"'
        )
    return False


def rectangle(beam: BeamSpec) -> tuple[float, float]:
    """Return width and height of a beam's section at the start, or of the rectangle with its area and second moment.

    ``h = sqrt(12 I / A)``, ``b = A / h``.

    Raises ModelError if the rectangle is not slender in the plane.
    """
    if beam.width is not None and beam.height is not None:
        width, height = (size[0] if isinstance(size, tuple) else size for size in (beam.width, beam.height))
        return width, height
    height = beam.rectangle_height
    if height > SLENDER * beam.length:
        raise ModelError(
            f'the solid model needs the width and height of beam "{beam.name}": the rectangle of its area and second '
            f"moment is {height:.3g} high, more than an eighth of the length"
        )
    return beam.section()[0] / height, height


def _strip(beam: BeamSpec, clamps: set[str], mesh: tuple[int, int] | None) -> "Strip":
    from fem_reference import Strip

    width, height = rectangle(beam)
    nu = beam.poissons_ratio
    if nu is None:
        nu = beam.youngs_modulus / (2.0 * (beam.shear_modulus or beam.youngs_modulus)) - 1.0
    if not LEAST_RATIO < nu < 0.5:
        raise ModelError(
            f"the solid model needs a Poisson's ratio between {LEAST_RATIO:g} and 0.5, E/(2 G) - 1 = {nu:.6g}"
        )
    if (mesh or beam.mesh)[0] < 2:
        raise ModelError("the solid model needs at least 2 elements along the beam")
    return Strip(
        **kept(beam, "name start end turn youngs_modulus material"),
        height=height,
        width=width,
        end_height=beam.height[1] if isinstance(beam.height, tuple) else None,
        end_width=beam.width[1] if isinstance(beam.width, tuple) else None,
        poissons_ratio=nu,
        clamped=tuple(end for end in ("start", "end") if f"{beam.name}.{end}" in clamps),
        clamp=beam.solid_clamp,
        element=beam.solid_element,
        mesh_file=beam.solid_mesh_file if mesh is None else None,
        mesh=mesh or beam.mesh,
    )


def section_forces(scene: Scene, result: Any, beam: str, k: int) -> Sections:
    """Return the section forces; a clamped end that nothing else is joined to or acts on has its reaction as section force."""
    import fem_reference

    found = fem_reference.section_forces(result, beam, k)
    taken = occupied(scene)
    table, own = np.stack([found.stations, found.N, found.V, found.M]), scene.beam(beam)
    for support in scene.supports_of(beam):
        motion = scene.prescribed_motions[support.node].at(float(result.load_parameter[k]))
        turn, first = motion[2], support.end == "start"
        if turn is None or support.node in taken:
            continue
        held, sign = result.supports[support.node], 1 - 2 * first
        tangent = complex(*own.tangent(1.0 - first)) * np.exp(1.0j * turn)
        force = sign * complex(*held.force[k]) * tangent.conjugate()
        column = [(1.0 - first) * own.length, force.real, force.imag, sign * held.moment[k]]
        table = np.insert(table, 0 if first else table.shape[1], column, axis=1)
    return Sections(arc=table[0], N=table[1], V=table[2], M=table[3])


def j_integrals(scene: Scene, result: Any) -> dict[str, Array]:
    """Return the J-integrals at the clamps of `comparisons.answer.material.clamped`, shape (s,) by beam [force].

    The J-integral is the same for all sections between the clamp and the nearest contact. Its error changes its sign between
    neighbouring Gauss stations and is largest beside clamp and contact. The value is therefore the mean over the Gauss stations in
    between, without those nearer to clamp or contact than 1.5 heights or a quarter of the distance. It is nan where no station is left.
    The J-integral of a naturally curved beam is not constant, and is left out.
    """
    import fem_reference

    def mean(beam: BeamSpec, clamp: float, k: int) -> float:
        pairs = [contact.pair for contact in scene.contacts if contact.beam == beam.name]
        arcs = np.array([result.contacts[pair].arc_position[k] for pair in pairs])
        free = float(np.fmin.reduce(np.abs(arcs - clamp), initial=beam.length))
        margin = min(AWAY * beam.rectangle_height, SHARE * free)
        sections = fem_reference.section_forces(result, beam.name, k)
        distance = np.abs(sections.stations - clamp)
        inside = (distance > margin) & (distance < free - margin)
        return float(sections.material_force[inside].mean()) if inside.any() else nan

    steps, found = range(len(result.load_parameter)), {}
    for name, support in clamped(scene).items():
        beam = scene.beam(name)
        if not beam.turn:
            clamp = 0.0 if support.end == "start" else beam.length
            found[name] = np.array([mean(beam, clamp, k) for k in steps])
    return found


SOLID = Solid()
MODELS = (SOLID,)

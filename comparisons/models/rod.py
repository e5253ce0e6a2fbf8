"""The exact rods: Reissner's, which stretch and shear, by collocation under one pin and else by the referee, and the elastica."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from comparisons.answer import Array, ContactHistory, FrictionHistory, Response, Sections, SupportHistory
from comparisons.models.cantilever import RodScene, to_rod
from comparisons.models.model import Model, ModelError, Options, Style, Watch, refused
from comparisons.models.shared import POINTS, Axis, kept, rows
from comparisons.models.theory import CHANGE, ROUND_OFF, Bending
from comparisons.models.tsm import TSM
from comparisons.referee import Equilibrium, Verdict, certify
from comparisons.scene import Scene
from comparisons.scene.keys import SPECIAL


class Rod(Model):
    """Exact rods."""

    name = "rod"
    label = "exact rod"
    libraries = ("comparisons.models.rod_response",)
    meshed = False
    keys = SPECIAL.keys()
    reference = Options()
    style = Style(colour="#000000", width=1.2, unbroken=True)

    def by_referee(self, scene: Scene) -> bool:
        """Whether the scene is not one rod under one pin."""
        return refused(to_rod, scene) is not None

    def setting(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - the rod has no options
        """Return where the equilibria of several rods are from; empty for one rod."""
        return "exact equilibria along TSM's path" if self.by_referee(scene) else ""

    def refusal(self, scene: Scene) -> str | None:
        """Return why the rods cannot state `scene`; None if they can. Several rods are solved along the path of exact elements."""
        return TSM.refusal(scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:  # noqa: ARG002 - the rod has no options
        """Return the response to `scene`, not yet checked."""
        if self.by_referee(scene):
            return solve_rods(scene, watch)
        from comparisons.exact import rod_under_pin
        from comparisons.models.rod_response import local_response

        local, (contact,) = to_rod(scene), scene.contacts
        section, radius = kept(scene.beams[0], "EA GA EI length"), scene.radius(contact)
        pin = {"friction": contact.friction, "offset": scene.offset(contact) - radius, "radius": radius}
        return local_response(local, rod_under_pin(local.path, **section, **pin), unknowns=4)


class Elastica(Model):
    """The elastica, which neither stretches nor shears, under one pin on its axis, in closed form."""

    name = "elastica"
    label = "elastica"
    libraries = ("comparisons.models.rod_response",)
    meshed = False
    rod = False
    style = Style(colour="#444444", width=1.2)

    def apart(self, scene: Scene) -> float:
        """Return the part of a cantilever's deflection under a force at its tip that is shear, and as much of stretch."""
        return max(3.0 * beam.EI / beam.length**2 * (1.0 / beam.EA + 1.0 / beam.GA) for beam in scene.beams)

    def refusal(self, scene: Scene) -> str | None:
        """Return why the elastica cannot state `scene`; None if it can."""
        return refused(_on_axis, scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:  # noqa: ARG002 - the elastica has no options
        """Return the response to `scene`, not yet checked."""
        from comparisons.exact import elastica_under_pin
        from comparisons.models.rod_response import local_response

        local = _on_axis(scene)
        path = elastica_under_pin(local.path, **kept(scene.beams[0], "EI length"))
        return local_response(local, path, unknowns=1)

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:  # noqa: ARG002 - as above
        """Return the errors from missing stretch and shear."""
        beam = scene.beams[0]
        soft = beam.EI / beam.length**2 * (1 / beam.EA + 1 / beam.GA)
        return {
            "stretch and shear: EI/s^2 (1/EA + 1/GA) with the nearest s": CHANGE**2 * soft / bent.nearest**2,
            "round-off": ROUND_OFF,
        }


def _on_axis(scene: Scene) -> RodScene:
    """Return `scene` in the frame of the one cantilever that a pin on its axis pushes."""
    local = to_rod(scene, "the elastica")
    if scene.contacts[0].friction:
        raise ModelError("the elastica has no friction here, the scene has some")
    if scene.offset(scene.contacts[0]):
        raise ModelError(
            "the elastica has a point in contact on its axis only, the scene has a face or a round pin"
        )
    return local


States = Sequence[Equilibrium]


def solve_rods(scene: Scene, watch: Watch) -> Response:
    """Return the exact equilibria of a scene's rods along the path that exact TSM elements follow.

    The referee starts from the TSM answer at every load parameter, solves its own equations, and judges stability, admissibility
    and the path in between. Load parameters, springs, the gaps of open contacts and slip-offs are those of TSM; all other values are the
    referee's. The response ends before the first load parameter at which the verdict is not `Verdict.CERTIFIED`. `watch` receives
    every accepted step of TSM.
    """
    followed = TSM.solve(scene, TSM.reference, watch)
    found = certify(followed, scene, at=range(len(followed.load_parameter)))
    states = list[Equilibrium]()
    for item in found.judged:
        if item.verdict is not Verdict.CERTIFIED or item.exact is None:
            break
        states.append(item.exact)
    spent = _dissipated(scene, followed, states)
    sound = found.verdict in (Verdict.CERTIFIED, Verdict.NOT_JUDGED) or not found.judged
    # work of pins, supports and loads is strain energy and dissipation, unknown where a node slipped off
    work = np.array([state.strain_energy for state in states]) + sum(spent.values())
    reached = slice(len(states))

    def axis_line(beam: str, k: int) -> Axis:
        arc = np.linspace(0.0, scene.beam(beam).length, POINTS)
        return arc, states[k].shape(beam, arc).position

    return Response(
        status=followed.status if sound else found.verdict.name,
        message=followed.message if sound else found.reason,
        load_parameter=followed.load_parameter[reached],
        contacts={
            pair: _contact(pair, history, states, spent.get(pair, np.zeros(0)))
            for pair, history in followed.contacts.items()
        },
        work=work if spent and np.all(np.isfinite(work)) else None,
        supports={
            support.node: SupportHistory(force=held[:, :2], moment=held[:, 2])
            for support in scene.all_supports
            for held in [rows([state.reactions[support.node] for state in states], 3)]
        },
        springs={
            node: replace(one, force=one.force[reached], moment=one.moment[reached])
            for node, one in followed.springs.items()
        },
        tips={
            beam.name: rows([state.ends[f"{beam.name}.{scene.tip(beam.name)}"] for state in states], 2)
            for beam in scene.beams
        },
        newton_iterations=np.array([state.iterations for state in states], dtype=np.int64),
        unknowns=max((state.mesh.unknowns for state in states), default=0),
        axis_line=axis_line,
        critical=followed.critical,
        sections=lambda beam, k: _sections(scene, beam, states[k]),
        index=np.array([state.index for state in states], dtype=np.int64),
    )


def _contact(pair: str, followed: ContactHistory, states: States, spent: Array) -> ContactHistory:
    """Return the contact of the referee's equilibria; the gaps of open ones and the senses of slips are those of TSM."""
    closed, friction = [state.contacts.get(pair) for state in states], followed.friction

    def found(name: str, if_open: Any = 0.0) -> Array:
        return np.array([if_open if here is None else getattr(here, name) for here in closed])

    forces, arcs = rows(found("force", (0.0, 0.0)), 2), found("arc_position", np.nan)
    if friction is not None:
        sense = friction.slip[: len(states)]
        friction = FrictionHistory(
            tangential=found("drag"), normal=found("push"), slip=sense, dissipated=spent
        )
    return replace(
        followed,
        force=np.hypot(*forces.T),
        arc_position=arcs,
        gap=np.where(np.isnan(arcs), followed.gap[: len(states)], 0.0),
        vector=forces,
        friction=friction,
    )


def _dissipated(scene: Scene, followed: Response, states: States) -> dict[str, Array]:
    """Energies (s,) that the contacts with friction have dissipated, by pair."""
    pairs = [spec.pair for spec in scene.contacts if spec.friction]
    if not pairs:
        return {}
    from comparisons.referee.friction import History, dissipated

    history = History(followed, scene)
    parts = [dissipated(history, k, state) for k, state in enumerate(states)]
    return {pair: np.cumsum([part[pair] for part in parts]) for pair in pairs}


def _sections(scene: Scene, beam: str, state: Equilibrium) -> Sections:
    """Return the section forces, from both sides of the contacts, where they jump."""
    length, pairs = scene.beam(beam).length, [spec.pair for spec in scene.contacts if spec.beam == beam]
    jumps = [state.contacts[pair].arc_position for pair in pairs if pair in state.contacts]
    sides = [np.nextafter(arc, side) for arc in jumps for side in (0.0, length)]
    arc = np.unique([*np.linspace(0.0, length, POINTS), *sides])
    shape = state.shape(beam, arc)
    return Sections(arc=arc, N=shape.N, V=shape.Q, M=shape.moment)


ROD, ELASTICA = Rod(), Elastica()
MODELS = (ROD, ELASTICA)

"""The referee on loads along a beam, weight, natural curvature, taper, hinges, springs, stages and forces inside a beam."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss, legint, legval, legvander

from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.referee import (
    AnswerState,
    Equilibrium,
    SearchStatus,
    Verdict,
    answer_state,
    certify,
    equilibrium,
)
from comparisons.response import Response
from comparisons.scene import (
    BeamSpec,
    ContactSpec,
    HingeSpec,
    LoadSpec,
    Scene,
    SpringSpec,
    StageSpec,
    SupportSpec,
    load_scene,
)
from tests.comparisons.referee.forged import scene_of, stated

MATERIAL = {"youngs_modulus": 1e6, "poissons_ratio": 0.3}
GRAVITY = (2.0, -20.0)


def strip(**more: object) -> BeamSpec:
    given = {
        "name": "a",
        "start": (0.0, 0.0),
        "end": (1.0, 0.1),
        "height": 0.05,
        "width": 1.0,
        "clamped": ("start",),
    }
    return BeamSpec(**(given | MATERIAL | more))


def undeformed(scene: Scene, t: float = 1.0, **more: dict) -> AnswerState:
    parts = np.linspace(0.0, 1.0, 41)
    axes = {
        beam.name: (parts * beam.length, np.array([beam.place(x) for x in parts])) for beam in scene.beams
    }
    nothing = {"arcs": {}, "forces": {}, "reactions": {}, "tips": {}}
    return AnswerState(load_parameter=t, axes=axes, **(nothing | more))


def found(scene: Scene, given: AnswerState | None = None) -> Equilibrium:
    exact = equilibrium(scene, given or undeformed(scene))
    assert exact.status is SearchStatus.FOUND, exact.message
    return exact


WEIGHT = {"beams": (strip(density=3.0),), "gravity": GRAVITY}
CURVED = {"beams": (strip(turn=0.8),)}
TIP = {"loads": (LoadSpec(beam="a", end="end", force=(1.0, 6.0), moment=0.5),)}
PART = LoadSpec(beam="a", force_per_length=(5.0, -10.0), part=(0.15, 0.55))
INSIDE = LoadSpec(beam="a", at=0.8, force=(2.0, 3.0), moment=0.4)
SPRING = SpringSpec(beam="a", end="end", stiffness=(2.0, 5.0), rotation=0.4)
HEAVY_TAPER = {"beams": (strip(density=3.0, height=(0.05, 0.03)),), "gravity": GRAVITY}


def on_its_face() -> Scene:
    """The same with a thicker strip, whose face leans, under a round pin."""
    scene = scene_of("everything")
    return replace(
        scene,
        beams=(replace(scene.beams[0], height=(0.12, 0.06), poissons_ratio=0.4),),
        contacts=(replace(scene.contacts[0], surface="face"),),
        pins=(replace(scene.pins[0], radius=0.05, start=(0.6, -0.25)),),
    )


def nearest(scene: Scene) -> Equilibrium:
    """The equilibrium at the end next to the undeformed beam under a push, or to the answer of a model."""
    if scene.name == "everything":
        push = (-10.0, 60.0) if scene.pins[0].radius else (-3.0, 10.0)
        return found(scene, undeformed(scene, arcs={"pin->a": 0.62}, forces={"pin->a": push}))
    answer = solve(scene, "tsm", Options(element="exact"))
    return found(scene, answer_state(answer, scene, -1))


NODES, WEIGHTS = leggauss(16)
SUMS = (
    np.array([legval(NODES, legint(row, lbnd=-1.0)) for row in np.linalg.inv(legvander(NODES, 15)).T]).T / 2.0
)
"""Integrals from the beginning of a panel to its nodes."""


def rates(at: tuple, turn: float, y: np.ndarray) -> np.ndarray:
    """Rates of ``x, y, theta, m, n_x, n_y`` by the arc length: ``theta' = m/EI + kappa0``, ``m' = -r' x n``, ``n' = -q``."""
    (EA, GA, EI), (qx, qy) = at
    _, _, theta, m, nx, ny = y.T
    c, d = np.cos(theta), np.sin(theta)
    N, Q = nx * c + ny * d, ny * c - nx * d
    dx, dy = (1.0 + N / EA) * c - Q / GA * d, (1.0 + N / EA) * d + Q / GA * c
    return np.stack([dx, dy, m / EI + turn, dy * nx - dx * ny, -qx + 0.0 * m, -qy + 0.0 * m], axis=-1)


def along(scene: Scene, t: float, s: np.ndarray, inside: float) -> tuple:
    """Stiffnesses and loads per length at arc positions s, in a part around `inside`."""
    beam = scene.beams[0]
    stiff = np.array([beam.stiffness(x / beam.length) for x in s]).T
    mass = np.array([beam.mass_per_length(x / beam.length) for x in s])
    spread = [load for load in scene.loads if load.force_per_length is not None]
    acting = [load.force_per_length for load in spread if load.span[0] < inside / beam.length < load.span[1]]
    line = np.sum(acting, axis=0) if acting else np.zeros(2)
    return stiff, t * (np.outer(scene.gravity or (0.0, 0.0), mass) + line[:, None])


def ahead(scene: Scene, t: float, y: np.ndarray, begin: float, end: float, panels: int = 6) -> np.ndarray:
    """State at the end of a part, by collocation at Gauss points."""
    turn = scene.beams[0].turn / scene.beams[0].length
    for a, b in pairwise(np.linspace(begin, end, panels + 1)):
        s, h, change = a + (b - a) * (NODES + 1.0) / 2.0, b - a, np.zeros((16, 6))
        at = along(scene, t, s, (begin + end) / 2.0)
        for _ in range(30):
            change = rates(at, turn, y + h * SUMS @ change)
        y = y + h * WEIGHTS @ change / 2.0
    return y


def touch(
    scene: Scene, t: float, spec: ContactSpec, s: float, force: np.ndarray, y: np.ndarray
) -> list[float]:
    """Take a contact force from the state, and return what its place and direction miss.

    The force is normal to the face, whose direction is that of the mean tangent, or leans from it where the height tapers.
    """
    beam, sign, face = scene.beams[0], 1.0 if spec.side == "left" else -1.0, spec.surface == "face"
    at, turn = along(scene, t, np.array([s]), s), beam.turn / beam.length
    before = rates(at, turn, y[None])[0, :2]
    y[4:] -= force
    mean = (before + rates(at, turn, y[None])[0, :2]) / 2.0
    tilt = math.atan((beam.height_at(1.0) - beam.height_at(0.0)) / 2.0 / beam.length) if face else 0.0
    offset = scene.pin(spec.node).radius or 0.0
    offset += beam.height_at(s / beam.length) / 2.0 * math.cos(tilt) if face else 0.0
    phi = math.atan2(mean[1], mean[0]) + math.asin(sign * math.sin(tilt) / math.hypot(*mean))
    along_it = np.array([math.cos(phi), math.sin(phi)])
    out = sign * offset * np.array([-along_it[1], along_it[0]])
    return [*(y[:2] + out - scene.pin(spec.node).position(t)), force @ along_it]


def misses(scene: Scene, exact: Equilibrium, z: np.ndarray) -> np.ndarray:
    """What the equations miss at the contacts and the tip, from the clamp on: nothing of it is the referee's own.

    The unknowns are the forces and the moment at the clamp, and the arc position and the force of each contact.
    """
    beam, t, missed = scene.beams[0], exact.load_parameter, []
    closed = [spec for spec in scene.contacts if spec.pair in exact.contacts]
    touches = {row[0]: (spec, row[1:]) for spec, row in zip(closed, z[3:].reshape(-1, 3), strict=True)}
    inside = {load.at * beam.length: load for load in scene.loads if load.at is not None}
    ends = {part * beam.length for load in scene.loads if load.force_per_length for part in load.span}
    direction = math.atan2(beam.end[1] - beam.start[1], beam.end[0] - beam.start[0])
    y = np.array([*beam.start, direction - beam.turn / 2.0, z[2], *z[:2]])
    for begin, end in pairwise(sorted({0.0, *touches, *inside, *ends, beam.length})):
        y = ahead(scene, t, y, begin, end)
        if end in inside:
            y[3:] -= t * np.array([inside[end].moment, *inside[end].force])
        if end in touches:
            missed += touch(scene, t, touches[end][0], end, touches[end][1], y)
    moved = np.array([*(y[:2] - beam.end), y[2] - direction - beam.turn / 2.0])
    for support in scene.supports:
        return np.array([*missed, *(moved[:2] - t * np.array(support.displacement)), y[3]])
    held = sum((t * np.array([*load.force, load.moment]) for load in scene.loads if load.end), np.zeros(3))
    for spring in scene.springs:
        held -= np.array([*spring.stiffness, spring.rotation]) * moved
    return np.array([*missed, *(y[[4, 5, 3]] - held)])


def step_to_truth(scene: Scene, exact: Equilibrium) -> np.ndarray:
    """One step of Newton's method from the referee's answer to the zero of `misses`, relative to the largest force and to the length."""
    z = [*-exact.reactions[f"{scene.beams[0].name}.start"]]
    for item in (exact.contacts[spec.pair] for spec in scene.contacts if spec.pair in exact.contacts):
        z += [item.arc_position, *item.force]
    z = np.array(z)
    size = np.full(len(z), np.abs(np.delete(z, np.s_[3::3])).max())
    size[3::3] = scene.beams[0].length
    steps = 1e-5 * np.diag(size)
    jacobian = np.array([(misses(scene, exact, z + e) - misses(scene, exact, z - e)) / 2e-5 for e in steps]).T
    return np.linalg.solve(jacobian, misses(scene, exact, z))


SHOT = {
    "everything": scene_of("everything"),
    "everything under a round pin on its face": on_its_face(),
    "strong shear": scene_of("shear"),
    "moved tip": replace(load_scene("ks-tied-tip"), load_parameters=4),
    "under a face": replace(load_scene("ks-face"), load_parameters=4),
    "two pins": scene_of("two-pins"),
}  # fmt: skip


@pytest.mark.parametrize("key", SHOT)
def test_the_equilibrium_is_that_of_shooting_to_1e_14(key):
    """Forces and moments over the largest, and arc positions over the length, on every key alone, all together and contacts on faces."""
    scene = SHOT[key]
    exact = nearest(scene)
    assert np.abs(step_to_truth(scene, exact)).max() < 1e-14
    assert exact.index == 0


TIGHT = 1e-9
"""Allowance of answers that are exact: the stated ones are next to round-off."""


def scene(**given: object) -> Scene:
    return Scene(name="specimen", load_parameters=2, **given)


def exactly(scene: Scene) -> Response:
    """The exact answer to a scene, by continuation from the undeformed state."""
    return stated(scene, [found(scene, undeformed(scene, t)) for t in scene.times])


ROLLER = SupportSpec(beam="a", end="end", kind="roller", free="x")
CLAMPED = {"beams": (strip(end=(1.0, 0.0)),), "supports": (ROLLER,), "loads": (PART,)}
HINGED = CLAMPED | {"hinges": (HingeSpec(beam="a", end="start", stiffness=20.0),)}
UP, ALONG = LoadSpec(beam="a", end="end", force=(0.0, 5.0)), LoadSpec(beam="a", end="end", force=(-5.0, 1.0))
STAGED = {"beams": (strip(),), "loads": (UP,), "stages": (StageSpec(load_parameters=2, load=(ALONG,)),)}
LOOSE = (
    SpringSpec(beam="a", end="start", stiffness=(0.0, 400.0)),
    SpringSpec(beam="a", end="end", stiffness=(0.0, 400.0)),
)
SPRUNG = {"beams": (strip(end=(1.0, 0.0), clamped=()),), "springs": LOOSE, "loads": (INSIDE,), "supports": (SupportSpec(beam="a", end="start", fixed=("x",)),)}  # fmt: skip
MORE = 1.0 + 1e-6
OTHERS: dict[str, tuple[dict[str, object], dict[str, object], bool]] = {
    "weight": (WEIGHT, {"gravity": (2.0 * MORE, -20.0 * MORE)}, False),
    "heavy taper": (HEAVY_TAPER, {"beams": (strip(density=3.0, height=0.04),)}, True),
    "curvature": (CURVED | TIP, {"beams": (strip(turn=-0.8),)}, True),
    "load on a part": ({"beams": (strip(),), "loads": (PART,)}, {"loads": (replace(PART, force_per_length=(5.0 * MORE, -10.0 * MORE)),)}, False),
    "force inside": ({"beams": (strip(),), "loads": (INSIDE,)}, {"loads": (replace(INSIDE, at=0.8001),)}, False),
    "spring": ({"beams": (strip(),), "springs": (SPRING,)} | TIP, {"springs": (replace(SPRING, rotation=0.396),)}, False),
    "springs alone": (SPRUNG, {"springs": (LOOSE[0], replace(LOOSE[1], stiffness=(0.0, 396.0)))}, False),
    "hinge": (HINGED, {"hinges": ()}, True),
    "stage": (STAGED, {"loads": (ALONG,), "stages": (StageSpec(load_parameters=2, load=(UP,)),)}, True),
}  # fmt: skip
"""A scene, what another scene has instead, and whether their answers differ by more than the default allowance."""


@pytest.mark.parametrize("key", OTHERS)
def test_the_answer_to_another_scene_is_refused(key):
    given, other, rough = OTHERS[key]
    right = scene(**given)
    assert certify(exactly(right), right, allowance=TIGHT).certified
    wrong = exactly(scene(**given | other))
    for allowance in (TIGHT, None) if rough else (TIGHT,):
        refused = certify(wrong, right, allowance=allowance)
        assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM, refused.line()


def test_no_key_is_left_out_of_the_balance():
    """All keys at once with a pin in contact: the stated forces alone balance to 1e-6 with the scene's loads and springs."""
    right = scene_of("everything")
    answer = stated(right, [nearest(right)])
    assert certify(answer, right, allowance=TIGHT).certified
    others = {"gravity": (2.0, -20.0 * (1.0 - 1e-3)), "springs": (replace(SPRING, stiffness=(2.0, 5.01)),)}
    for key, other in others.items():
        refused = certify(answer, replace(right, **{key: other}), allowance=1.0)
        assert refused.verdict is Verdict.NOT_AN_EQUILIBRIUM
        assert "do not balance" in refused.reason

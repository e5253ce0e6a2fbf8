"""`solve_batch` against `solve`, structure by structure."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

import tsm
from comparisons.claims.extremes.axes import matrix
from comparisons.cost.cases import sweep_cases
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tsm.batch import march
from tsm.batch.constants import constants_of, take
from tsm.batch.elimination import eliminate, reach, row_length
from tsm.batch.equations import Configurations, Equations
from tsm.batch.geometry import project
from tsm.batch.topology import topology
from tsm.elements import mixed_contact
from tsm.elements.properties import Properties
from tsm.model import Model
from tsm.state import State, Touch
from tsm.system import Assembler

SHARP = tsm.Settings(tolerance=1e-12)
"""At the default tolerance, round-off may decide whether an iteration more is done: results then differ by what it still changes."""
STEPS = np.arange(1, 26) / 25

Build = Callable[..., tsm.Structure]


def pushed(rng: np.random.Generator, element: str = "mixed") -> tsm.Structure:
    """Cantilever of any size, stiffness and division, pushed along any path from either side, on the axis or on a face."""
    L = rng.uniform(0.5, 2)
    h, E = L * rng.uniform(0.01, 0.05), 10 ** rng.uniform(3, 6)
    side, offset = str(rng.choice(["left", "right"])), float(rng.choice([0.0, h / 2]))
    up = -1 if side == "left" else 1
    start = (L * rng.choice([1.0, rng.uniform(0.3, 1)]), -up * (offset + rng.choice([0.0, 0.05 * L])))
    corners = [
        (L * rng.uniform(-0.2, 1.2), up * L * rng.uniform(-0.3, 0.9)) for _ in range(rng.integers(1, 4))
    ]
    nodes = tuple(sorted(rng.uniform(0.05, 0.95, 7))) if rng.random() < 0.5 else ()
    section = tsm.Section.rectangle(width=h, height=h, youngs_modulus=E, shear_modulus=E / 2.6)
    beam = tsm.Beam(
        name="beam",
        start=(0.0, 0.0),
        end=(L, 0.0),
        section=section,
        elements=8,
        element=element,
        nodes=nodes,
    )
    contact = tsm.ContactPair(
        node="pin",
        beam="beam",
        side=side,  # type: ignore[arg-type]
        offset=offset,
        keep=bool(rng.random() < 0.3),
    )
    return tsm.Structure(
        beams=(beam,),
        supports=(tsm.Support(beam="beam", end="start"),),
        pins=(tsm.Pin(name="pin", path=(start, *corners)),),
        contacts=(contact,),
    )


def double(rng: np.random.Generator, elements: int = 6) -> tsm.Structure:
    """The two cantilevers of the paper, one of them stiffer, in any size."""
    base = to_structure(load_scene("double-beam"), elements=elements)
    size, stiffer = rng.uniform(0.5, 2), rng.uniform(0.9, 1.1, 2)

    def scaled(point: tuple[float, float]) -> tuple[float, float]:
        return (size * point[0], size * point[1])

    return replace(
        base,
        beams=tuple(
            replace(
                beam,
                start=scaled(beam.start),
                end=scaled(beam.end),
                section=replace(beam.section, EI=beam.section.EI * by),
            )
            for beam, by in zip(base.beams, stiffer, strict=True)
        ),
        pins=tuple(replace(pin, path=tuple(map(scaled, pin.path))) for pin in base.pins),
    )


def assert_same(one: tsm.Result, other: tsm.Result, within: float) -> None:
    """Same outcome, events and quantities, these in parts of the largest force, the length and their product."""
    assert (other.status, other.message) == (one.status, one.message)
    assert np.array_equal(other.load_parameter, one.load_parameter)
    assert [(e.kind, e.pair, e.element) for e in other.events] == [
        (e.kind, e.pair, e.element) for e in one.events
    ]
    for event, other_event in zip(one.events, other.events, strict=True):
        between = event.kind is tsm.EventKind.PASS_THROUGH  # which is interpolated between the steps
        assert other_event.load_parameter == pytest.approx(
            event.load_parameter, abs=0.02 if between else 1e-11
        )
    L = one.model.length
    F = max(one.model.force_scale, *(np.abs(c.force).max(initial=0.0) for c in one.contacts.values()))
    for name, contact in one.contacts.items():
        other_contact = other.contacts[name]
        np.testing.assert_allclose(other_contact.force, contact.force, rtol=0, atol=within * F)
        np.testing.assert_allclose(other_contact.arc_position, contact.arc_position, rtol=0, atol=within * L)
        np.testing.assert_allclose(other_contact.gap, contact.gap, rtol=0, atol=within * L)
    for name, held in one.supports.items():
        np.testing.assert_allclose(other.supports[name].force, held.force, rtol=0, atol=within * F)
        np.testing.assert_allclose(other.supports[name].moment, held.moment, rtol=0, atol=within * F * L)
    for name, tip in one.tips.items():
        np.testing.assert_allclose(other.tips[name], tip, rtol=0, atol=within * L)
    assert len(other.equilibria) == len(one.equilibria)


def assert_tables(batch: tsm.BatchResult) -> None:
    """The tables say what the results say, nan where a structure did not come."""
    for n, result in enumerate(batch):
        reached = len(result.load_parameter)
        assert batch.status[n] is result.status
        assert batch.cutbacks[n] == result.cutbacks
        rows = [
            (batch.newton_iterations[n], result.newton_iterations, 0),
            *((batch.force[name][n], c.force, np.nan) for name, c in result.contacts.items()),
            *((batch.arc_position[name][n], c.arc_position, np.nan) for name, c in result.contacts.items()),
            *((batch.supports[name].force[n], s.force, np.nan) for name, s in result.supports.items()),
            *((batch.supports[name].moment[n], s.moment, np.nan) for name, s in result.supports.items()),
            *((batch.tips[name][n], tip, np.nan) for name, tip in result.tips.items()),
        ]
        for table, own, beyond in rows:
            np.testing.assert_allclose(
                table[:reached], own, rtol=1e-9, atol=1e-9 * np.abs(np.nan_to_num(own)).max(initial=0)
            )
            np.testing.assert_array_equal(table[reached:], np.full_like(table[reached:], beyond))


def solve_each(
    structures: Sequence[tsm.Structure], t: np.ndarray, settings: tsm.Settings
) -> list[tsm.Result]:
    return [tsm.solve(structure, t, settings, throw=False) for structure in structures]


@pytest.mark.slow
def test_any_cantilever_ends_as_it_does_alone() -> None:
    rng = np.random.default_rng(2)
    structures = [pushed(rng) for _ in range(40)]
    batch = tsm.solve_batch(structures, STEPS, SHARP)
    for one, other in zip(solve_each(structures, STEPS, SHARP), batch, strict=True):
        assert_same(one, other, 1e-12)
    assert_tables(batch)
    kinds = {event.kind for result in batch for event in result.events}
    assert kinds >= {
        tsm.EventKind.TOUCH,
        tsm.EventKind.RELEASE,
        tsm.EventKind.SLIP_OFF,
        tsm.EventKind.PASS_THROUGH,
    }
    assert set(batch.status) >= {tsm.Status.COMPLETED, tsm.Status.SLIPPED_OFF, tsm.Status.LIMIT_POINT}
    assert batch.cutbacks.any()


@pytest.mark.slow
@pytest.mark.parametrize("element", ["mixed", "mixed-no-bow"])
def test_default_tolerance_bounds_the_difference(element: str) -> None:
    rng = np.random.default_rng(5)
    structures = [pushed(rng, element) for _ in range(10)]
    settings = tsm.Settings()
    batch = tsm.solve_batch(structures, STEPS, settings)
    for one, other in zip(solve_each(structures, STEPS, settings), batch, strict=True):
        assert_same(one, other, settings.tolerance)


@pytest.mark.slow
def test_two_beams_in_contact_with_each_other() -> None:
    rng = np.random.default_rng(3)
    structures = [double(rng) for _ in range(4)]
    depths = np.arange(1, 39) / 38
    batch = tsm.solve_batch(structures, depths, SHARP)
    for one, other in zip(solve_each(structures, depths, SHARP), batch, strict=True):
        assert_same(one, other, 1e-12)
    assert_tables(batch)
    assert all((batch.force[pair.name] > 0).any() for pair in structures[0].contacts)


@pytest.mark.slow
def test_parts_of_a_batch_do_not_know_of_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(7)
    structures = [pushed(rng) for _ in range(9)]
    whole = tsm.solve_batch(structures, STEPS, SHARP)
    monkeypatch.setattr(march, "_ENTRIES", 24)
    parts = tsm.solve_batch(structures, STEPS, SHARP)
    assert parts.status == whole.status
    for result, other in zip(whole, parts, strict=True):
        assert_same(result, other, 1e-12)


def test_plain_structures_never_leave_the_batch(ks: Build, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("left to the stepper")

    monkeypatch.setattr(march.March, "_alone", refuse)
    batch = tsm.solve_batch([ks(), ks(offset=0.01), ks(start=(0.9, 0.0))], np.arange(1, 46) / 50)
    assert {status.name for status in batch.status} == {"COMPLETED"}


@pytest.mark.parametrize("count", [1, 3])
def test_a_start_that_is_not_at_rest_is_left_to_the_stepper(ks: Build, count: int) -> None:
    """Below round-off the undeformed state, its pin a bit off the axis, is no equilibrium at once."""
    structures = [ks(start=(0.9, -1e-13)), ks(), ks(start=(0.8, -1e-13))]
    settings = tsm.Settings(tolerance=1e-25)
    t = np.arange(1, count + 1) / 10
    batch = tsm.solve_batch(structures, t, settings)
    for one, other in zip(solve_each(structures, t, settings), batch, strict=True):
        assert_same(one, other, 1e-12)


def test_a_start_that_stops_is_named(ks: Build) -> None:
    """A pin so far from the axis that round-off excuses nothing, and no iterations to bring the beam there."""
    structures = [ks(), ks(start=(0.9, -0.9e-10))]
    settings = tsm.Settings(tolerance=1e-13, max_iterations=1, smallest_step=0.9)
    batch = tsm.solve_batch(structures, STEPS[:1], settings)
    for one, other in zip(solve_each(structures, STEPS[:1], settings), batch, strict=True):
        assert_same(one, other, 1e-12)
    assert batch.status[1] is not tsm.Status.COMPLETED


def test_results_are_a_sequence(ks: Build) -> None:
    batch = tsm.solve_batch([ks(), ks(offset=0.01), ks(start=(0.8, 0.0))], STEPS[:3])
    assert len(batch) == 3
    assert batch[-1].tips["cantilever"][-1] == pytest.approx(batch.tips["cantilever"][2, -1])
    assert [result.model.structure for result in batch[1:]] == [ks(offset=0.01), ks(start=(0.8, 0.0))]
    assert batch[0].strain_energy[-1] > 0
    with pytest.raises(IndexError):
        batch[3]


@pytest.mark.parametrize("element", ["exact", "timoshenko"])
def test_other_elements_are_solved_one_by_one(ks: Build, element: str) -> None:
    structures = [ks(4, element), ks(4, element, start=(0.9, 0.0))]
    batch = tsm.solve_batch(structures, STEPS[:4])
    for one, other in zip(solve_each(structures, STEPS[:4], tsm.Settings()), batch, strict=True):
        assert_same(one, other, 0.0)
    assert_tables(batch)


def test_loads_are_solved_one_by_one() -> None:
    def bent(force: float) -> tsm.Structure:
        section = tsm.Section(EA=1e4, GA=1e4, EI=1.0)
        return tsm.Structure(
            beams=(tsm.Beam(name="beam", start=(0, 0), end=(1, 0), section=section, elements=4),),
            supports=(tsm.Support(beam="beam", end="start"),),
            loads=(tsm.Load(beam="beam", end="end", force=(0.0, force)),),
        )

    batch = tsm.solve_batch([bent(0.5), bent(1.0)], STEPS[:4])
    assert batch.supports["beam.start"].force[:, -1, 1] == pytest.approx([-0.08, -0.16])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: replace(s, pins=(*s.pins, tsm.Pin(name="b", path=((0, 0), (1, 1))))), r"\[1\].pins"),
        (lambda s: replace(s, contacts=()), r"\[1\].contacts = \[\]"),
        (lambda s: replace(s, beams=(replace(s.beams[0], elements=5),)), r"\[1\].beams"),
        (lambda s: replace(s, beams=(replace(s.beams[0], element="exact"),)), r"\[1\].beams"),
        (lambda s: replace(s, supports=(replace(s.supports[0], rotation=None),)), r"\[1\].supports"),
    ],
)
def test_structures_must_be_alike(ks: Build, change: Callable[..., tsm.Structure], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        tsm.solve_batch([ks(), change(ks())], STEPS)


@pytest.mark.parametrize("element", ["mixed", "exact"])
def test_a_node_behind_its_surface_is_named(ks: Build, element: str) -> None:
    behind = ks(10, element, start=(0.7, 0.1))
    with pytest.raises(ValueError, match=r"structures\[1\]: ContactPair\(pin->cantilever\).side"):
        tsm.solve_batch([ks(10, element), behind], STEPS)


def test_other_bad_input(ks: Build) -> None:
    with pytest.raises(ValueError, match="structures"):
        tsm.solve_batch([], STEPS)
    with pytest.raises(ValueError, match="load_parameters"):
        tsm.solve_batch([ks()], STEPS[::-1])


def test_elimination() -> None:
    rng = np.random.default_rng(0)
    n, k, b, count = 11, 4, 3, 6
    A = rng.standard_normal((n + b, n + b, count))
    A += A.swapaxes(0, 1)
    i, j = np.indices((n, n))
    A[:n, :n][np.abs(i - j) > k] = 0.0
    A[np.arange(n), np.arange(n)] += rng.choice([-6.0, 6.0], (n, count))
    r = rng.standard_normal((n + b, count))
    band = np.zeros((n, row_length(k), count))
    for d in range(k + 1):
        band[np.arange(n - d), d] = A[np.arange(d, n), np.arange(n - d)]
    rows, columns = np.nonzero((i >= j) & (i - j <= k))
    right = np.concatenate([r[None, :n], A[n:, :n]])
    x, z, sign = eliminate(band, reach(rows, columns, n), right, A[n:, n:].copy(), r[n:].copy())
    expected = np.linalg.solve(A.transpose(2, 0, 1), r.T[..., None])[..., 0].T
    np.testing.assert_allclose(np.concatenate([x, z]), expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(sign, np.linalg.slogdet(A.transpose(2, 0, 1)).sign)
    assert len(set(sign)) == 2


def crowd(rng: np.random.Generator, count: int) -> tuple[list[tsm.Structure], Configurations]:
    """Double beams in any configuration; in some, pin and upper tip touch one element of the lower beam."""
    structures = [double(rng) for _ in range(count)]
    structures = [
        replace(s, contacts=tuple(replace(pair, offset=0.01 * float(rng.random() < 0.5)) for pair in s.contacts))
        for s in structures
    ]  # fmt: skip
    model = Model(structures[0])
    first = np.array([pair.target.first for pair in model.pairs])
    element = first[:, None] + rng.integers(0, 6, (3, count))
    element[2] = np.where(rng.random(count) < 0.7, element[1], element[2])
    at = Configurations(
        q=0.1 * rng.standard_normal((model.dof_count, count)),
        closed=rng.random((3, count)) < 0.7,
        element=element,
        xi=rng.random((3, count)),
        force=rng.standard_normal((3, 2, count)),
        node=rng.standard_normal((3, 2, count)),
    )
    at.q[model.fixed] = 0.0
    for k, pair in enumerate(model.pairs):
        if pair.pin:
            at.node[k] = np.transpose([s.pins[0].path[0] for s in structures])
    return structures, at


def alone(at: Configurations, n: int) -> State:
    touches = tuple(
        Touch(element=int(at.element[k, n]), xi=float(at.xi[k, n]), force=tuple(at.force[k, :, n].tolist()))
        if at.closed[k, n]
        else None
        for k in range(3)
    )
    return State(load_parameter=0.0, q=at.q[:, n].copy(), touches=touches, armed=(True,) * 3)


def test_residual_and_step_are_those_of_the_assembler() -> None:
    structures, at = crowd(np.random.default_rng(1), 12)
    model = Model(structures[0])
    equations, constants = Equations(model), constants_of(structures, model)
    system = equations.linearise(constants, at)
    residual = np.concatenate([system.nodal[model.free], system.contacts])
    dq, dz, sign = equations.solve(system)
    together = at.closed[1] & at.closed[2] & (at.element[1] == at.element[2])
    assert together.any()
    for n, structure in enumerate(structures):
        assembler = Assembler(Model(structure))
        expected = assembler.linearise(alone(at, n))
        scale = np.abs(expected.residual).max()
        np.testing.assert_allclose(residual[:, n], expected.residual, rtol=0, atol=1e-12 * scale)
        solved = assembler.solve(expected)
        assert solved is not None
        step = np.concatenate([dq[:, n], dz[:, n]])
        np.testing.assert_allclose(step, solved[:, 0], rtol=1e-7, atol=1e-7 * np.abs(solved).max())
        assert sign[n] == np.linalg.slogdet(assembler.whole(expected.tangent).toarray()).sign


def test_tangent_is_the_derivative_of_the_residual() -> None:
    structures, at = crowd(np.random.default_rng(4), 8)
    model = Model(structures[0])
    equations, constants = Equations(model), constants_of(structures, model)

    def residual(along: float) -> np.ndarray:
        own = along * dz.reshape(3, 3, -1)
        moved = at._replace(q=at.q.copy(), force=at.force + own[:, :2])
        moved.q[model.free] += along * dq
        l0 = np.stack([constants.properties.l0[e, np.arange(len(e))] for e in at.element])
        system = equations.linearise(constants, moved._replace(xi=at.xi + own[:, 2] / l0))
        return np.concatenate([system.nodal[model.free], system.contacts])

    system = equations.linearise(constants, at)
    before = np.concatenate([system.nodal[model.free], system.contacts])
    dq, dz, _ = equations.solve(system)
    largest = np.maximum(np.abs(dq).max(axis=0), 1e-3 * np.abs(dz).max(axis=0))
    dq, dz = dq / largest, dz / largest
    h = 1e-6
    slope = (residual(h) - residual(-h)) / (2 * h)
    np.testing.assert_allclose(slope, -before / largest, rtol=0, atol=1e-6 * np.abs(slope).max())


def test_projection_is_that_of_one_structure() -> None:
    structures, at = crowd(np.random.default_rng(6), 12)
    at.q[:] *= 0.2
    at.closed[0] = at.closed[2] = False
    model = Model(structures[0])
    equations, constants = Equations(model), constants_of(structures, model)
    for k in (0, 2):
        seen = project(equations, constants, at, k, np.arange(len(structures)))
        for n, structure in enumerate(structures):
            own = Model(structure)
            expected = own.pairs[k].group.project(own.pairs[k], alone(at, n))
            got = (*(float(value[n]) for value in seen),)
            assert got == pytest.approx(tuple(map(float, expected)), abs=1e-9)


def test_paths_of_the_pins() -> None:
    rng = np.random.default_rng(8)
    structures = [pushed(rng) for _ in range(20)]
    assert len({len(structure.pins[0].path) for structure in structures}) == 3
    constants = constants_of(structures, Model(structures[0]))
    which = np.arange(3, 20)
    t = rng.random(17)
    t[:3] = 0.0, 0.5, 1.0
    with np.errstate(all="ignore"):
        found = constants.paths.position(0, t, which)
    expected = [structures[n].pins[0].position(float(at)) for n, at in zip(which, t, strict=True)]
    np.testing.assert_allclose(found.T, expected, rtol=0, atol=1e-14)


def test_contacts_in_one_array_are_those_one_by_one() -> None:
    rng = np.random.default_rng(9)
    count = 5
    p = Properties(
        *(1.0, 0.1, math.hypot(1.0, 0.1), 1e3, 1.0, 0.2),
    )
    many = Properties(*(np.full(count, value) for value in p))
    x, xi, force = 0.1 * rng.standard_normal((6, count)), rng.random(count), rng.standard_normal((2, count))
    offset = np.array([0.0, 0.01, 0.02, 0.0, 0.03])
    gradient, hessian = mixed_contact.jet(many, x, xi, force, np.ones(count), offset)
    for n in range(count):
        one = mixed_contact.jet(
            p, x[:, n].tolist(), float(xi[n]), force[:, n].tolist(), 1.0, float(offset[n])
        )
        np.testing.assert_allclose(gradient[:, n], one[0], rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(hessian[:, n], one[1], rtol=1e-12, atol=1e-14)


def test_some_structures_of_a_record() -> None:
    rng = np.random.default_rng(10)
    structures = [pushed(rng) for _ in range(4)]
    model = Model(structures[0])
    part = take(constants_of(structures, model), np.array([False, True, False, True]))
    expected = constants_of(structures[1::2], model)
    np.testing.assert_array_equal(part.coefficients.constant, expected.coefficients.constant)
    np.testing.assert_array_equal(part.arc, expected.arc)
    np.testing.assert_array_equal(part.scales.noise, expected.scales.noise)


def test_what_the_suite_could_solve_at_once(stated) -> None:
    """Cases of beams, and groups that share what a batch shares."""
    extremes = [case for cell in matrix() for case in cell.cases]
    for name, cases in (("trade", sweep_cases(load_scene("ks-cantilever"))), ("extremes", extremes)):
        beams = {case for case in cases if case.model == "tsm"}
        groups = set()
        for case in beams:
            structure = to_structure(case.scene, element=case.options.element, elements=case.options.elements)
            groups.add((repr(topology(structure)), case.scene.times, case.options.integration_tolerance))
        stated(f"batch.{name}", len(beams), len(groups))

"""Ratios of beams: against the solid, elements against each other, cost of an iteration, many beams."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import fem_reference
import tsm
from comparisons.cases import measure
from comparisons.cost.points import cheapest
from comparisons.cost.sweep import measure_trade
from comparisons.exact.rod import rod_under_pin
from comparisons.models import solve
from comparisons.models.translate import to_rod, to_solid, to_structure
from comparisons.scene import load_scene, read_scene
from tests.benchmarks.measure import Gate, seconds
from tests.comparisons.many_beams import MANY
from tsm.model import Model
from tsm.system import Assembler


def beams_against_solid(gates: list[Gate], times: dict[str, float]) -> None:
    scene = load_scene("ks-cantilever")
    structure, solid = to_structure(scene, elements=10), to_solid(scene, mesh=(50, 2))
    t = np.arange(1, 51) / 50
    results: dict[str, Any] = {}

    def run_beams() -> None:
        results["beams"] = tsm.solve(structure, t)

    def run_solid() -> None:
        results["solid"] = fem_reference.solve(solid, t)

    beams, reference = seconds(run_beams, run_solid)
    times |= {"tsm mixed 10, 50 load parameters": beams, "solid 50x2, 50 load parameters": reference}
    gates.append(Gate("solid 50x2 over TSM mixed 10, seconds", reference / beams, 40, True))
    for name, result in results.items():
        mean = float(np.mean(result.newton_iterations))
        gates.append(Gate(f"Newton iterations per load parameter, {name}", mean, 5, False))
        gates.append(Gate(f"cut-backs, {name}", result.cutbacks, 0, False))


def equal_error(gates: list[Gate], times: dict[str, float]) -> None:
    """The cheapest solid over the cheapest beams at .1 % of the force, each against what it converges to: `crossval trade --quick`."""
    trade = measure_trade(
        load_scene("ks-cantilever"), lambda cases: {case: measure(case) for case in cases}, quick=True
    )
    for scope, state in (("end", "end state"), ("path", "50 load parameters")):
        found = cheapest(trade, scope, "force", 1e-3)
        for point in (found.tsm, found.solid):
            assert point is not None
            times[f"{point.case.label}, .1 % of F, {state}"] = point.measured.seconds
        gates.append(Gate(f"solid over TSM at .1 % of F, {state}, seconds", found.ratio, 100, True))


def scenes_and_elements(gates: list[Gate], times: dict[str, float]) -> None:
    """Double beam against the KS run, and the element without critical area against the paper's, per iteration."""
    ks, both = load_scene("ks-cantilever"), load_scene("double-beam")
    one, two = to_structure(ks, elements=20), to_structure(both, elements=10)
    t, depths = np.arange(1, 51) / 50, np.arange(1, both.load_parameters + 1) / both.load_parameters
    single, double = seconds(lambda: tsm.solve(one, t), lambda: tsm.solve(two, depths))
    times |= {"tsm mixed 20, KS": single, "tsm mixed 10 + 10, double beam": double}
    gates.append(Gate("double beam over KS with 20 elements, seconds", double / single, 4, False))

    actions = []
    for element in ("mixed", "timoshenko"):
        structure = to_structure(ks, elements=20, element=element)
        result = tsm.solve(structure, np.array([0.1]))
        assembler, state = Assembler(result.model), result.equilibria[-1].state

        def iterate(assembler: Assembler = assembler, state: Any = state) -> None:
            for _ in range(200):
                assembler.solve(assembler.linearise(state))

        actions.append(iterate)
    mixed, paper = seconds(*actions)
    times |= {"200 iterations, mixed 20": mixed, "200 iterations, timoshenko 20": paper}
    gates.append(Gate("mixed over timoshenko, seconds per iteration", mixed / paper, 1.3, False))


def iterations(elements: int, **options: Any) -> Callable[[], None]:
    """Action that does 20 iterations of KS at the load parameter 0.1."""
    model = Model(to_structure(load_scene("ks-cantilever"), elements=elements, **options))
    state = tsm.solve(model.structure, np.array([0.1])).equilibria[-1].state
    assembler = Assembler(model)

    def iterate() -> None:
        for _ in range(20):
            assembler.solve(assembler.linearise(state))

    return iterate


def linear_cost(gates: list[Gate], times: dict[str, float]) -> None:
    """Exponent of the cost of one iteration over the elements, largest chord from 200 to 2000."""
    few, many = seconds(*(iterations(elements) for elements in (200, 2000)))
    times |= {"20 iterations, 200 elements": few, "20 iterations, 2000 elements": many}
    gates.append(
        Gate(
            "exponent of the cost per iteration, 200 to 2000 elements",
            float(np.log10(many / few)),
            1.1,
            False,
        )
    )


def many_beams(gates: list[Gate], times: dict[str, float]) -> None:
    """3,000 beams, in chains, rows and frames."""
    for kind, text in MANY.items():
        scene = read_scene(text(3000), "many.toml")
        (spent,) = seconds(lambda scene=scene: solve(scene, "tsm"), repeats=1)
        gates.append(Gate(f"seconds for 3,000 beams, {kind}", spent, 20, False))


def errors(result: tsm.Result) -> tuple[float, float]:
    """Largest errors of contact force (relative) and arc position against the exact rod of KS."""
    local = to_rod(load_scene("ks-cantilever"))
    beam = local.beam
    path = rod_under_pin(local.path, EA=beam.EA, GA=beam.GA, EI=beam.EI, length=beam.length)
    contact = result.contacts["pin->cantilever"]
    F, s = path.magnitude[local.hits], path.arc_position[local.hits]
    return float(np.abs(contact.force / F - 1).max()), float(np.abs(contact.arc_position - s).max())


def exact_element(gates: list[Gate], times: dict[str, float]) -> None:
    """The exact element against `mixed`; the shortest of 15 repeats, which varies less than their median.

    End states are timed eight in a row: a short action meets fewer slow moments than the long one that it is compared with.
    """
    ks, both = load_scene("ks-cantilever"), load_scene("double-beam")
    t, depths = np.arange(1, 51) / 50, np.arange(1, both.load_parameters + 1) / both.load_parameters
    exact, loose = to_structure(ks, elements=1, element="exact"), tsm.Settings(integration_tolerance=1e-6)
    assert max(errors(tsm.solve(exact, t))) <= 1e-8
    assert max(errors(tsm.solve(exact, t, loose))) <= 1e-6
    elements = next(
        n for n in range(2, 100, 2) if max(errors(tsm.solve(to_structure(ks, elements=n), t))) <= 1e-6
    )
    ten, fine = to_structure(ks, elements=10), to_structure(ks, elements=elements)
    path, end, path_loose, mixed, mixed_fine = seconds(
        lambda: tsm.solve(exact, t),
        lambda: [tsm.solve(exact, np.array([1.0])) for _ in range(8)],
        lambda: tsm.solve(exact, t, loose),
        lambda: tsm.solve(ten, t),
        lambda: tsm.solve(fine, t),
        repeats=15,
        of=min,
    )
    times |= {
        "tsm exact 1, 50 load parameters": path,
        "tsm exact 1, end state alone, 8 times": end,
        "tsm exact 1, accuracy 1e-6": path_loose,
        "tsm mixed 10, 50 load parameters (shortest)": mixed,
        f"tsm mixed {elements}, error 1e-6": mixed_fine,
    }
    gates.append(Gate("exact 1 over mixed 10, seconds", path / mixed, 2.5, False))
    gates.append(Gate("exact 1, 50 load parameters over end state, seconds", 8 * path / end, 8, True))
    gates.append(
        Gate(f"mixed {elements} over exact 1 at error 1e-6, seconds", mixed_fine / path_loose, 1, True)
    )

    few, many = seconds(*(iterations(n, element="exact") for n in (100, 1000)), repeats=9, of=min)
    times |= {"20 iterations, exact 100": few, "20 iterations, exact 1000": many}
    exponent = float(np.log10(many / few))
    gates.append(
        Gate("exponent of the cost per iteration, exact, 100 to 1000 elements", exponent, 1.1, False)
    )

    one, two = to_structure(both, elements=1, element="exact"), to_structure(both, elements=10)
    double, closed = seconds(
        lambda: tsm.solve(one, depths), lambda: tsm.solve(two, depths), repeats=5, of=min
    )
    times |= {"tsm exact 1 + 1, double beam": double, "tsm mixed 10 + 10, double beam (shortest)": closed}


def variants(count: int) -> list[tsm.Structure]:
    """KS cantilevers of other lengths, slendernesses, stiffnesses and paths of the pin, 10 `mixed` elements each."""
    rng = np.random.default_rng(0)
    ks = to_structure(load_scene("ks-cantilever"), elements=10)
    (beam,), (pin,), found = ks.beams, ks.pins, []
    for _ in range(count):
        size, slender, stiff = rng.uniform(0.5, 2), rng.uniform(0.5, 1.5), 10 ** rng.uniform(-1, 1)
        (x, y), (dx, dy) = pin.path[0], np.subtract(pin.path[1], pin.path[0]) * rng.uniform(0.95, 1, 2)
        EI = stiff * slender**2 * size**2 * beam.section.EI
        section = tsm.Section(EA=stiff * beam.section.EA, GA=stiff * beam.section.GA, EI=EI)
        start, end = ((size * a, size * b) for a, b in (beam.start, beam.end))
        path = ((size * x, size * y), (size * (x + dx), size * (y + dy)))
        found.append(
            replace(
                ks,
                beams=(replace(beam, start=start, end=end, section=section),),
                pins=(replace(pin, path=path),),
            )
        )
    return found

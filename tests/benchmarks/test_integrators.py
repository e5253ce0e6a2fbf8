"""The explicit integrator of `integrators`: a fair opponent only if its derivative is exact and its answer the same."""

import numpy as np
import pytest

import tsm
from comparisons.models.translate import to_structure
from comparisons.scene import load_scene
from tests.benchmarks import integrators
from tsm.elements import rod

STEP = 1e-30
INPUTS = np.array(
    [[0.3, -1.2, 0.7, 2.0, 1.5, 0.8], [0.1, 0.4, -0.2, 0.0, 0.0, 0.5], [1.0, 2.0, 0.3, -3.0, 0.2, 0.0]]
)


def _run(inputs, starts):
    """Miss, moment at the end and vector of segments whose profile holds `starts`, and their derivatives."""
    kernel = integrators.Explicit(3)
    flexibility = rod.Flexibility(*(np.full((3, 1), value) for value in (0.02, 0.05, 1.3)))
    start, moment, end, nx, ny, length = inputs.T[:, :, None]
    at = rod.Segments(flexibility, np.stack([nx, ny]), length, starts)
    of = kernel.field(at)
    found = kernel.arrival(at, of, start, moment, end)
    gain, *vector = of.sums[:, :, 0] * length[:, 0]
    return np.stack([found.end_residual, moment[:, 0] + gain, *vector], axis=1), kernel.condense(
        at, of, found, moment
    )


def test_derivative_is_exact():
    starts = INPUTS[:, :2]
    transfer = _run(INPUTS, starts)[1].transfer
    for k in range(6):
        inputs = INPUTS.astype(complex)
        inputs[:, k] += STEP * 1j
        by = _run(inputs, inputs[:, :2])[0].imag / STEP
        np.testing.assert_allclose(transfer[:, :, k], by, rtol=0, atol=1e-13)


def test_start_that_is_not_the_chains_is_carried():
    gap = np.array([[1e-3, 2e-3], [-1e-3, 1e-3], [3e-3, 0.0]])
    value, condensed = _run(INPUTS, INPUTS[:, :2] + gap)
    right = _run(INPUTS, INPUTS[:, :2])[0]
    np.testing.assert_allclose(value + condensed.transfer[:, :, 6], right, rtol=0, atol=3e-5)


def test_both_integrators_agree_on_ks():
    structure = to_structure(load_scene("ks-cantilever"), elements=1, element="exact")
    t = np.linspace(0.1, 1, 10)
    with integrators.explicit(8):
        shot = tsm.solve(structure, t).contacts["pin->cantilever"]
    collocated = tsm.solve(structure, t).contacts["pin->cantilever"]
    np.testing.assert_allclose(shot.force, collocated.force, rtol=1e-9)
    assert shot.arc_position == pytest.approx(collocated.arc_position, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "size"), [("explicit", 4), ("explicit", 8), ("gauss", 8), ("gauss", 12), ("gauss", 14)]
)
def test_errors_on_ks(name, size, stated):
    """What 14 nodes leave is near round-off."""
    structure = to_structure(load_scene("ks-cantilever"), elements=1, element="exact")
    with getattr(integrators, name)(size):
        found = integrators.errors(tsm.solve(structure, np.arange(1, 51) / 50))
    stated(f"integrators.{name}-{size}", *found, bound=size == 14)

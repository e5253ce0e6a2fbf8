"""The KS cantilever and its relatives against rods, the statuses with which a path ends, and what a result tells."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import fem_reference as fr
from comparisons.exact import elastica_under_pin
from tests.fem_reference.strips import CLAMP, PAIR, STRIP, B, E, H, held, load, loads, make_problem, rotation
from tests.oracles.elastica import slip_off_height


def test_a_coarse_strip_of_any_length():
    """Three stations: in raw units SciPy warns of an ill-conditioned matrix of their spline."""

    def force(size):
        section = {"height": H * size, "width": H * size, "end": (size, 0.0), "mesh": (2, 1), "element": "Q1"}
        path = ((0.8 * size, 0.0), (0.8 * size, 1e-4 * size))
        result = fr.solve(make_problem(path=path, contact={"penalty": None}, **section), loads(1))
        return result.contacts[PAIR].force[-1] / size**2

    assert force(1e-18) == pytest.approx(force(1.0), rel=1e-8)
    assert force(1e18) == pytest.approx(force(1.0), rel=1e-8)


def test_slender_strip_converges_to_the_elastica():
    """``h/L`` = 1/500: round-off in the residual."""
    elastica = elastica_under_pin([(0.5, 1 / np.pi)])
    result = fr.solve(make_problem(height=0.002, mesh=(200, 1)), loads(20)[4:10:5])
    stiffness = result.model.problem.strips[0].bending_stiffness
    assert result.contacts[PAIR].force[-1] / stiffness == pytest.approx(elastica.magnitude[0], rel=2e-4)
    assert result.contacts[PAIR].arc_position[-1] == pytest.approx(elastica.arc_position[0], rel=1e-4)


def test_slip_off_the_tip_is_at_the_height_of_the_elastica():
    """Pin at 0.8, raised: where an inextensible elastica of length 1 is left."""
    with pytest.raises(fr.SolveError, match="passed the end") as caught:
        fr.solve(make_problem(path=((0.8, 0.0), (0.8, 1.0))), loads(20))
    result = caught.value.result
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached == pytest.approx(slip_off_height(0.8), rel=2e-4)
    assert result.load_parameter[-1] == pytest.approx(0.5)
    assert len(result.contacts[PAIR].force) == len(result.displacement) == 10


def test_one_load_step_follows_a_path_that_turns():
    """The pin leaves the strip on the way up; at the end of its path it could press the strip again."""
    bent = make_problem(path=((0.9, 0.0), (0.9, 0.6), (0.7, 0.2)), mesh=(20, 1))
    one, many = (fr.solve(bent, loads(n), throw=False) for n in (1, 20))
    assert one.status is many.status is fr.Status.LOST_CONTACT
    assert one.reached == pytest.approx(many.reached, abs=1e-5)


@pytest.mark.slow
def test_pin_that_jumps_past_the_clamp_is_not_taken_for_an_open_contact():
    """A KS path drawn on to x = -0.1, where the undeformed strip is not: the contact is followed until it slips."""
    result = fr.solve(make_problem(path=((1.0, 0.0), (-0.1, 0.6366)), mesh=(20, 1)), loads(7), throw=False)
    assert result.status is fr.Status.LOST_CONTACT
    assert result.reached > 0.9
    assert np.all(result.contacts[PAIR].force > 0)


def bent(path=None, **contact):
    return make_problem(path, mesh=(10, 1), contact={"penalty": 1e4} | contact)


def loaded(force=0.0, moment=0.0, **changes):
    """Two or four elements that a load on the free end strains much; the load over E A, or over E I / L."""
    EA, EI = E * B * 0.2, E * B * 0.2**3 / 12
    end = load(at=1.0, force=(-force * EA, 0.0), moment=moment * EI)
    return held(end, clamped=("start",), height=0.2, **changes)


JAM = (0.681, -0.019), (0.291, 0.559), (0.735, 0.173)
"""Path of a pin with which exact rods jam, see `tests/comparisons/exact/test_friction.py`."""
SQUASHED = {"mesh": (2, 1), "material": "biot-linear"}
TRIED = "a set of open, closed, sticking and slipping ones that was tried before (pin->cantilever), after load parameter 0.6928"
CRUSHED = "turned inside out, after load parameter 0.99009"


@pytest.mark.slow_at("jammed", "without a penetration", "crushed")
@pytest.mark.parametrize(
    ("stops", "goes_on", "settings", "said"),
    [
        (bent(penalty=1.0), bent(penalty=100.0), {}, (fr.Status.TOO_DEEP.value, "; raise its penalty")),
        (bent(penalty=1.0), bent(penalty=1.0, penetration=1e-3), {}, ("or state the penetration",)),
        (bent(penalty=1e-3, penetration=1e-12), bent(penetration=1e-12), {"min_step": 0.01}, (fr.Status.AUGMENTATION_LIMIT.value, "; raise its penalty")),
        (bent(JAM, friction=1.086), bent(JAM, friction=0.5), {}, (TRIED, "; it may be jammed: try less friction")),
        (loaded(1.01, **SQUASHED), loaded(0.9, **SQUASHED), {}, (CRUSHED, "; an element is compressed to")),
    ],
    ids=["soft", "without a penetration", "narrow", "jammed", "crushed"],
)  # fmt: skip
def test_a_step_that_grew_too_short_has_a_cause_and_what_is_to_try_helps(stops, goes_on, settings, said):
    """Biot's stress -E is that of an element without length."""
    settings = fr.Settings(branch="primary", **settings)
    result = fr.solve(stops, loads(3), settings, throw=False)
    assert result.status is fr.Status.CUTBACK_FLOOR
    assert all(words in result.message for words in said), result.message
    assert len(result.load_parameter) == len(result.states) < 3
    assert fr.solve(goes_on, loads(3), settings).status is fr.Status.COMPLETED


@pytest.mark.slow
def test_a_smaller_load_tells_the_limit_point_that_steps_were_too_long_for():
    far, near = (fr.solve(loaded(moment=m, mesh=(4, 1)), [1.0], throw=False) for m in (1000.0, 100.0))
    assert "; a critical point may be near: try smaller loads" in far.message
    assert near.status is fr.Status.LIMIT_POINT
    assert near.reached == pytest.approx(10 * far.reached, rel=1e-3)


@pytest.mark.parametrize(
    ("n", "settings", "status", "said"),
    [
        (10, {"max_iterations": 2, "min_step": 0.02}, "CUTBACK_FLOOR", " because Newton's method did not converge within its iteration limit, after"),
        (2, {"max_attempts": 3}, "STEP_LIMIT", " was reached, after load parameter 0."),
    ],
)  # fmt: skip
def test_a_path_that_ends_early_has_a_status_and_keeps_the_accepted_states(n, settings, status, said):
    result = fr.solve(bent(), loads(n), fr.Settings(**settings), throw=False)
    assert result.status is fr.Status[status]
    assert said in result.message
    assert result.cutbacks > 0
    assert len(result.load_parameter) == len(result.states) < n


def test_nodal_stress_is_the_bending_stress():
    """Small deflection by 1e-4: ``M y / I`` on the face, along the strip."""
    Q = rotation(0.9)
    path = tuple(map(tuple, np.array([[0.8, 0.0], [0.8, 1e-4]]) @ Q.T))
    c, s = map(float, Q[:, 0])
    result = fr.solve(make_problem(path=path, end=(c, s)), loads(1))
    xx, yy, xy = fr.nodal_stress(result, 0).T
    along, across = (c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy)
    x, y = (result.mesh_points @ Q).T
    bottom = (np.abs(y + H / 2) < 1e-9) & (x > 0.19) & (x < 0.69)
    expected = 12 * result.contacts[PAIR].force[0] * (0.8 - x[bottom]) * 0.01 / (B * H**3)
    np.testing.assert_allclose(along[bottom], expected, rtol=5e-3)
    assert fr.fibre_stress(result, 0) == pytest.approx(along, abs=2e-3 * np.abs(along).max())
    assert np.abs(across[bottom]).max() < 0.02 * expected.max()


def test_result_has_a_line_columns_and_a_picture():
    ks = fr.solve(make_problem(mesh=(50, 2)), loads(5))
    n = len(ks.mesh_points)
    assert repr(ks).startswith("<Result COMPLETED: 5 load parameters, the last 1; ")
    assert (ks.displacement.shape, ks.unknowns) == ((5, n, 2), 2 * n - 6)
    columns = ks.table()
    assert {values.shape for values in columns.values()} == {(5,)}
    assert columns[f"{PAIR}.force_y"] == pytest.approx(-columns[f"{CLAMP}.force_y"], abs=1e-9)
    assert f"<td>{STRIP}.tip_x</td>" in ks._repr_html_()
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = ks.plot(figure.subplots(), shown=2)
    *_, last = (item.get_paths() for item in axes.collections)
    corners = ks.mesh_cells["quad9"][-1, :4]
    places = ks.mesh_points + ks.displacement[-1]
    assert last[-1].vertices[:-1:2] == pytest.approx(places[corners])

"""Fig. 7a: the cantilever of section 4.1 lifted by a pin from six starting positions until it slips off."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.claims.paper.critical_area import SCENE, STARTS
from comparisons.claims.paper.formulations import FORMULATIONS, Formulation
from comparisons.exact.rod import rod_under_pin
from comparisons.models import ROD, TSM, solve
from comparisons.models.cantilever import to_rod
from comparisons.models.options import Options
from comparisons.response import Array, Response
from comparisons.scene import Scene, load_scene
from comparisons.show import palette
from comparisons.show.plot import EXACT, WIDTH, figure, save

Report = Callable[[str], None]

ELEMENTS = (18, 72)
"""The paper's number of elements, and four times as many."""
COLUMNS = 2
"""Panels beside each other."""
DEPTHS = (0.25, 0.5, 0.75, 1.0)
"""Shapes shown, in parts of the displacement at slip-off: the last load parameter before."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Lift:
    """One starting position.

    Attributes
    ----------
    start : float
        Starting position of the pin [m].
    displacement : ndarray, shape (k,)
        Load parameters with contact, as displacement of the pin [m].
    force, rod_force, arc, rod_arc : ndarray, shape (k,)
        Contact force [N] and arc position [m] of `mixed` with 18 elements and of the exact rod.
    slip_off : dict of float
        Displacement at slip-off [m] by number of elements.
    rod_slip_off : float
        Displacement at slip-off of the exact rod [m].
    reached : dict of float
        Largest displacement [m] at which each formulation with 18 elements still found equilibrium in contact, by
        `tsm.solve` as it is set.
    """

    start: float
    displacement: Array
    force: Array
    rod_force: Array
    arc: Array
    rod_arc: Array
    slip_off: dict[int, float]
    rod_slip_off: float
    reached: dict[str, float]

    @property
    def force_error(self) -> float:
        """Largest error of the contact force, relative to its largest value."""
        return float(np.abs(self.force - self.rod_force).max() / self.rod_force.max())

    def slip_off_error(self, elements: int) -> float:
        """Relative error of the displacement at slip-off."""
        return abs(self.slip_off[elements] / self.rod_slip_off - 1.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Lifts:
    """What Fig. 7a shows; the responses are there to be drawn."""

    lifts: tuple[Lift, ...]
    stopped: tuple[str, ...]
    drawn: tuple[tuple[float, Scene, Response, Response], ...]


def cantilever_shapes(*, quick: bool, report: Report) -> Lifts:
    """Solve the six; `quick` takes two of them with a quarter of the load parameters and without Euler-Bernoulli."""
    lifts, drawn, stopped = [], [], []
    for start in STARTS[::4] if quick else STARTS:
        report(f"pin at {start:g} m")
        scene = load_scene(SCENE)
        scene = replace(scene, pins=(replace(scene.pins[0], start=(start, 0.0)),))
        if quick:
            scene = replace(scene, load_parameters=scene.load_parameters // 4)
        lift, beams, rod = _lift(scene, start, FORMULATIONS[2:] if quick else FORMULATIONS)
        lifts.append(lift)
        drawn.append((start, scene, beams, rod))
        stopped += [
            f"pin at {start:g} m, {one.model}: {one.message}" for one in (beams, rod) if not one.completed
        ]
    return Lifts(lifts=tuple(lifts), stopped=tuple(stopped), drawn=tuple(drawn))


def _lift(scene: Scene, start: float, tried: tuple[Formulation, ...]) -> tuple[Lift, Response, Response]:
    pair = scene.contacts[0].pair
    travel = scene.pins[0].points[1][1]
    runs = {elements: solve(scene, TSM.name, Options(elements=elements)) for elements in ELEMENTS}
    beams, rod = runs[ELEMENTS[0]], solve(scene, ROD.name)
    local = to_rod(scene)
    exact = rod_under_pin(
        local.path[[0, -1]],
        EA=local.beam.EA, GA=local.beam.GA, EI=local.beam.EI, length=local.beam.length,
    )  # fmt: skip
    steps = min(len(beams.load_parameter), len(rod.load_parameter))
    beam_contact, rod_contact = beams.contacts[pair], rod.contacts[pair]
    closed = np.isfinite(beam_contact.arc_position[:steps]) & np.isfinite(rod_contact.arc_position[:steps])
    lift = Lift(
        start=start,
        displacement=travel * beams.load_parameter[:steps][closed],
        force=beam_contact.force[:steps][closed],
        rod_force=rod_contact.force[:steps][closed],
        arc=beam_contact.arc_position[:steps][closed],
        rod_arc=rod_contact.arc_position[:steps][closed],
        slip_off={elements: travel * run.contacts[pair].slip_off for elements, run in runs.items()},
        rod_slip_off=travel * exact.slip_off,
        reached={one.element: travel * _reached(scene, one.element) for one in tried},
    )
    return lift, beams, rod


def _reached(scene: Scene, element: str) -> float:
    """Load parameter up to which the contact was followed: the slip-off, or the end of the run before it."""
    response = solve(scene, TSM.name, Options(element=element))
    contact = response.contacts[scene.contacts[0].pair]
    if np.isfinite(contact.slip_off):
        return contact.slip_off
    return float(response.load_parameter[-1]) if len(response.load_parameter) else 0.0


def plot_lifts(found: Lifts, *paths: Path) -> None:
    """Draw the deformed beams over the exact rod, one panel per starting position."""
    rows = -(-len(found.drawn) // COLUMNS)
    fig = figure(figsize=(WIDTH, 0.8 + 1.5 * rows))
    panels = fig.subplots(rows, min(len(found.drawn), COLUMNS), sharex=True, sharey=True, squeeze=False)
    for axes in panels.flat[len(found.drawn) :]:
        axes.set_axis_off()
    for axes, lift, (start, scene, beams, rod) in zip(panels.flat, found.lifts, found.drawn, strict=False):
        _draw_lift(axes, scene, beams, rod)
        axes.set_title(
            f"pin at {start:g} m: slips off at {lift.slip_off[ELEMENTS[0]]:.4f} m", fontsize="small"
        )
        axes.set_aspect("equal", adjustable="box")
        axes.set_xlim(-0.1, 5.35)
        axes.grid(visible=True, linewidth=0.3)
    for axes in panels[-1]:
        axes.set_xlabel("x [m]")
    for axes in panels[:, 0]:
        axes.set_ylabel("y [m]")
    handles, labels = panels.flat[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=3, fontsize="small", frameon=False)
    save(fig, *paths)


def _draw_lift(axes: Any, scene: Scene, beams: Response, rod: Response) -> None:
    name, contact = scene.beams[0].name, beams.contacts[scene.contacts[0].pair]
    last = int(np.flatnonzero(np.isfinite(contact.arc_position))[-1])
    axes.plot(*np.array([scene.beams[0].start, scene.beams[0].end]).T, color="0.6", linewidth=0.8)
    labels = ["exact rod", f"TSM mixed, {ELEMENTS[0]} elements", "pin, its displacement [m]"]
    for part in DEPTHS:
        k = round(part * last)
        exact, line = rod.axis_line(name, k)[1], beams.axis_line(name, k)[1]
        axes.plot(
            *exact.T, color=palette.BLACK, **{**EXACT, "linewidth": 4.0, "alpha": 0.25}, label=labels[0]
        )
        nodes = {"marker": ".", "markersize": 5, "markevery": (len(line) - 1) // ELEMENTS[0]}
        axes.plot(*line.T, color=FORMULATIONS[-1].color, linewidth=0.9, **nodes, label=labels[1])
        place = scene.pins[0].position(float(beams.load_parameter[k]))
        axes.plot(*place, color=palette.PIN, marker="^", linestyle="none", label=labels[2], zorder=5)
        axes.annotate(f"{place[1]:.2f}", (4.85, line[-1, 1]), fontsize="small", va="center", color="0.25")
        labels = ["_"] * 3

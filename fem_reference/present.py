"""A result in one line, as columns, as HTML and as a picture."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from fem_reference.arrays import Floats

if TYPE_CHECKING:
    from fem_reference.result import Result

SHOWN = 3
"""Load parameters in a picture."""
OUTLINES = {"quad": [0, 1, 2, 3], "quad9": [0, 4, 1, 5, 2, 6, 3, 7]}
"""Nodes around an element in their order, by meshio cell type."""


def line(result: Result) -> str:
    """Return how the solution ended and how far it came."""
    reached = len(result.load_parameter)
    last = f", the last {result.load_parameter[-1]:g}" if reached else ""
    unknowns = f"{result.unknowns} unknowns, {result.newton_iterations.sum()} iterations"
    return f"<Result {result.status.name}: {reached} load parameters{last}; {unknowns}>"


def table(result: Result) -> dict[str, Any]:
    """Return the histories by name, each of shape ``(s,)``: what ``pandas.DataFrame`` takes.

    ``load_parameter``, ``newton_iterations``, ``index``; ``{pin->strip}.force``, ``.force_x``, ``.force_y``, ``.normal_force``,
    ``.tangential_force``, ``.arc_position``, ``.gap``, ``.slip``, ``.dissipated``; ``{strip}.start.force_x``, ``.force_y`` and
    ``.moment`` of each supported end; ``{strip}.tip_x``, ``.tip_y``.
    """
    columns: dict[str, Any] = {"load_parameter": result.load_parameter}
    for pair, contact in result.contacts.items():
        columns[f"{pair}.force"] = contact.force
        columns |= _components(f"{pair}.force", contact.vector)
        for name in ("normal_force", "tangential_force", "arc_position", "gap", "slip", "dissipated"):
            columns[f"{pair}.{name}"] = getattr(contact, name)
    for node, support in result.supports.items():
        columns |= _components(f"{node}.force", support.force)
        columns[f"{node}.moment"] = support.moment
    for strip, tip in result.tips.items():
        columns |= _components(f"{strip}.tip", tip)
    return {**columns, "index": result.index, "newton_iterations": result.newton_iterations}


def _components(name: str, vectors: Floats) -> dict[str, Floats]:
    return {f"{name}_x": vectors[:, 0], f"{name}_y": vectors[:, 1]}


def html(result: Result) -> str:
    """Return the status and the last value of every column as HTML."""
    rows = [
        f"<tr><td>{escape(name)}</td><td>{values[-1]:.6g}</td></tr>"
        for name, values in table(result).items()
        if len(values)
    ]
    heading = escape(f"{result.status.name}: {result.message}")
    return f"<h4>{heading}</h4><table><tbody>{''.join(rows)}</tbody></table>"


def plot(result: Result, axes: Any = None, shown: int = SHOWN) -> Any:
    """Draw the deformed meshes at `shown` of the accepted load parameters, evenly spread, with the pins; needs matplotlib.

    ``axes``: matplotlib's axes; the current ones of pyplot if not given.
    ``shown``: number of load parameters.
    """
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Circle

    if axes is None:
        import matplotlib.pyplot as plt

        axes = plt.gca()
    reached = len(result.load_parameter)
    steps = np.unique(np.linspace(0, reached - 1, shown if reached else 0).round().astype(int))
    for k, colour in [(-1, "0.8"), *((int(k), "C0") for k in steps)]:
        points = result.mesh_points + (result.displacement[k] if k >= 0 else 0.0)
        faint = 0.35 + 0.65 * (k + 1) / reached if k >= 0 else 1.0
        for kind, cells in result.mesh_cells.items():
            outlines = list(points[cells[:, OUTLINES[kind]]])
            faces = PolyCollection(
                outlines, facecolors="none", edgecolors=colour, linewidths=0.4, alpha=faint
            )
            axes.add_collection(faces)
        axes.update_datalim(points)
    for pin in result.model.problem.pins:
        axes.plot(*np.array(pin.path).T, color="0.5", linewidth=0.8, linestyle=":")
        places = [pin.position(float(result.load_parameter[k])) for k in steps]
        for place in places:
            axes.add_patch(Circle((place[0], place[1]), pin.radius, color="black", fill=False))
        axes.plot(*np.array(places).reshape(-1, 2).T, ".", color="black", label=pin.name)
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set(xlabel="x", ylabel="y", title=result.status.name)
    if result.model.problem.pins:
        axes.legend(loc="best", fontsize="small")
    return axes

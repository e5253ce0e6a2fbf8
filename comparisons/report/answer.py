"""One answer: a picture of its shape, section forces and forces, and an engineer's sheet, which fits on one page of paper."""

from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from comparisons.answer import Response
from comparisons.answer.along import peak
from comparisons.answer.page import html, stability
from comparisons.answer.quantities import forces, size
from comparisons.answer.round_off import round_off
from comparisons.answer.table import unit_names
from comparisons.files import write_text
from comparisons.report import palette
from comparisons.report.brief import Brief, across, at_largest, in_units, spring_rate, values_at
from comparisons.report.pages import Section, page
from comparisons.report.pages import picture as image
from comparisons.report.plot import WIDTH, figure, save, tag
from comparisons.report.sketch import ARROW, Sketch, draw
from comparisons.report.symbols import LEFT, at_arcs, axis
from comparisons.scene import Scene
from comparisons.version import release

COLOURS = (palette.BLUE, palette.ORANGE, palette.GREEN, palette.PURPLE, palette.SKY, palette.GREY)
"""Colours of the beams, and of the forces, in turn."""
HEIGHT, DIAGRAM, HISTORY = 3.6, 1.25, 1.9
"""Heights of the shape, of each diagram and of the forces over the load parameter [inch]."""
DIAGRAMS = (("N", "axial", "force"), ("V", "shear", "force"), ("M", "bending", "moment"))


def picture(response: Response, scene: Scene | None = None) -> Any:
    """Return a matplotlib figure: deformed shape at the load parameter with the largest force, section forces along each beam, and the forces.

    A response that was read from a file needs the `scene` that was solved; a `ValueError` says so.
    """
    scene = scene or response.definition
    if scene is None:
        raise ValueError("scene: must be given, the answer was read from a file")
    if not len(response.load_parameter):
        raise ValueError(f"{response.scene}: {response.status}, no load parameter was reached")
    diagrams = DIAGRAMS if response.sections is not None else ()
    heights = (HEIGHT, *(DIAGRAM for _ in diagrams), HISTORY)
    fig = figure(figsize=(WIDTH, sum(heights)))
    shape, *panels, history = fig.subplots(len(heights), 1, height_ratios=heights)
    k = at_largest(response)
    for axes, (name, words, kind) in zip(panels, diagrams, strict=True):
        _diagram(axes, response, scene, name, kind, k)
        axes.set_ylabel(f"{words} {name}\n[{unit_names(scene.units)[kind]}]", fontsize="small")
    for axes in panels[:-1]:
        axes.sharex(panels[-1])
        axes.tick_params(labelbottom=False)
    if panels:
        panels[-1].set_xlabel(f"distance from the start of the beam [{unit_names(scene.units)['length']}]")
        if len(scene.beams) > 1:
            panels[0].legend(loc="best", fontsize="x-small", ncols=len(scene.beams))
    _history(history, response, scene)
    fig.supxlabel(f"tsm-crossval {release()}", fontsize="xx-small", x=0.99, ha="right")
    _shape(shape, response, scene, k)
    return fig


def _shape(axes: Any, response: Response, scene: Scene, k: int) -> None:
    t, lines = float(response.load_parameter[k]), {}
    for beam in scene.beams:
        arcs, line = response.axis_line(beam.name, k)
        tangent = np.gradient(line, axis=0)
        lines[beam.name] = arcs, line, tangent @ LEFT / np.maximum(np.hypot(*tangent.T), 1e-300)[:, None]
    title = f"{scene.name}, {response.named}: {response.status}, load parameter {t:.6g}"
    sketch = Sketch(axes, scene, lines, title, "x-small")
    for colour, beam in zip(cycle(COLOURS), scene.beams):
        (dashed,) = axes.plot(*axis(beam)[1].T, color="0.6", linewidth=0.9, linestyle="--")
        _, drawn = sketch.body(beam, colour, 1.6)
        sketch.legend |= {"undeformed": dashed, beam.name: drawn}
    for pin in scene.pins:
        at = np.array(pin.position(t))
        sketch.disc(at, pin.radius, facecolor=palette.PIN, alpha=0.5)
        (sketch.legend[pin.name],) = axes.plot(*at, ".", color=palette.PIN, markersize=6, zorder=5)
    vectors = {one: response.contacts[one.pair].vector for one in scene.contacts}
    acting = {one: vector[k] for one, vector in vectors.items() if vector is not None and vector[k].any()}
    largest = max((float(np.hypot(*force)) for force in acting.values()), default=0.0)
    for one, force in acting.items():
        tip = at_arcs(response.contacts[one.pair].arc_position[[k]], *lines[one.beam][:2])
        # four significant digits, without an exponent below a million
        words = f"{float(f'{np.hypot(*force):.4g}'):.6g} {sketch.units['force']}"
        sketch.arrows(tip, ARROW * sketch.size / largest * force, words, palette.PIN, 1.3)
        sketch.named("contact force on the beam", palette.PIN, marker=">", markersize=4, linewidth=1.3)
    sketch.loads([(history.load, history.at(t)) for history in scene.load_histories], scene.gravity_at(t))
    sketch.symbols()
    entries = {words.partition(" of ")[0]: entry for words, entry in sketch.legend.items()}
    style = {"fontsize": "x-small", "frameon": False, "labelspacing": 1.2, "loc": "upper center"}
    place = {"bbox_to_anchor": (0.5, -0.17), "ncols": 5 - (len(entries) > 5)}
    axes.legend(entries.values(), entries, **place, **style)
    sketch.separate(1)


def _diagram(axes: Any, response: Response, scene: Scene, name: str, kind: str, k: int) -> None:
    assert response.sections is not None, "diagrams are those of a model that states section forces"
    least = getattr(round_off(response, scene), kind)
    for colour, beam in zip(cycle(COLOURS), scene.beams):
        at = response.sections(beam.name, k)
        values = np.where(np.abs(getattr(at, name)) > least, getattr(at, name), 0.0)
        axes.fill_between(at.arc, values, color=colour, alpha=0.25, linewidth=0.0)
        axes.plot(at.arc, values, color=colour, linewidth=1.2, label=beam.name)
        if values.any():
            value, place = peak(at.arc, values)
            axes.plot(place, value, ".", color=colour, markersize=5)
            way = -1 if place > beam.length / 2 else 1
            side = {"ha": "left" if way > 0 else "right", "va": "center", "fontsize": "x-small"}
            tag(axes, f"{value:.4g}", (place, value), (4 * way, 0), **side)
    axes.axhline(0.0, color="0.3", linewidth=0.6)
    axes.grid(visible=True, linewidth=0.3)
    axes.margins(x=0.01, y=0.15)


def _history(axes: Any, response: Response, scene: Scene) -> None:
    """Draw the forces over the travel of the one moving pin, with its spring rate, or over the load parameter."""
    units, rate = unit_names(scene.units), spring_rate(response, scene)
    words, over = across(scene, response.load_parameter)
    for colour, (name, values) in zip(cycle(COLOURS), forces(response).items()):
        style = {"color": colour, "marker": ".", "markersize": 3, "linewidth": 1.2}
        axes.plot(np.append(0.0, over), np.append(0.0, size(values)), label=name, **style)
    what = "contact force" if response.contacts else "reaction"
    axes.set_xlabel(words)
    axes.set_ylabel(f"{what}\n[{units['force']}]", fontsize="small")
    axes.grid(visible=True, linewidth=0.3)
    axes.set_xlim(left=0.0)
    rated = f"spring rate at first touch {rate:.4g} {units['stiffness']}"
    title = rated if np.isfinite(rate) else ""
    axes.legend(loc="best", fontsize="x-small", title=title, title_fontsize="x-small")


def write_sheet(path: Path, response: Response, scene: Scene) -> None:
    """Write the sheet of an answer as a page of HTML."""
    with TemporaryDirectory() as folder:
        given, found = Path(folder) / "input.svg", Path(folder) / "result.svg"
        draw(scene, given)
        shown, k = "", -1
        if len(response.load_parameter):
            k = at_largest(response)
            save(picture(response, scene), found)
            shown = image(found, "The result, and the section forces with their peaks.")
        beside = image(given, f"The input, in {scene.units}.")
    tables = html(response, k).partition("</table>")[2]  # the head is said above
    section = Section("Result", shown, more=f'<div class="sheet">{tables}</div>', beside=beside)
    write_text(path, page(f"{scene.name}: {response.named}", _brief(response, scene), [section]))


def _brief(response: Response, scene: Scene) -> Brief:
    """Return the largest values, and how far they can be trusted; why a solution stopped that did."""
    judged = response.certificate
    certificate = "Not judged by the referee." if judged is None else judged.line()
    points = [certificate, f"Stability: {stability(response)}."]
    if not len(response.load_parameter):
        return Brief(response.ended, points)
    t = float(response.load_parameter[at_largest(response)])
    said: dict[str, str] = {}  # the first quantity of each unit that acts
    for (words, unit), value in values_at(scene, response, t).items():
        if value:
            number = f"{value:.4g} {unit}".replace(" ", "\N{NO-BREAK SPACE}")
            said.setdefault(unit, f"{words} {number}")
    sentence = f"At load parameter {t:.4g}, where the force is largest: {', '.join(said.values())}."
    if not response.completed:
        points.insert(0, sentence)
        sentence = f"{response.ended}."
    about = "The answer there; moments of supports act on the beam, anticlockwise positive:"
    return Brief(sentence, points, in_units(scene, {response.named: response}, t), about)

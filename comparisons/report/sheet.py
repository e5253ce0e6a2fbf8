"""An engineer's sheet about one answer: what was found, input and result drawn, reactions, extremes and events, on one page of paper."""

from pathlib import Path
from tempfile import TemporaryDirectory

from comparisons.answer import Response
from comparisons.answer.page import html, stability
from comparisons.files import write_text
from comparisons.report.answer import picture as drawn
from comparisons.report.brief import Brief, at_largest, in_units
from comparisons.report.pages import Section, page, picture
from comparisons.report.plot import save
from comparisons.report.sketch import draw
from comparisons.scene import Scene


def write_sheet(path: Path, response: Response, scene: Scene) -> None:
    """Write the sheet of an answer as a page of HTML."""
    with TemporaryDirectory() as folder:
        given, found = Path(folder) / "input.svg", Path(folder) / "result.svg"
        draw(scene, given)
        shown, k = "", -1
        if len(response.load_parameter):
            k = at_largest(response)
            save(drawn(response, scene), found)
            shown = picture(found, "The result, and the section forces with their peaks.")
        beside = picture(given, f"The input, in {scene.units}.")
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
    answer = in_units(scene, {response.named: response}, t)
    said: dict[str, str] = {}  # the first quantity of each unit that acts
    for name, value in map(dict.values, answer):
        words, unit = name.removesuffix("]").split(" [")
        if value != "0":
            number = f"{value} {unit}".replace(" ", "\N{NO-BREAK SPACE}")
            said.setdefault(unit, f"{words} {number}")
    sentence = f"At load parameter {t:.4g}, where the force is largest: {', '.join(said.values())}."
    if not response.completed:
        points.insert(0, sentence)
        sentence = f"{response.ended}."
    about = "The answer there; moments of supports act on the beam, anticlockwise positive:"
    return Brief(sentence, points, answer, about)

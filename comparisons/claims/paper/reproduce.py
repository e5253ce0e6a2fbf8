"""The figures of [P] and the verdicts on its claims, as files and a page."""

from collections.abc import Callable, Sequence
from pathlib import Path

from comparisons.claims.paper.cantilever_shapes import cantilever_shapes
from comparisons.claims.paper.claims import Judgement, claims_text, counted, judged
from comparisons.claims.paper.critical_area import critical_areas
from comparisons.claims.paper.double_beam import double_beam
from comparisons.claims.paper.figure_study import Study
from comparisons.claims.paper.figures import FIGURES
from comparisons.claims.paper.ks_shapes import ks_shapes
from comparisons.files import writable_folder, write_text
from comparisons.output import Report
from comparisons.show.pages import Section, picture, provenance, table, write_page

STUDIES: dict[str, Callable[..., Study]] = {
    "fig7a": cantilever_shapes,
    "fig7b": critical_areas,
    "fig8": ks_shapes,
    "fig9": double_beam,
}
"""How each figure of `FIGURES` is computed."""


def reproduce(name: str, folder: Path, *, quick: bool, report: Report) -> tuple[list[Path], list[str]]:
    """Draw a figure of `FIGURES` or "all" and judge its claims; return the files and what stopped."""
    folder = writable_folder(folder)
    found: dict[str, Study] = {}
    files: list[Path] = []
    for number, figure in enumerate(names := list(FIGURES) if name == "all" else [name], 1):
        report(f"[{number}/{len(names)}] {figure}: {FIGURES[figure]}")
        found[figure] = STUDIES[figure](quick=quick, report=lambda line: report(f"  {line}"))
        files += found[figure].write(figure, folder)
    judgements = judged(found, quick=quick)
    files.append(folder / ("claims.md" if name == "all" else f"claims-{name}.md"))
    write_text(files[-1], claims_text(judgements, quick=quick))
    sections = [_claims(judgements)]
    for figure, study in found.items():
        sections += [_pictures(figure, study, folder), *study.moving]
    scenes = dict.fromkeys(scene for study in found.values() for scene in study.scenes)
    sections += provenance(scenes, files, folder)
    settings = "coarse settings" if quick else "full settings"
    lead = f"{', '.join(found)}: reproduced with {settings}, and the claims that they bear on."
    page = write_page(folder, "The paper's figures and claims", lead, sections)
    stopped = [
        f"{figure}: {one}" for figure, study in found.items() for one in study.numbers.get("stopped", ())
    ]
    return [page, *files], stopped


def _claims(judgements: Sequence[Judgement]) -> Section:
    rows = [
        (number, *one.cells[:3], f"{one.number} ({one.claim.figure})", one.why)
        for number, one in enumerate(judgements, 1)
    ]
    caption = f"{counted(judgements)}. Every number is computed by the run that wrote this page."
    header = ("", "where", "claim", "verdict", "number", "why")
    return Section(title="Claims", html=table(caption, header, rows, prose=True))


def _pictures(figure: str, study: Study, folder: Path) -> Section:
    title = f"{figure}: {FIGURES[figure]}"
    drawn = (picture(folder / f"{stem}.svg", f"{stem}: {FIGURES[figure]}") for stem in study.pictures)
    return Section(title=title, html="\n".join(drawn))

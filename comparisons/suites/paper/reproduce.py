"""The claims of [P], which ``claims.toml`` states, and its figures: verdicts, files and a page."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.output import Report, Row, markdown
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, picture, table
from comparisons.suites.formula import sentence, value_of
from comparisons.suites.found import Found
from comparisons.suites.names import FIGURES
from comparisons.suites.paper.fig7 import cantilever_shapes, critical_areas
from comparisons.suites.paper.fig8 import ks_shapes
from comparisons.suites.paper.fig9 import double_beam
from comparisons.suites.paper.figure import STATED, Numbers, Study

PAPER = (
    "Nizam, Obiya, Ijima, Tokubuchi, Ishibashi, *Effect of Shear Deformation on Convergability of Simple Contact Analysis "
    "with Large Displacement*"
)
STUDIES: dict[str, Callable[..., Study]] = {
    "fig7a": cantilever_shapes, "fig7b": critical_areas, "fig8": ks_shapes, "fig9": double_beam,
}  # fmt: skip
"""How each figure of `FIGURES` is computed."""
COARSE = ("fig7a", "fig7b", "fig8")
"""Figures whose coarse settings bear on their claims: fewer starting positions, tolerances, samples, load parameters or elements."""


class Verdict(StrEnum):
    """What becomes of a claim."""

    REPRODUCED = "reproduced"
    IN_DIRECTION = "reproduced in direction, not in size"
    NOT_REPRODUCED = "not reproduced"
    CANNOT_BE_TOLD = "cannot be told"


CLAIMS: Mapping[str, Row] = STATED["claim"]
"""By the section that makes them first, in the order of the paper; each once, however often the paper makes it."""


def _within(bounds: Mapping[str, tuple[float, float]], numbers: Numbers) -> list[bool | None]:
    """Whether each number lies within its least and greatest value; None where there is none."""
    found = ((np.ravel(value_of(of, **numbers)).tolist(), *limits) for of, limits in bounds.items())
    return [None if one is None else least <= one <= most for values, least, most in found for one in values]


def verdict(readings: Sequence[bool | None], *, in_size: bool = True) -> Verdict:
    """Return whether a claim holds in every reading; None is a reading that this program cannot finish."""
    seen = set(readings)
    if seen == {True}:
        return Verdict.REPRODUCED if in_size else Verdict.IN_DIRECTION
    return Verdict.NOT_REPRODUCED if seen == {False} else Verdict.CANNOT_BE_TOLD


Judgements = Mapping[str, Row]
"""By the claims' names, what a table says: places in [P], what it says at all of them, verdict, number and figure, reason."""


def judged(found: Mapping[str, Numbers], *, quick: bool) -> Judgements:
    """Return the judgements on the claims whose figure was studied, by the numbers of the figures."""
    judgements: dict[str, Row] = {}
    for name, claim in CLAIMS.items():
        if (figure := claim["figure"]) not in found:
            continue
        numbers = found[figure]
        readings, holds, in_size = (
            _within(claim.get(kind, {}), numbers) for kind in ("readings", "holds", "in_size")
        )
        became = verdict(readings or [all(holds)], in_size=all(in_size))
        number, why = (sentence(STATED["macros"] + claim[text], **numbers) for text in ("number", "why"))
        if quick and figure in COARSE:
            why = f"With coarse settings; a full run may decide otherwise. {why}"
        judgements[name] = {
            "": str(len(judgements) + 1),
            "where": "; ".join(place for place, _ in claim["stated"]),
            "claim": " ".join(text for _, text in claim["stated"]),
            "verdict": became,
            "number": f"{number} ({figure})",
            "why": why,
        }
    return judgements


def numbered(judgements: Judgements) -> dict[str, list[str]]:
    """Return the numbers of the claims by their verdict."""
    by = {name: [row[""] for row in judgements.values() if row["verdict"] == name] for name in Verdict}
    return {name: numbers for name, numbers in by.items() if numbers}


def counted(judgements: Judgements) -> str:
    """Return how many claims are judged, and how many have each verdict."""
    summary = "; ".join(f"{len(numbers)} {name}" for name, numbers in numbered(judgements).items())
    statements = sum(len(claim["stated"]) for claim in CLAIMS.values())
    return f"{len(judgements)} of {len(CLAIMS)} claims judged ({statements} statements): {summary}"


def claims_text(judgements: Judgements, *, quick: bool) -> str:
    """Return the verdicts as Markdown."""
    return f"""# The claims of the paper and what became of them

{PAPER}: {counted(judgements)}.

Every number below is computed by the run that wrote this file{", with coarse settings (`--quick`)" if quick else ""}.
Timoshenko, Euler-Bernoulli: the paper's elements with their misprints corrected. Mixed: the element of this project
whose contact force is an unknown. EI/L^2 is the unit of the unbalanced force.

{markdown(list(judgements.values()))}"""


def brief(judgements: Judgements, *, quick: bool) -> Brief:
    """Return how many claims have each verdict, and which are not reproduced, by their numbers."""
    by, coarse = numbered(judgements), " with coarse settings" if quick else ""
    reproduced = len(by.get(Verdict.REPRODUCED, ()))
    said = f"{reproduced} of {len(judgements)} claims of the paper are reproduced{coarse}."
    answer = [{"": name, "claims": len(by[name]), "numbers": ", ".join(by[name])} for name in by]
    points = [f"{name.capitalize()}: {len(by[name])}." for name in by if name != Verdict.REPRODUCED]
    return Brief(said, points, answer, "The verdicts, and the numbers of the claims below:")


def reproduce(name: str, *, quick: bool, report: Report) -> Found:
    """Draw a figure of `FIGURES`, or all of them for another name, and judge its claims."""
    found, names = dict[str, Study](), [name] if name in FIGURES else list(FIGURES)
    for number, figure in enumerate(names, 1):
        report(f"[{number}/{len(names)}] {figure}: {FIGURES[figure]}")
        found[figure] = STUDIES[figure](quick=quick, report=lambda line: report(f"  {line}"))
    judgements = judged({figure: study.numbers for figure, study in found.items()}, quick=quick)
    text = f"claims-{name}.md" if name in FIGURES else "claims.md"
    files: dict[str, Any] = {text: claims_text(judgements, quick=quick)}
    for figure, study in found.items():
        files |= {f"{stem}.csv": rows for stem, rows in study.tables.items()}
        files[f"{figure}.json"] = study.numbers

    def sections(folder: Path) -> Iterator[Section]:
        claims = Section("Claims", table(f"{counted(judgements)}.", list(judgements.values()), prose=True))
        for figure, study in found.items():
            title = FIGURES[figure]
            shown = (picture(folder / f"{stem}.svg", f"{stem}: {title}") for stem in study.pictures)
            yield Section(f"{figure}: {title}", "\n".join(shown))
            yield from (*([claims] if figure == names[0] else ()), *study.moving)

    stops = [f"{figure}: {one}" for figure, of in found.items() for one in of.numbers.get("stopped", ())]
    return Found(
        title="The paper's figures and claims",
        brief=brief(judgements, quick=quick),
        files=files,
        sections=sections,
        pictures={stem: draw for study in found.values() for stem, draw in study.pictures.items()},
        scenes=dict.fromkeys(scene for study in found.values() for scene in study.scenes),
        stopped=stops,
    )

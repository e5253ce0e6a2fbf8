"""Every claim of [P] with its verdict: abstract, sections 4.1 to 4.3, conclusions."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from comparisons.claims.paper import claims_critical_area, claims_examples
from comparisons.claims.paper.figure_study import Study
from comparisons.claims.paper.verdict import STATED, Claim, Judgement, Verdict

PAPER = (
    "Nizam, Obiya, Ijima, Tokubuchi, Ishibashi, *Effect of Shear Deformation on Convergability of Simple Contact Analysis "
    "with Large Displacement*"
)
_ORDER = ("abstract", "4.1", "4.2", "4.3", "conclusion 1", "conclusion 2", "conclusion 3")
_MODULES = (claims_critical_area.__name__, claims_examples.__name__)

CLAIMS: tuple[Claim, ...] = tuple(
    sorted(
        STATED,
        key=lambda one: (
            _ORDER.index(one.stated[0][0].split(",", maxsplit=1)[0]), _MODULES.index(one.judge.__module__)
        ),
    )
)  # fmt: skip
"""By the section that makes them first, in the order of the paper; each once, however often the paper makes it."""
COARSE = ("fig7a", "fig7b", "fig8")
"""Figures whose coarse settings bear on their claims: fewer starting positions, tolerances, samples, load parameters or elements."""


def judged(found: Mapping[str, Study], *, quick: bool) -> list[tuple[Claim, Judgement]]:
    """Return the claims whose figure was studied, with their judgements; coarse settings decide only what does not depend on them."""
    judgements = [(claim, claim.judge(found[claim.figure])) for claim in CLAIMS if claim.figure in found]
    return [
        (claim, _provisional(judgement) if quick and claim.figure in COARSE else judgement)
        for claim, judgement in judgements
    ]


def _provisional(judgement: Judgement) -> Judgement:
    why = f"With coarse settings: {judgement.verdict}. {judgement.why}"
    return replace(judgement, verdict=Verdict.PROVISIONAL, why=why)


def counted(judgements: Sequence[tuple[Claim, Judgement]]) -> str:
    """Return how many claims are judged, and how many have each verdict."""
    counts = Counter(judgement.verdict for _, judgement in judgements)
    summary = "; ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    statements = sum(len(claim.stated) for claim in CLAIMS)
    return f"{len(judgements)} of {len(CLAIMS)} claims judged ({statements} statements){': ' if summary else ''}{summary}"


def claims_text(judgements: Sequence[tuple[Claim, Judgement]], *, quick: bool) -> str:
    """Return the verdicts as Markdown."""
    lines = [
        "# The claims of the paper and what became of them",
        "",
        f"{PAPER}: {counted(judgements)}.",
        "",
        f"Every number below is computed by the run that wrote this file{', with coarse settings (`--quick`)' if quick else ''}.",
        "Timoshenko, Euler-Bernoulli: the paper's elements with their misprints corrected. Mixed: the element of this project",
        "whose contact force is an unknown. EI/L^2 is the unit of the unbalanced force.",
        "",
        "| | where | claim | verdict | number | why |",
        "|---|---|---|---|---|---|",
    ]
    for number, (claim, one) in enumerate(judgements, 1):
        measured = f"{one.number} (`{claim.figure}`)"
        cells = (str(number), claim.source, claim.text, f"**{one.verdict}**", measured, one.why)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"

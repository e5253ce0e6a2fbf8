"""Every claim of [P] with its verdict: abstract, sections 4.1 to 4.3, conclusions."""

from collections import Counter
from dataclasses import dataclass, replace

from comparisons.claims.paper.cantilever_shapes import Lifts
from comparisons.claims.paper.claims_critical_area import CLAIMS as ON_CRITICAL_AREA
from comparisons.claims.paper.claims_examples import CLAIMS as ON_EXAMPLES
from comparisons.claims.paper.critical_area import CriticalAreas
from comparisons.claims.paper.double_beam import DoubleBeam
from comparisons.claims.paper.ks_shapes import Shapes
from comparisons.claims.paper.verdict import Claim, Judgement, Verdict

PAPER = (
    "Nizam, Obiya, Ijima, Tokubuchi, Ishibashi, *Effect of Shear Deformation on Convergability of Simple Contact Analysis "
    "with Large Displacement*"
)
_ORDER = ("abstract", "4.1", "4.2", "4.3", "conclusion 1", "conclusion 2", "conclusion 3")

CLAIMS: tuple[Claim, ...] = tuple(
    sorted(
        (*ON_CRITICAL_AREA, *ON_EXAMPLES),
        key=lambda claim: _ORDER.index(claim.stated[0][0].split(",", maxsplit=1)[0]),
    )
)
"""By the section that makes them first, in the order of the paper; each once, however often the paper makes it."""
COARSE = ("fig7a", "fig7b", "fig8")
"""Figures whose coarse settings bear on their claims: fewer starting positions, tolerances, samples, load parameters or elements."""


@dataclass(frozen=True, kw_only=True)
class Findings:
    """The studies that were run, None for the others, and whether they were run with coarse settings."""

    quick: bool
    fig7a: Lifts | None = None
    fig7b: CriticalAreas | None = None
    fig8: Shapes | None = None
    fig9: DoubleBeam | None = None


def judged(found: Findings) -> list[tuple[Claim, Judgement]]:
    """Return the claims whose study was run, with their judgements; coarse settings decide only what does not depend on them."""
    return [
        (
            claim,
            _provisional(claim.judge(study))
            if found.quick and claim.figure in COARSE
            else claim.judge(study),
        )
        for claim in CLAIMS
        if (study := getattr(found, claim.figure)) is not None
    ]


def _provisional(judgement: Judgement) -> Judgement:
    return replace(
        judgement,
        verdict=Verdict.PROVISIONAL,
        why=f"With coarse settings: {judgement.verdict}. {judgement.why}",
    )


def counted(judgements: list[tuple[Claim, Judgement]]) -> str:
    """Return how many claims are judged, and how many have each verdict."""
    counts = Counter(judgement.verdict for _, judgement in judgements)
    summary = "; ".join(f"{counts[verdict]} {verdict}" for verdict in Verdict if counts[verdict])
    statements = sum(len(claim.stated) for claim in CLAIMS)
    return f"{len(judgements)} of {len(CLAIMS)} claims judged ({statements} statements){': ' if summary else ''}{summary}"


def claims_text(found: Findings) -> str:
    """Return the verdicts as Markdown."""
    judgements = judged(found)
    lines = [
        "# The claims of the paper and what became of them",
        "",
        f"{PAPER}: {counted(judgements)}.",
        "",
        "Every number below is computed by the run that wrote this file"
        + (", with coarse settings (`--quick`)." if found.quick else "."),
        "Timoshenko, Euler-Bernoulli: the paper's elements with their misprints corrected. Mixed: the element of this project",
        "whose contact force is an unknown. EI/L^2 is the unit of the unbalanced force.",
        "",
        "| | where | claim | verdict | number | why |",
        "|---|---|---|---|---|---|",
    ]
    for number, (claim, judgement) in enumerate(judgements, 1):
        cells = (
            claim.source,
            claim.text,
            f"**{judgement.verdict}**",
            judgement.number,
            judgement.why,
            f"`{claim.figure}`",
        )
        where, text, verdict, measured, why, figure = (cell.replace("|", "\\|") for cell in cells)
        lines.append(f"| {number} | {where} | {text} | {verdict} | {measured} ({figure}) | {why} |")
    return "\n".join(lines) + "\n"

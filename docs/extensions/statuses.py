"""How solutions end: the statuses of all models, of checks and certificates, and of cases of a study, with their sentences."""

from enum import Enum

import fem_reference
import tsm
from comparisons.models.cantilever import STOPS
from comparisons.models.outside.child import ProgramStatus
from comparisons.referee import Verdict
from docs.extensions.markdown import table, text

CHECKS = {
    "CHECK_FAILED": "the answer breaks a check of what a completed answer must keep; the message says which",
    "UNSTABLE": "an equilibrium of the answer is unstable, or not on the branch from the undeformed state",
    **{verdict.name: verdict.value for verdict in (Verdict.INADMISSIBLE, Verdict.NOT_AN_EQUILIBRIUM)},
    "CERTIFIED": f"`certify` alone: {Verdict.CERTIFIED.value}",
    "NOT_JUDGED": "`certify` alone: the referee cannot judge the answer",
    "OTHER_BRANCH": "`compare` alone: the answer ends in another equilibrium than the exact rod",
    "ACCURACY_NOT_REACHED": "`solve --accuracy` alone: the estimated error stays above what was asked",
}
"""What the checks, the referee and the commands say of an answer."""
CASES = {
    "REFUSED": "the model cannot state the scene; the message says why",
    "STOPPED": "an adapter of this package: its program stopped before the last load parameter",
    "ERROR": "the case raised an exception, which no model should; a later run tries it again",
    "WORKER_LOST": "the process of the case died, and died again when the case was tried alone; the message says how, and a later run tries it again",
}
"""What a case of a study, and an adapter, can have besides."""


def page() -> str:
    """Return the statuses by where they come from."""
    return (
        "\n\n".join(
            f"### {title}\n\n"
            + table(("status", "meaning"), [(f"`{name}`", text(why)) for name, why in rows.items()])
            for title, rows in (
                ("Beams", _sentences(tsm.Status)),
                ("Solid", _sentences(fem_reference.Status)),
                ("Exact rods", STOPS),
                ("Checks, certificates and commands", CHECKS),
                ("Programs of others", _sentences(ProgramStatus)),
                ("Cases and adapters", CASES),
            )
        )
        + "\n"
    )


def _sentences(kind: type[Enum]) -> dict[str, str]:
    return {one.name: one.value for one in kind}

"""The page of a comparison."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from comparisons.budget import Budget
from comparisons.cases import Row
from comparisons.models import ROD
from comparisons.models.options import Options
from comparisons.scene import Scene
from comparisons.show.budget_plot import budget_section
from comparisons.show.findings import findings
from comparisons.show.pages import (
    Section,
    motion_section,
    picture,
    provenance,
    states_section,
    table,
    tracks,
    write_page,
)
from comparisons.show.table import cells, header

EXACT = ROD.run_label(Options())
"""Label of the run of the exact rod, to which all others are compared."""
ERRORS = (
    f"Largest error over all load parameters against the {EXACT}; forces and moments over their largest, positions "
    "over the length, friction over the contact forces. Newton iterations and wall seconds of the whole path."
)


def write_comparison_page(
    scene: Scene,
    rows: Sequence[Row],
    budget: Budget | None,
    files: Sequence[Path],
    series: Mapping[str, Path],
    folder: Path,
    left_out: Mapping[str, str],
) -> Path:
    """Write ``report.html`` to `folder` and return its path.

    `files` are what else the comparison wrote, `series` the exported series of VTU files by the label of the
    run, and `left_out` the reasons that `findings` takes.
    """
    responses = {row.label: row.response for row in rows}
    vtu = {
        label: f"{path.parent.relative_to(folder).as_posix()}/{path.stem}-{{}}.vtm"
        for label, path in series.items()
    }
    shown, states = tracks(responses, EXACT, scene), states_section(responses)
    sections = [
        Section(title="Errors", html=table(ERRORS, header(), map(cells, rows))),
        motion_section("Shapes and histories", scene, responses, shown, focus=EXACT, vtu=vtu),
    ]
    if states is not None:
        sections.append(states)
    if budget is not None:
        sections.append(budget_section(budget, folder / "budget.svg"))
    stress = folder / "side-by-side.png"
    if stress in files:
        sections.append(Section(title="Stress", html=picture(stress, "Beams and solid, von Mises stress.")))
    sections += provenance([scene], files, folder)
    lead = " ".join(findings(scene, rows, EXACT, budget, left_out))
    return write_page(folder, f"{scene.name}: beams, solid and exact answers", lead, sections)

"""The page of the reproduced figures and claims."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from comparisons.claims.paper.claims import Findings, counted, judged
from comparisons.claims.paper.double_beam import DoubleBeam
from comparisons.claims.paper.double_beam_plot import NAMES
from comparisons.claims.paper.figures import FIGURES
from comparisons.claims.paper.ks_shapes import READINGS, Shapes
from comparisons.compare import ROD
from comparisons.scene import Scene
from comparisons.show.pages import (
    Section,
    Track,
    motion_section,
    picture,
    provenance,
    table,
    tracks,
    write_page,
)

BEAMS, RODS = "TSM mixed, 10 elements a beam", "exact rods, coupled"
"""The runs of the double beam."""


def write_reproduced_page(found: Findings, files: Sequence[Path], folder: Path) -> Path:
    """Write ``report.html`` to `folder`, with what is in `files` there; return its path."""
    shown = [name for name in FIGURES if getattr(found, name) is not None]
    sections = [_claims(found)]
    for name in shown:
        sections.append(_pictures(name, files))
        sections += _moving(found, name)
    sections += provenance(_scenes(found), files, folder)
    settings = "coarse settings" if found.quick else "full settings"
    lead = f"{', '.join(shown)}: reproduced with {settings}, and the claims that they bear on."
    return write_page(folder, "The paper's figures and claims", lead, sections)


def _claims(found: Findings) -> Section:
    judgements = judged(found)
    rows = (
        (
            number,
            claim.source,
            claim.text,
            judgement.verdict,
            f"{judgement.number} ({claim.figure})",
            judgement.why,
        )
        for number, (claim, judgement) in enumerate(judgements, 1)
    )
    return Section(
        title="Claims",
        html=table(
            f"{counted(judgements)}. Every number is computed by the run that wrote this page.",
            ("", "where", "claim", "verdict", "number", "why"),
            rows,
            prose=True,
        ),
    )


def _pictures(name: str, files: Sequence[Path]) -> Section:
    drawn = [path for path in files if path.suffix == ".svg" and path.stem.split("-")[0] == name]
    return Section(
        title=f"{name}: {FIGURES[name]}",
        html="\n".join(picture(path, f"{path.stem}: {FIGURES[name]}") for path in drawn),
    )


def _moving(found: Findings, name: str) -> Iterator[Section]:
    if name == "fig8" and found.fig8 is not None:
        yield from _readings(found.fig8)
    if name == "fig9" and found.fig9 is not None:
        yield _double_beam(found.fig9)


def _readings(found: Shapes) -> Iterator[Section]:
    """Yield a section for every reading of the scene, with the runs that followed the exact rod."""
    for name, (scene, responses) in found.drawn.items():
        followed = {label: one for label, one in responses.items() if found.run(name, label).follows}
        if ROD.label in followed:
            histories = tracks(followed, ROD.label, scene)
            yield motion_section(
                f"{name}: {READINGS.get(name, name)}", scene, followed, histories, focus=ROD.label
            )


def _double_beam(found: DoubleBeam) -> Section:
    histories = [track for pair in found.histories for track in _pair_tracks(found, pair)]
    return motion_section(
        "Double beam: shapes and histories", found.scene, {BEAMS: found.response}, histories, focus=BEAMS
    )


def _pair_tracks(found: DoubleBeam, pair: str) -> Iterator[Track]:
    one = found.histories[pair]
    for title, unit, beams, exact in (
        ("force", "N", one.force, one.exact_force),
        ("arc position", "m", one.arc, one.exact_arc),
    ):
        if np.isfinite(beams).any():
            yield Track(title=f"{title}, {NAMES[pair]}", unit=unit, values={BEAMS: beams, RODS: exact})


def _scenes(found: Findings) -> list[Scene]:
    """Return the scenes of the figures that were run, each once."""
    scenes: list[Scene] = []
    if found.fig7a is not None:
        scenes += [scene for _, scene, _, _ in found.fig7a.drawn]
    if found.fig8 is not None:
        scenes += [scene for scene, _ in found.fig8.drawn.values()]
    if found.fig9 is not None:
        scenes.append(found.fig9.scene)
    return list(dict.fromkeys(scenes))

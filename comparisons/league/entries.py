"""The entries of the league: which cases are run, and what each measured."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from comparisons.cases import Case, Measurement
from comparisons.cases.run import Progress, run
from comparisons.cases.workers import Workers
from comparisons.errors import error_histories, largest
from comparisons.models import MODELS, ROD, Model, find
from comparisons.models.options import Options
from comparisons.output import Row
from comparisons.response import Response
from comparisons.scene import Scene

MOST = 5
"""Largest number of resolutions of a program."""
QUANTITIES = ("force", "arc", "moment", "tip", "friction")
"""The quantities whose errors are stated."""


@dataclass(frozen=True, kw_only=True)
class Entry:
    """One program at one resolution on one scene.

    Attributes
    ----------
    case : Case
        What was run.
    program : str
        The model with its element, such as ``TSM mixed``.
    measured : Measurement
        Answer and cost.
    errors : dict of float
        Largest errors against the exact rods over the load parameters that both reached, by the names of `QUANTITIES`.
    """

    case: Case
    program: str
    measured: Measurement
    errors: dict[str, float]

    @property
    def outcome(self) -> str:
        """``certified``, ``wrong`` for a refused answer that the program reported as a success, or the status of a stop."""
        if self.measured.wrong:
            return "wrong"
        response = self.measured.response
        return (
            (self.measured.verdict.lower().replace("_", " ") or "no verdict")
            if response.completed
            else response.status
        )

    def row(self) -> Row:
        """Return the entry as a row of the table."""
        response = self.measured.response
        return {
            "scene": self.case.scene.name,
            "program": self.program,
            "setting": self.case.label,
            "outcome": self.outcome,
            **{f"error_{name}": self.errors[name] for name in QUANTITIES},
            "seconds": self.measured.seconds,
            "process_seconds": self.measured.process_seconds,
            "unknowns": response.unknowns,
            "load_parameters_reached": len(response.load_parameter),
            "status": response.status,
            "verdict": self.measured.verdict,
            "said_success_and_was_wrong": self.measured.wrong,
            "message": response.message,
        }


@dataclass(frozen=True, kw_only=True)
class League:
    """The entries of all scenes, and what was left out.

    Attributes
    ----------
    scenes : tuple of Scene
        The scenes.
    entries : list of Entry
        In the order of scenes and programs.
    left_out : list of (str, str, str)
        Scene, program, and the reason why the program cannot state the scene.
    stopped : dict of str
        Reason why the exact rods did not complete, by scene; errors are then measured as far as they came.
    """

    scenes: tuple[Scene, ...]
    entries: list[Entry]
    left_out: list[tuple[str, str, str]] = field(default_factory=list)
    stopped: dict[str, str] = field(default_factory=dict)

    @property
    def programs(self) -> list[str]:
        """The programs in the order of the models."""
        return list(dict.fromkeys(entry.program for entry in self.entries))

    def of(self, scene: str, program: str) -> list[Entry]:
        """Return the entries of one program on one scene, coarse to fine."""
        return [one for one in self.entries if (one.case.scene.name, one.program) == (scene, program)]


def measure_league(
    scenes: Sequence[Scene],
    programs: Sequence[str],
    folder: Path,
    workers: Workers,
    *,
    quick: bool = False,
    progress: Progress = lambda _: None,
) -> League:
    """Run every program on every scene that it can state; what `folder` has of this version is not run again.

    Parameters
    ----------
    scenes : sequence of Scene
        The scenes.
    programs : sequence of str
        Names for `comparisons.models.find` of models beside those of this package.
    folder : Path
        Folder of the results.
    workers : Workers
        Where cases run.
    quick : bool
        At most two resolutions of every program.
    progress : callable
        Receives the progress.

    Raises
    ------
    ModelError
        If there is no such program.
    """
    models = [(name, MODELS[name]) for name in MODELS if name != ROD.name] + [
        (name, find(name)) for name in programs
    ]
    references = {scene.name: Case(scene=scene, model=ROD.name) for scene in scenes}
    cases: list[tuple[Case, str]] = []
    left_out: list[tuple[str, str, str]] = []
    for scene in scenes:
        for name, model in models:
            reason = model.refusal(scene)
            if reason is None:
                cases += _cases(scene, name, model, quick=quick)
            else:
                left_out.append((scene.name, model.label, reason))
    every = [*references.values(), *(case for case, _ in cases)]
    found = run(every, folder, workers, progress=progress, process=True)
    exact = {name: found[case].response for name, case in references.items()}
    return League(
        scenes=tuple(scenes),
        entries=[
            Entry(case=case, program=program, measured=found[case],
                  errors=_errors(found[case].response, exact[case.scene.name], case.scene))
            for case, program in cases
        ],
        left_out=left_out,
        stopped={name: response.message for name, response in exact.items() if not response.completed},
    )  # fmt: skip


def _cases(scene: Scene, name: str, model: Model, *, quick: bool) -> Iterator[tuple[Case, str]]:
    """Yield the cases of a model with the names of their programs, at most `MOST` resolutions of each, coarse to fine."""
    families: dict[str, list[Options]] = {}
    for options in model.resolutions(quick=False):
        families.setdefault(model.family(scene, options), []).append(options)
    for family, settings in families.items():
        most = min(2 if quick else MOST, len(settings))
        for k in dict.fromkeys(np.linspace(0, len(settings) - 1, most).round().astype(int)):
            yield Case(scene=scene, model=name, options=settings[k]), family


def _errors(response: Response, exact: Response, scene: Scene) -> dict[str, float]:
    """Return the largest errors over the shared load parameters; nan without any."""
    shared = np.intersect1d(response.load_parameter, exact.load_parameter)
    if not len(shared):
        return dict.fromkeys(QUANTITIES, np.nan)
    _, found = error_histories(response, exact, scene, quantities=QUANTITIES)
    return {name: largest(values) for name, values in found.items()}

"""The records of the verification manual: what is asked, what a model answers, how that is judged."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from comparisons.response import Array


class StoppedError(RuntimeError):
    """A solution that stopped before it had an answer: its status and sentence."""


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """What is compared.

    Attributes
    ----------
    name : str
        With its unit, or without one where it is dimensionless.
    exact : float
        The exact value.
    scale : float, optional
        What an error is divided by, the magnitude of the exact value if not given.
    """

    name: str
    exact: float
    scale: float | None = None

    def error(self, value: float) -> float:
        """Return ``|value - exact| / scale``."""
        return abs(value - self.exact) / (abs(self.exact) if self.scale is None else self.scale)


@dataclass(frozen=True, kw_only=True, eq=False)
class Curve:
    """A line of a picture.

    Attributes
    ----------
    style : str
        Key of `comparisons.claims.manual.pictures.STYLES`, which also is its label.
    points : ndarray, shape (n, 2)
        Rows of nan part it into pieces.
    """

    style: str
    points: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Picture:
    """The picture of a case but for what the models add.

    Attributes
    ----------
    axes : (str, str)
        Labels of the axes.
    curves : tuple of Curve
        What is drawn whatever the models answer.
    logarithmic : bool
        Whether both axes are.
    shape : bool
        Whether both axes are lengths and have one scale.
    """

    axes: tuple[str, str] = ("x [m]", "y [m]")
    curves: tuple[Curve, ...] = ()
    logarithmic: bool = False
    shape: bool = True


@dataclass(frozen=True, kw_only=True, eq=False)
class Answer:
    """What a model answers: a value for every quantity of the problem, and its curves."""

    values: tuple[float, ...]
    curves: tuple[Curve, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A model that is put to a problem.

    Attributes
    ----------
    model : str
        Key of `comparisons.claims.manual.pictures.STYLES`.
    setting : str
        Its resolution.
    tolerance : float
        Largest error allowed to any quantity.
    reason : str
        Where the tolerance comes from.
    measure : callable
        Solves; raises `StoppedError` where there is no answer.
    """

    model: str
    setting: str
    tolerance: float
    reason: str
    measure: Callable[[], Answer]


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A problem with an exact answer.

    Attributes
    ----------
    name, title : str
        A short name without spaces, and a title.
    statement : str
        The problem with its sizes and units.
    source : str
        Where the exact value comes from: literature with author and year, or the closed form.
    quantities : tuple of Quantity
        What is compared.
    trials : tuple of Trial
        The models.
    picture : Picture
        What is drawn.
    """

    name: str
    title: str
    statement: str
    source: str
    quantities: tuple[Quantity, ...]
    trials: tuple[Trial, ...]
    picture: Picture


@dataclass(frozen=True, kw_only=True)
class Run:
    """What became of a trial.

    Attributes
    ----------
    model, setting, tolerance, reason
        Of the `Trial`.
    values, errors : tuple of float
        One for every quantity; nan where the solution stopped.
    seconds : float
        Wall time, everything included.
    stopped : str
        Why there is no answer, empty if there is one.
    """

    model: str
    setting: str
    tolerance: float
    reason: str
    values: tuple[float, ...]
    errors: tuple[float, ...]
    seconds: float
    stopped: str = ""

    @property
    def label(self) -> str:
        """Model and setting."""
        return f"{self.model}, {self.setting}" if self.setting else self.model

    @property
    def passed(self) -> bool:
        """Whether every error is within the tolerance; what is not a number is not."""
        return not self.stopped and all(error <= self.tolerance for error in self.errors)

    @property
    def worst(self) -> int:
        """Number of the quantity with the largest error, of the first that is not a number if one is not."""
        return max(
            range(len(self.errors)),
            key=lambda k: math.inf if math.isnan(self.errors[k]) else self.errors[k],
        )


@dataclass(frozen=True, kw_only=True)
class Case:
    """A problem and what all models answered.

    Attributes
    ----------
    name, title, statement, source, quantities
        Of the `Problem`.
    runs : tuple of Run
        One for every model.
    picture : str
        Name of the picture's file.
    """

    name: str
    title: str
    statement: str
    source: str
    quantities: tuple[Quantity, ...]
    runs: tuple[Run, ...]
    picture: str

    @property
    def passed(self) -> bool:
        """Whether every model passed."""
        return all(run.passed for run in self.runs)

    @property
    def seconds(self) -> float:
        """Wall time of all models."""
        return sum(run.seconds for run in self.runs)


@dataclass(frozen=True, kw_only=True)
class Manual:
    """The verification manual.

    Attributes
    ----------
    cases : tuple of Case
        In the order of the manual.
    files : tuple of Path
        What was written, the text first.
    """

    cases: tuple[Case, ...]
    files: tuple[Path, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every case passed."""
        return all(case.passed for case in self.cases)

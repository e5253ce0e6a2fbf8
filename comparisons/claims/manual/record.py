"""The records of the verification manual: problems, the models that are put to them, and their pictures."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from comparisons.claims.claim import Allowance, Judgement, Quantity
from comparisons.response import Array
from comparisons.scene import Scene


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
class Measured:
    """A value for every quantity of a problem, and the curves that a model adds to the picture."""

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
    allowance : Allowance
        Allowed error of every quantity.
    measure : callable
        Solves the problem's scene, or what follows from it; raises `StoppedError` where there is no answer.
    """

    model: str
    setting: str
    allowance: Allowance
    measure: Callable[[Scene], Measured]

    @property
    def label(self) -> str:
        """Model and setting."""
        return f"{self.model}, {self.setting}" if self.setting else self.model


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A problem with an exact answer.

    Attributes
    ----------
    name, title : str
        A short name without spaces, and a title.
    purpose : str
        What a wrong answer would show.
    statement : str
        The problem with its sizes and units.
    source : str
        Where the exact value comes from: literature with author and year, or the closed form.
    uncertainty : float
        Bound of the error of the exact values, over their scales.
    scene : Scene
        What is solved, or what the scenes that are solved follow from.
    quantities : tuple of Quantity
        What is compared.
    trials : tuple of Trial
        The models.
    picture : Picture
        What is drawn.
    """

    name: str
    title: str
    purpose: str
    statement: str
    source: str
    uncertainty: float
    scene: Scene
    quantities: tuple[Quantity, ...]
    trials: tuple[Trial, ...]
    picture: Picture


@dataclass(frozen=True, kw_only=True)
class Case:
    """A problem and what all models answered.

    Attributes
    ----------
    problem : Problem
        The problem.
    judgements : tuple of Judgement
        One for every model.
    picture : str
        Name of the picture's file.
    """

    problem: Problem
    judgements: tuple[Judgement, ...]
    picture: str

    @property
    def passed(self) -> bool:
        """Whether every model passed."""
        return all(item.passed for item in self.judgements)

    @property
    def seconds(self) -> float:
        """Wall time of all models."""
        return sum(item.seconds for item in self.judgements)


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

"""The problems of the verification manual: each is one TOML file of the folder ``problems``."""

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from comparisons.answer import Array
from comparisons.models.options import Options
from comparisons.scene import InputError, Scene, built_in_scenes, load_scene, read_scene
from comparisons.suite.settings import changed
from comparisons.suites.finding import Finding

FOLDER = Path(__file__).parent / "problems"
ORDER = (
    "dead-load", "roll-up", "euler-column", "haringx-column", "post-buckling", "clamped-column", "pinned-column", "lees-frame",
    "williams-toggle", "portal-frame", "short-cantilever", "ks-elastica", "elastica-identity", "force-limit", "three-point-bending",
    "slip-off", "ks-axis", "ks-face", "ks-biot", "ks-tied-tip", "slip-off-in-shear", "double-beam", "two-pins", "crossed-beams",
    "touch-again", "ks-friction-elastica", "ks-friction", "three-point-friction", "hysteresis", "sleeve", "mixed-order",
    "timoshenko-order", "thin-strips", "penalty-slope", "locking", "energy-balance", "objectivity", "mirror", "reversal",
)  # fmt: skip
"""The problems in the order of the manual; those that are not named follow by name."""
Line = tuple[str, Array]
"""A line of a picture: its style, which also is its label, and its points, shape (n, 2)."""
Changes = Mapping[str, Any]
"""New values of a scene's settings by the names of a study file, ``contact.friction``."""


@dataclass(frozen=True, kw_only=True)
class Picture:
    """What is drawn."""

    axes: Sequence[str] = ()  #: Labels of the axes, by default places.
    shown: Sequence[float] = (1.0,)  #: Load parameters whose deflected axes are drawn.
    exact: str = ""  #: A model whose answer is the exact one.
    guide: Sequence[float] = ()  #: Order and first value of a line for the eye, on logarithmic axes.


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A number with its exact value, and where an answer has it."""

    name: str = ""  #: With the unit, unless the quantity is dimensionless.
    exact: float = math.nan
    scale: float | None = None  #: What its error is divided by, the magnitude of the exact value if None.
    read: str = ""  #: The words of `comparisons.suites.manual.measures.value`; empty where a measure finds the number.
    at: float = 1.0  #: A load parameter.
    times: float = 1.0  #: A factor.
    changes: Changes = field(default_factory=dict)  #: What is changed in the scene.
    since: float | None = None  #: A load parameter; what the quantity is there is taken away.
    over: "Quantity | None" = None  #: What it is divided by.

    @property
    def size(self) -> float:
        """What its error is divided by."""
        return abs(self.exact) if self.scale is None else self.scale


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A model that is put to a problem."""

    model: str  #: Model with its element.
    setting: str  #: Resolution.
    key: str  #: Name of the model for `comparisons.models.solve`.
    options: Options
    scene: Scene  #: What the model solves.
    allowed: float  #: Allowed error of every quantity.
    why: str  #: The reason of this bound.

    @property
    def label(self) -> str:
        """Model and setting."""
        return f"{self.model}, {self.setting}" if self.setting else self.model


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A problem with an exact answer."""

    name: str  #: A short name without spaces.
    title: str
    purpose: str  #: What a wrong answer would show.
    statement: str  #: The problem with its sizes and units.
    source: str  #: Where the exact value comes from: literature with author and year, or the closed form.
    uncertainty: float  #: Bound of the error of the exact values, over their scales.
    scene: Scene  #: What is solved, or what the scenes that are solved follow from.
    quantities: tuple[Quantity, ...]  #: What is compared.
    trials: tuple[Trial, ...]  #: The models.
    picture: Picture
    #: Name of a function of `comparisons.suites.manual.measures` that finds the values; by default they are read from the answer.
    measure: str = "readings"
    settings: Mapping[str, Any] = field(default_factory=dict)  #: What this function takes.


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """The answer of a model: its findings, one for each quantity, and wall time [s]; `stopped` says why there is no answer."""

    trial: Trial
    findings: tuple[Finding, ...]
    seconds: float
    stopped: str = ""

    @property
    def passed(self) -> bool:
        """Whether every error is within what is allowed."""
        return all(one.holds for one in self.findings)

    @property
    def worst(self) -> Finding:
        """The finding with the largest error, the first that is not a number if one is not."""
        return max(self.findings, key=lambda one: one.share)

    @property
    def failure(self) -> str | None:
        """Why the answer fails, with its numbers; None if it is right."""
        return self.stopped or (None if self.passed else self.worst.failure)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A problem, the judgement on every model, and the lines that the answers add to its picture."""

    problem: Problem
    judgements: tuple[Judgement, ...]
    lines: tuple[Line, ...]

    @property
    def passed(self) -> bool:
        """Whether every model passed."""
        return all(item.passed for item in self.judgements)

    @property
    def seconds(self) -> float:
        """Wall time of all models."""
        return sum(item.seconds for item in self.judgements)

    @property
    def picture(self) -> str:
        """Name of the picture's file."""
        return f"{self.problem.name}.svg"


def read_problem(path: Path) -> Problem:
    """Return the problem that a TOML file states; its keys are the attributes of `Problem`, and its name is the file's.

    ``scene`` is a built-in scene, with ``changes`` if any, or the text of a scene file. A row of ``trials`` has the model and its
    element, ``elements`` or ``mesh``, ``allowed`` and ``why``, and ``scene`` and ``changes`` if it solves another scene than the problem's.
    """
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    scene = _scene(table.pop("scene"), table.pop("changes", {}), path)
    return Problem(
        name=path.stem,
        scene=scene,
        quantities=tuple(map(_quantity, table.pop("quantities"))),
        trials=tuple(_trial(row, scene, path) for row in table.pop("trials")),
        picture=Picture(**table.pop("picture", {})),
        **table,
    )


def _quantity(row: dict[str, Any]) -> Quantity:
    return Quantity(**row | {"over": _quantity(row["over"])} if "over" in row else row)


def _scene(stated: str, changes: Changes, path: Path) -> Scene:
    scene = load_scene(stated) if stated in built_in_scenes() else read_scene(stated, path.name)
    return varied(scene, changes)


def varied(scene: Scene, changes: Changes) -> Scene:
    """Return a scene with changed settings."""
    return changed(scene, {tuple(key.split(".")): value for key, value in changes.items()})


def _trial(row: dict[str, Any], scene: Scene, path: Path) -> Trial:
    key, _, element = row["model"].partition(" ")
    elements, mesh, changes = row.pop("elements", None), row.pop("mesh", None), row.pop("changes", {})
    beams = f"{elements} elements a beam" if elements else "1 element a beam" if element else ""
    strip: Any = tuple(map(int, mesh.split("x"))) if mesh else None
    row.setdefault("setting", f"{mesh} elements" if mesh else beams)
    own = _scene(row.pop("scene"), changes, path) if "scene" in row else varied(scene, changes)
    options = Options(element=element or None, elements=elements, mesh=strip)
    return Trial(key=key, options=options, scene=own, **row)


def problems(names: Sequence[str] | None = None, folder: Path = FOLDER) -> list[Path]:
    """Return the files of the problems of a folder with some names, of all where none are given, in the order of the manual.

    Raises
    ------
    InputError
        For a name that no problem has.
    """
    files = {path.stem: path for path in sorted(folder.glob("*.toml"))}
    known = [name for name in ORDER if name in files] + [name for name in files if name not in ORDER]
    for name in names or ():
        if name not in files:
            raise InputError(name, f"no such problem ({', '.join(known)})")
    return [files[name] for name in known if names is None or name in names]

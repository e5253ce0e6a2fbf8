"""The problems of the verification manual: each is one TOML file of the folder ``problems``."""

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from comparisons.cases.settings import changed
from comparisons.claims.claim import Allowance, Judgement, Quantity
from comparisons.models.options import Options
from comparisons.scene import InputError, Scene, built_in_scenes, load_scene, read_scene

FOLDER = Path(__file__).parent / "problems"
ORDER = (
    "dead-load", "roll-up", "euler-column", "haringx-column", "post-buckling", "clamped-column", "pinned-column", "lees-frame",
    "williams-toggle", "portal-frame", "short-cantilever", "ks-elastica", "elastica-identity", "force-limit", "three-point-bending",
    "slip-off", "ks-axis", "ks-face", "ks-biot", "ks-tied-tip", "slip-off-in-shear", "double-beam", "two-pins", "crossed-beams",
    "touch-again", "ks-friction-elastica", "ks-friction", "three-point-friction", "hysteresis", "sleeve", "mixed-order",
    "timoshenko-order", "thin-strips", "penalty-slope", "locking", "energy-balance", "objectivity", "mirror", "reversal",
)  # fmt: skip
"""The problems in the order of the manual; those that are not named follow by name."""
Changes = Mapping[str, Any]
"""New values of a scene's settings by the names of a study file, ``contact.friction``."""


@dataclass(frozen=True, kw_only=True)
class Picture:
    """The picture of a problem: labels of the axes, by default places; load parameters whose axes are drawn; a model whose answer is the exact one.

    `guide` is the order of a line for the eye and its first value, where both axes are logarithmic.
    """

    axes: Sequence[str] = ()
    shown: Sequence[float] = (1.0,)
    exact: str = ""
    guide: Sequence[float] = ()


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Where an answer has a quantity: its words, as `answers.value` takes them, a load parameter, a factor, and changes of the scene.

    What it is at the load parameter `since` is taken away, and it is divided by what is `over` which it stands.
    """

    words: str = ""
    at: float = 1.0
    times: float = 1.0
    changes: Changes = field(default_factory=dict)
    since: float | None = None
    over: "Reading | None" = None


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A model that is put to a problem.

    Attributes
    ----------
    model, setting : str
        Model with its element, and resolution.
    key, options
        For `comparisons.models.solve`.
    scene : Scene
        What the model solves.
    allowance : Allowance
        Allowed error of every quantity.
    """

    model: str
    setting: str
    key: str
    options: Options
    scene: Scene
    allowance: Allowance

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
    quantities, readings : tuple
        What is compared, and where an answer has it.
    trials : tuple of Trial
        The models.
    picture : Picture
        What is drawn.
    measure : str
        Name of a function of `comparisons.claims.manual.measures` that finds the values; by default they are read from the answer.
    settings : mapping
        For that function.
    """

    name: str
    title: str
    purpose: str
    statement: str
    source: str
    uncertainty: float
    scene: Scene
    quantities: tuple[Quantity, ...]
    readings: tuple[Reading, ...]
    trials: tuple[Trial, ...]
    picture: Picture
    measure: str = "readings"
    settings: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Case:
    """A problem with a judgement for every model."""

    problem: Problem
    judgements: tuple[Judgement, ...]

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
    rows, trials = table.pop("quantities"), table.pop("trials")
    return Problem(
        name=path.stem,
        scene=scene,
        quantities=tuple(
            Quantity(name=row.pop("name"), exact=row.pop("exact"), scale=row.pop("scale", None))
            for row in rows
        ),
        readings=tuple(map(_reading, rows)),
        trials=tuple(_trial(row, scene, path) for row in trials),
        picture=Picture(**table.pop("picture", {})),
        **table,
    )


def _reading(row: dict[str, Any]) -> Reading:
    over = _reading(row.pop("over")) if "over" in row else None
    return Reading(words=row.pop("read", ""), over=over, **row)


def _scene(stated: str, changes: Changes, path: Path) -> Scene:
    scene = load_scene(stated) if stated in built_in_scenes() else read_scene(stated, path.name)
    return varied(scene, changes)


def varied(scene: Scene, changes: Changes) -> Scene:
    """Return a scene with changed settings."""
    return changed(scene, {tuple(key.split(".")): value for key, value in changes.items()})


def _trial(row: dict[str, Any], scene: Scene, path: Path) -> Trial:
    key, _, element = row["model"].partition(" ")
    elements, mesh = row.get("elements"), row.get("mesh")
    beams = f"{elements} elements a beam" if elements else "1 element a beam" if element else ""
    return Trial(
        model=row["model"],
        setting=row.get("setting", f"{mesh} elements" if mesh else beams),
        key=key,
        options=Options(
            element=element or None,
            elements=elements,
            mesh=tuple(map(int, mesh.split("x"))) if mesh else None,  # type: ignore[arg-type]
        ),
        scene=varied(_scene(row["scene"], {}, path) if "scene" in row else scene, row.get("changes", {})),
        allowance=Allowance(error=row["allowed"], why=row["why"]),
    )


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

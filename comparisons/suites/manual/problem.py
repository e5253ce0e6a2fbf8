"""The problems of the verification manual: each is one TOML file of the folder ``problems``."""

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from comparisons.frozen import Value
from comparisons.models.model import Options
from comparisons.scene import InputError, Scene, built_in_scenes, load_scene, read_scene, rules
from comparisons.suite.settings import Changes, changed

FOLDER = Path(__file__).parent / "problems"
ORDER = FOLDER / "order.txt"
"""The names of the problems in the order of the manual; those that are not named follow by name."""


class Picture(Value):
    """What is drawn."""

    axes: Sequence[str] = ()  #: Labels of the axes, by default places.
    shown: Sequence[float] = (1.0,)  #: Load parameters whose deflected axes are drawn.
    exact: str = ""  #: A model whose answer is the exact one.
    guide: Sequence[float] = ()  #: Order and first value of a line for the eye, on logarithmic axes.


class Quantity(Value):
    """A number with its exact value, and where an answer has it."""

    name: str = ""  #: With the unit, unless the quantity is dimensionless.
    exact: float = math.nan
    scale: float | None = None  #: What its error is divided by, the magnitude of the exact value if None.
    read: str = ""  #: The words of `comparisons.suites.manual.measures.value`.
    at: float = 1.0  #: A load parameter.
    #: In such readings and the attributes of the scene's first beam, ``beam.EI``.
    formula: str = "of(read, at)"
    changes: Changes = field(default_factory=dict)  #: What is changed in the scene.

    def error(self, value: float) -> float:
        """Return the error of a value over the scale."""
        return abs(value - self.exact) / (abs(self.exact) if self.scale is None else self.scale)


class Trial(Value):
    """A model that is put to a problem."""

    model: str  #: Model with its element.
    setting: str  #: Resolution.
    options: Options
    scene: Scene  #: What the model solves.
    allowed: float  #: Allowed error of every quantity.
    why: str  #: The reason of this bound.

    @property
    def label(self) -> str:
        """Model and setting."""
        return f"{self.model}, {self.setting}" if self.setting else self.model


class Problem(Value):
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


def read_problem(path: Path) -> Problem:
    """Return the problem that a TOML file states; its keys are the attributes of `Problem`, and its name is the file's.

    ``scene`` is a built-in scene, with ``changes`` if any, or the text of a scene file. A row of ``trials`` has the model and its
    element, ``elements`` or ``mesh``, ``allowed`` and ``why``, and ``scene`` and ``changes`` if it solves another scene than the problem's.
    """
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    scene = table["scene"] = _scene(table, path)
    table["quantities"] = tuple(Quantity(**row) for row in table["quantities"])
    table["trials"] = tuple(_trial(row, scene, path) for row in table["trials"])
    return Problem(name=path.stem, **table | {"picture": Picture(**table.get("picture", {}))})


def _scene(table: dict[str, Any], path: Path, scene: Scene | None = None) -> Scene:
    """Take the scene that a table states with its changes, by default `scene`."""
    changes, stated = table.pop("changes", {}), table.pop("scene", None)
    if stated is not None:
        scene = load_scene(stated) if stated in built_in_scenes() else read_scene(stated, path.name)
    assert scene is not None, "a problem has a scene"
    return changed(scene, changes)


def _trial(row: dict[str, Any], scene: Scene, path: Path) -> Trial:
    element, count, mesh = row["model"].partition(" ")[2], row.pop("elements", None), row.pop("mesh", None)
    beams = f"{count or 1} element{'s' if count else ''} a beam" if element else ""
    options = Options(element=element or None, elements=count, mesh=mesh and rules.mesh_text(mesh))
    row.setdefault("setting", f"{mesh} elements" if mesh else beams)
    return Trial(options=options, scene=_scene(row, path, scene), **row)


def problems(names: Sequence[str] | None = None, folder: Path = FOLDER) -> list[Path]:
    """Return the files of the problems of a folder with some names, of all where none are given, in the order of the manual.

    Raises
    ------
    InputError
        For a name that no problem has.
    """
    files = {path.stem: path for path in sorted(folder.glob("*.toml"))}
    known = [name for name in dict.fromkeys([*ORDER.read_text("utf-8").split(), *files]) if name in files]
    for name in names or ():
        if name not in files:
            raise InputError(name, f"no such problem ({', '.join(known)})")
    return [files[name] for name in known if names is None or name in names]

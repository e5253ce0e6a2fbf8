"""The contract of a model, the options of one run, and its progress. All that uses a model uses it through this contract alone."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Set
from math import nan
from typing import ClassVar, Literal, NamedTuple, get_args

from comparisons.answer import Response
from comparisons.frozen import Value
from comparisons.models.theory import ROUND_OFF, Bending
from comparisons.scene import Scene, unstated

Branch = Literal["stop", "stable", "primary"]
BRANCHES: tuple[str, ...] = get_args(Branch)
"""Ways to go on at a critical point."""


class ModelError(ValueError):
    """A model cannot state a scene, or an option does not fit the model: one line."""


class Options(Value):
    """Options of one run. None keeps the value of the scene, or the default of the model."""

    elements: int | None = None  #: TSM elements of every beam.
    #: Type of the TSM elements; without one, `mixed` where the options or the scene give a number of elements, else `exact`.
    element: str | None = None
    #: Bound on the error of the integration inside exact TSM elements.
    integration_tolerance: float | None = None
    mesh: tuple[int, int] | None = None  #: Elements of the solid along and across.
    #: At a critical point the path ends by name, turns to the stable branch of least energy, or goes on unstable.
    branch: Branch | None = None


WIDTH = 30
REDRAW = 0.1
"""Seconds between two drawings of a progress bar."""


class Reached(NamedTuple):
    """An accepted step: its load parameter, the iterations since the step before, and closed contacts, as ``pin->beam on element 8 of 20``."""

    load_parameter: float
    iterations: int
    contacts: tuple[str, ...]


Watch = Callable[[Reached], None]
Count = Callable[[int, int], None]
"""Receives how many parts of a work are done, and how many there are."""


def unwatched(*_: object) -> None:
    """Ignore the progress."""


def bar(part: float) -> str:
    """Return a progress bar that is filled to `part`.

    Examples
    --------
    >>> bar(0.5)
    '[###############...............]'
    """
    filled = int(WIDTH * min(max(part, 0.0), 1.0))
    return f"[{'#' * filled}{'.' * (WIDTH - filled)}]"


class Style(Value):
    """How figures draw the answers of a model: colour in hexadecimal digits, marker of matplotlib, width of a line on a page [px], no dashes."""

    colour: str
    marker: str = "d"
    width: float = 2.0
    unbroken: bool = False


def refused(state: Callable[[Scene], object], scene: Scene) -> str | None:
    """Return the sentence with which `state` refuses a scene; None if it states it."""
    try:
        state(scene)
    except ValueError as error:
        return str(error)
    return None


class Model(ABC):
    """A way to solve scenes."""

    name: str  #: Key of `comparisons.models.MODELS`, used on the command line, in files and in tables.
    label: str  #: Name in figures and texts.
    options: tuple[str, ...] = ()  #: Fields of `Options` that belong to the model.
    #: Modules that a solution imports. They are loaded before a solution is timed.
    libraries: ClassVar[tuple[str, ...]] = ()
    #: Whether a finer resolution makes it more accurate. A model without a mesh can be a reference.
    meshed: ClassVar[bool] = True
    #: Whether the model is a two-dimensional body, which converges to another limit than the rod.
    continuum: bool = False
    refinable: ClassVar[bool] = False  #: Whether `crossval solve --accuracy` can choose its resolution.
    rod: ClassVar[bool] = True  #: Whether the model has the stretch and the shear of Reissner's rod.
    #: Options at which the answer has no mesh error and can be a reference; None if there are none.
    reference: ClassVar[Options | None] = None
    #: The keys of `comparisons.scene.SPECIAL` that the model states; a scene with another one is refused.
    keys: ClassVar[Set[str]] = frozenset()
    style: Style | None = None  #: How figures draw its answers, where they are drawn alike; else `styles`.

    def unstated(self, scene: Scene) -> str | None:
        """Return the line that refuses a special key which the model does not state; None if it states all that `scene` uses."""
        return unstated(scene, self.label, self.keys)

    def apart(self, scene: Scene) -> float:  # noqa: ARG002 - others have another theory
        """Return the relative distance from Reissner's rod that the model's theory has, besides that of a continuum."""
        return 0.0

    def by_referee(self, scene: Scene) -> bool:  # noqa: ARG002 - one model asks the referee
        """Whether the answer is made of the referee's own equilibria, which the referee does not certify."""
        return False

    @abstractmethod
    def refusal(self, scene: Scene) -> str | None:
        """Return why the model cannot state `scene`, in one line; None if it can."""

    @abstractmethod
    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked nor named; without `wall_seconds` it has the time of this method.

        Raises
        ------
        ModelError
            If the model cannot state the scene.
        """

    def styles(self) -> dict[str, Style]:
        """Return how figures draw the model's answers, by the words that `run_label` and `family` begin with."""
        assert self.style is not None, "a model has one style, or states them"
        return {self.label: self.style}

    @property
    def colour(self) -> str:
        """Colour of the model as a whole: the colour of its first style."""
        return next(iter(self.styles().values())).colour

    @property
    def identity(self) -> str:
        """Text by which stored studies know the model; it changes with whatever outside this package changes its answers."""
        return self.name

    def rule(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - one model has one
        """Return what the model chooses where the options leave it open, and why; empty if nothing."""
        return ""

    def run_label(self, options: Options) -> str:
        """Return the label of one run, as ``TSM mixed, 20 elements``."""
        count = options.elements
        return self.label + (f", {count} element{'s' if count > 1 else ''}" if count else "")

    def setting(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - others have settings
        """Return the setting of one run in short, as ``mixed 20``; empty if the model has no settings."""
        return ""

    def family(self, scene: Scene, options: Options) -> str:  # noqa: ARG002 - others have settings
        """Return the name shared by all runs that differ from this one in resolution only."""
        return self.label

    def resolution(self, options: Options) -> float:
        """Return the number of elements along a beam; nan without a mesh, or where the scene gives the number."""
        count = options.elements if options.mesh is None else options.mesh[0]
        return nan if count is None else float(count)

    def compared(self) -> tuple[Options, ...]:
        """Return the settings that a comparison runs."""
        return (Options(),)

    def resolutions(self, *, quick: bool) -> Iterable[Options]:  # noqa: ARG002 - others have meshes
        """Return the settings whose accuracy and cost `crossval run trade` measures, each with several numbers of load steps; fewer if quick."""
        return (Options(),)

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:  # noqa: ARG002 - as above
        """Return the relative error against Reissner's rod that the model's theory allows, split by cause.

        A model that does not define this method is allowed round-off only.
        """
        return {"round-off": ROUND_OFF}

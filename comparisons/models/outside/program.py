"""A program of others as a model: it gets the resolved scene as JSON text and returns a response as JSON text."""

from __future__ import annotations

from functools import lru_cache
from math import nan
from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.scene.keys import PROGRAMS

if TYPE_CHECKING:
    from comparisons.models.outside.source import Source
    from comparisons.models.progress import Watch
    from comparisons.response import Response
    from comparisons.scene import Scene


class Program(Model):
    """A program of others.

    Parameters
    ----------
    source : Source
        How it is asked: a `Command`, which runs in a child process, or `Functions`, which run in this one.
    """

    keys = PROGRAMS

    def __init__(self, source: Source) -> None:
        self.source = source
        self.name, self.label = source.name, source.label or source.name
        self.continuum = source.continuum
        self.options = ("elements",) if source.elements else ()

    @property
    def identity(self) -> str:
        """Name of the program, and a digest of what its answers depend on."""
        return f"{self.name} {self.source.digest()}"

    def missing(self) -> str | None:
        """Return what must be installed to run the program; None if it can be found."""
        return self.source.missing()

    def refusal(self, scene: Scene) -> str | None:
        """Return why the program cannot state `scene`, or what is missing to run it."""
        return self.unstated(scene) or _refusal(self.source, scene) or self.missing()

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked. Its status names what failed if there is none."""
        from comparisons.models.outside.answer import answer, silent
        from comparisons.models.outside.request import request
        from comparisons.models.outside.status import ProgramError

        del watch
        missing = self.missing()
        if missing is not None:
            raise ModelError(missing)
        try:
            output, seconds = self.source.ask(request(scene, options, scene.times))
            return answer(output, scene, self.name, seconds)
        except ProgramError as error:
            return silent(
                scene, self.name, error.status.name, str(error), reported_success=error.reported_success
            )

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour=self.source.colour, marker="D")}

    def run_label(self, options: Options) -> str:
        """Return the label of one run, as ``mine, 20 elements``."""
        count = options.elements
        return self.label if count is None else f"{self.label}, {count} element{'s' if count > 1 else ''}"

    def setting(self, scene: Scene, options: Options) -> str:
        """Return the numbers of elements; empty if the program chooses its resolution itself."""
        counts = {options.elements or beam.elements for beam in scene.beams} if self.options else set()
        return "+".join(map(str, sorted(counts)))

    def resolution(self, options: Options) -> float:
        """Return the number of elements of a beam; nan where the scene or the program gives the number."""
        return nan if options.elements is None else float(options.elements)

    def resolutions(self, *, quick: bool) -> tuple[Options, ...]:
        """Return the program's numbers of elements; the first two if quick."""
        counts = self.source.elements[: 2 if quick else None]
        return tuple(Options(elements=count) for count in counts) or (Options(),)


@lru_cache(maxsize=256)
def _refusal(source: Source, scene: Scene) -> str | None:
    """Return why a program refuses a scene."""
    from comparisons.models.outside.request import request

    return source.refused(request(scene, Options(), ()))

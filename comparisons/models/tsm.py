"""Beams by the tangent stiffness method."""

from __future__ import annotations

from dataclasses import replace
from math import nan
from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.scene.keys import BEAMS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from comparisons.models.progress import Watch
    from comparisons.models.theory import Bending
    from comparisons.response import Response
    from comparisons.scene import Scene
    from tsm.elements import ElementType


class Tsm(Model):
    """Beams by the tangent stiffness method, with any type of element that `tsm.ELEMENTS` has."""

    name = "tsm"
    label = "TSM"
    options = ("elements", "element", "integration_tolerance", "branch")
    libraries = ("tsm",)
    refinable = True
    keys = BEAMS

    def element(self, options: Options) -> ElementType:
        """Return the type of the elements, `mixed` if none is chosen.

        Raises
        ------
        ModelError
            If there is no such type.
        """
        from tsm.elements import ELEMENTS, MIXED

        name = options.element or MIXED.name
        if name not in ELEMENTS:
            raise ModelError(f"element = {name}: must be one of {', '.join(ELEMENTS)}")
        return ELEMENTS[name]

    def suited(self, options: Options) -> tuple[Options, str]:
        """Return the options with the element that suits: `exact`, unless a number of elements is asked for."""
        from tsm.elements import EXACT, MIXED

        if options.element is not None:
            return options, ""
        if options.elements is not None:
            return replace(options, element=MIXED.name), f"{MIXED.name}, since a number of elements is given"
        rule = f"{EXACT.name}, since no number of elements is given: one a beam, without a mesh error"
        return replace(options, element=EXACT.name), rule

    @property
    def reference(self) -> Options:
        """Exact elements."""
        from tsm.elements import EXACT

        return Options(element=EXACT.name)

    def refusal(self, scene: Scene) -> str | None:
        """Return why beams cannot state `scene`; None if they can."""
        from comparisons.models.translate import beams_refusal

        return beams_refusal(scene)

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from comparisons.models.discrete import solve_tsm

        return solve_tsm(scene, options, self.element(options), watch)

    def styles(self) -> dict[str, Style]:
        """Return one style for every type of element."""
        from tsm.elements import ELEMENTS

        return {
            f"{self.label} {kind.name}": Style(colour=kind.colour, marker=kind.marker)
            for kind in ELEMENTS.values()
        }

    def run_label(self, options: Options) -> str:
        """Return the label of one run, as ``TSM mixed, 20 elements``."""
        count = options.elements
        words = "" if count is None else f", {count} element{'s' if count > 1 else ''}"
        return f"{self.label} {self.element(options).name}{words}"

    def setting(self, scene: Scene, options: Options) -> str:
        """Return element type, numbers of elements and tolerance, as ``mixed 20``."""
        kind = self.element(options)
        counts = {options.elements or (beam.elements if kind.meshed else 1) for beam in scene.beams}
        tolerance = (
            "" if options.integration_tolerance is None else f" tolerance {options.integration_tolerance:g}"
        )
        return f"{kind.name} {'+'.join(map(str, sorted(counts)))}{tolerance}"

    def family(self, scene: Scene, options: Options) -> str:
        """Return the type of the elements, as ``TSM mixed``."""
        del scene
        return f"{self.label} {self.element(options).name}"

    def resolution(self, options: Options) -> float:
        """Return the number of elements of a beam; nan where the scene gives the number."""
        return nan if options.elements is None else float(options.elements)

    def compared(self) -> tuple[Options, ...]:
        """Return the paper's element, the recommended one, and the exact one."""
        from tsm.elements import EXACT, MIXED, TIMOSHENKO

        return (
            *(Options(element=TIMOSHENKO.name, elements=count) for count in (10, 20, 50)),
            *(Options(element=MIXED.name, elements=count) for count in (10, 20)),
            Options(element=EXACT.name, elements=1),
        )

    def resolutions(self, *, quick: bool) -> Iterator[Options]:
        """Yield numbers of exact elements, of `mixed`, and of the paper's element."""
        from tsm.elements import EXACT, MIXED, TIMOSHENKO

        counts = {
            EXACT: (1,) if quick else (1, 2, 4),
            MIXED: (2, 3, 5, 10, 20, 40) if quick else (2, 3, 5, 10, 20, 40, 80, 160),
            TIMOSHENKO: (10, 20, 50) if quick else (5, 10, 20, 50, 100),
        }
        for kind, meshes in counts.items():
            yield from (Options(element=kind.name, elements=count) for count in meshes)

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
        """Return the allowed error from the element's order, contact and shear."""
        from comparisons.models.theory import beam_errors

        return beam_errors(self.element(options), scene, options, bent)


TSM = Tsm()
MODELS = (TSM,)

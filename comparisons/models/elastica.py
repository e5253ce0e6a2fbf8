"""The elastica, which neither stretches nor shears, under one pin on its axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.scene.keys import ONE_ROD, unstated

if TYPE_CHECKING:
    from comparisons.models.cantilever import RodScene
    from comparisons.models.progress import Watch
    from comparisons.models.theory import Bending
    from comparisons.response import Response
    from comparisons.scene import Scene


class Elastica(Model):
    """The elastica, in closed form."""

    name = "elastica"
    label = "elastica"
    libraries = ("comparisons.models.cantilever",)
    meshed = False
    rod = False
    keys = ONE_ROD

    def apart(self, scene: Scene) -> float:
        """Return the part of a cantilever's deflection under a force at its tip that is shear, and as much of stretch."""
        return max(3.0 * beam.EI / beam.length**2 * (1.0 / beam.EA + 1.0 / beam.GA) for beam in scene.beams)

    def refusal(self, scene: Scene) -> str | None:
        """Return why the elastica cannot state `scene`; None if it can."""
        try:
            _stated(scene)
        except ModelError as error:
            return str(error)
        return None

    def solve(self, scene: Scene, options: Options, watch: Watch) -> Response:
        """Return the response to `scene`, not yet checked."""
        from time import perf_counter

        import numpy as np

        from comparisons.exact.elastica import ElasticaState, elastica_under_pin
        from comparisons.exact.outcome import Outcome
        from comparisons.models.cantilever import LocalStates, local_response
        from comparisons.models.shared import POINTS

        del options, watch
        local = _stated(scene)
        beam, began = local.beam, perf_counter()
        path: list[ElasticaState] = []
        for x, y in local.points:
            state = elastica_under_pin(float(x), float(y), EI=beam.EI, length=beam.length)
            left = y > 0.0 and path and path[-1].outcome is Outcome.SLIPPED
            path.append(path[-1] if left else state)
        seconds = perf_counter() - began
        slipped = (t for t, one in zip(scene.times, path, strict=True) if one.outcome is Outcome.SLIPPED)
        names = ("force", "arc_position", "clamp_moment", "tip")
        states = LocalStates(
            visited=tuple(state.outcome for state in path),
            hits=np.arange(len(path)),
            **{name: np.array([getattr(state, name) for state in path]) for name in names},
            iterations=np.zeros(len(path), dtype=np.int64),
            shape=lambda k: path[k].shape(POINTS),
            slip_off=next(slipped, np.nan),
        )
        return local_response(self.name, scene, local, states, unknowns=1, seconds=seconds)

    def styles(self) -> dict[str, Style]:
        """Return one style."""
        return {self.label: Style(colour="#444444", width=1.2)}

    def error_parts(self, scene: Scene, options: Options, bent: Bending) -> dict[str, float]:
        """Return the errors from missing stretch and shear."""
        from comparisons.models.theory import elastica_errors

        del options
        return elastica_errors(scene, bent)


def _stated(scene: Scene) -> RodScene:
    """Return `scene` in the frame of the one cantilever that a pin on its axis pushes."""
    from comparisons.models.cantilever import to_rod

    unknown = unstated(scene, "the elastica", ONE_ROD)
    if unknown is not None:
        raise ModelError(unknown)
    local = to_rod(scene)
    if local.contact.friction:
        raise ModelError("the elastica has no friction here, the scene has some")
    if local.offset:
        raise ModelError(
            "the elastica has a point in contact on its axis only, the scene has a face or a round pin"
        )
    return local


ELASTICA = Elastica()
MODELS = (ELASTICA,)

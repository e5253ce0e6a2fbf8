"""The elastica, which neither stretches nor shears, under one pin on its axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.models.base import Model, Style
from comparisons.models.options import ModelError, Options
from comparisons.scene.keys import ONE_ROD

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
        from comparisons.exact import elastica_under_pin
        from comparisons.models.cantilever import local_response

        del options, watch
        local = _stated(scene)
        sizes = {"EI": local.beam.EI, "length": local.beam.length}
        return local_response(self.name, local, lambda: elastica_under_pin(local.path, **sizes), unknowns=1)

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

    local = to_rod(scene, "the elastica")
    if local.contact.friction:
        raise ModelError("the elastica has no friction here, the scene has some")
    if local.offset:
        raise ModelError(
            "the elastica has a point in contact on its axis only, the scene has a face or a round pin"
        )
    return local


ELASTICA = Elastica()
MODELS = (ELASTICA,)

"""A whole scene, which checks the rules between its records at construction, and what happens over the load parameters."""

from collections.abc import Iterator
from functools import cached_property

from comparisons.scene.coherence import scene_rules
from comparisons.scene.conditions import LoadSpec, SupportSpec
from comparisons.scene.rules import Point
from comparisons.scene.stages import LoadHistory, PrescribedMotion, amount
from comparisons.scene.statement import Statement


class Scene(Statement):
    """Beams with supports and loads, pins and contacts, and the load parameters ``t_k = k/n`` that every model hits exactly.

    Beams whose ends have the same coordinates are rigidly joined there, unless a hinge is between them. The load parameter goes from
    0 to 1, and on by 1 in each of `stages`. Every pin is in a contact. At least one pin, load, weight or moving support is needed, and
    no beam may be free.
    """

    obeys = (scene_rules,)

    @cached_property
    def prescribed_motions(self) -> dict[str, PrescribedMotion]:
        """The motions of `all_supports` through all stages, by supported end."""
        moves = [{self.place(move.node): move.motion for move in stage.support} for stage in self.stages]
        motions = {}
        for support in self.all_supports:
            x, y, rotation = (value or 0.0 for value in support.motion)
            onward = (moved.get(self.place(support.node), (0.0, 0.0, 0.0)) for moved in moves)
            motions[support.node] = PrescribedMotion(support, ((x, y, rotation), *onward))
        return motions

    @property
    def stage_gravities(self) -> tuple[Point, ...]:
        """The change of the acceleration of gravity in every stage."""
        return (self.gravity or (0.0, 0.0), *(stage.gravity for stage in self.stages))

    def gravity_at(self, load_parameter: float) -> Point:
        """Return the acceleration of gravity at `load_parameter`."""
        x, y = amount(self.stage_gravities, load_parameter)
        return x, y

    def numbered_loads(self) -> Iterator[tuple[int, LoadSpec]]:
        """Yield the number of the stage, from 0, of every load, and the load."""
        stages = enumerate((self.loads, *(stage.load for stage in self.stages)))
        yield from ((number, load) for number, loads in stages for load in loads)

    @cached_property
    def load_histories(self) -> tuple[LoadHistory, ...]:
        """The dead loads through all stages, place by place in the order of the file."""
        found: dict[str, LoadHistory] = {}
        for number, load in self.numbered_loads():
            first, amounts = found.get(load.node) or (load, ((0.0, 0.0, 0.0),) * (len(self.stages) + 1))
            found[load.node] = LoadHistory(first, (*amounts[:number], load.amount, *amounts[number + 1 :]))
        return tuple(found.values())

    def supports_of(self, beam: str) -> tuple[SupportSpec, ...]:
        """Return the supports of a beam by falling number of held components; at equality the support at the start is first."""
        own = (support for support in self.all_supports if support.beam == beam)
        return tuple(sorted(own, key=lambda support: (-len(support.held), support.end == "end")))

    def tip(self, beam: str) -> str:
        """Return the end of a beam with fewer held components, "end" at equality."""
        held = [support.end for support in self.supports_of(beam)]
        return "start" if held[:1] == ["end"] else "end"

    @cached_property
    def times(self) -> tuple[float, ...]:
        """The load parameters: ``j + k/n``, k = 1..n, of the stage j = 0, 1, ... with n load parameters."""
        counts = (self.load_parameters, *(stage.load_parameters for stage in self.stages))
        return tuple(before + k / n for before, n in enumerate(counts) for k in range(1, n + 1))

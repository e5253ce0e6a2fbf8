"""The cost of a scene is in proportion to the number of its beams."""

from collections.abc import Callable
from cProfile import Profile
from typing import Any

import pytest

from comparisons.models import solve
from comparisons.scene import read_scene

HEAD = '[scene]\nname = "many"\nload_parameters = 3\n'
SECTION = "youngs_modulus = 2.1e11\npoissons_ratio = 0.3\nwidth = 0.5\nheight = 0.5\nelements = 2\n"
LOAD = '[[load]]\nbeam = "b{}"\nend = "end"\nforce = [0.0, {}]\n'


def beam(number: int) -> str:
    clamped = 'clamped = ["start"]\n' if number == 0 else ""
    return f'[[beam]]\nname = "b{number}"\nstart = [{number}, 0]\nend = [{number + 1}, 0]\n{SECTION}{clamped}'


def chain(number: int) -> str:
    """Beams in a row, clamped at one end, with a force at the other that lifts it by a fifth of the length.

    They are thick: of a chain 100,000 times as long as it is high, positions in double precision do not resolve the forces.
    """
    force = LOAD.format(number - 1, 0.6 * 2.1e11 * 0.5**4 / 12 / number**2)
    return HEAD + "".join(map(beam, range(number))) + force


def calls(work: Callable[[], Any]) -> int:
    """Number of calls, of Python and of C, in some work."""
    profile = Profile()
    profile.runcall(work)
    return sum(entry.callcount for entry in profile.getstats())


def whole(text: str) -> None:
    response = solve(read_scene(text, "many.toml"), "tsm")
    assert response.status == "COMPLETED"
    response.page()
    response.table()


@pytest.mark.slow
def test_calls_grow_with_the_number_of_beams():
    """From 50 over 100 to 200: the second rise is twice the first, of quadratic work four times."""
    whole(chain(8))
    few, some, many = (calls(lambda n=n: whole(chain(n))) for n in (50, 98, 200))  # type: ignore[misc]
    assert (many - some) / 102 < 1.15 * (some - few) / 48


def test_a_long_chain_is_bent_in_few_iterations():
    """Steps are measured by the chain and not by one of its beams; the elastica under ``P = .6 EI/L^2``."""
    response = solve(read_scene(chain(300), "many.toml"), "tsm")
    assert response.completed
    assert response.newton_iterations.sum() < 40
    assert response.tips["b299"][-1] / 300 == pytest.approx([0.977512, 0.192350], abs=2e-6)

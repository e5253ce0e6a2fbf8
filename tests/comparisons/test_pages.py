"""The page of every built-in scene, as ``crossval solve SCENE`` prints it: ``python -m tests.comparisons.test_pages`` writes them anew."""

import re
import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.scene import built_in_scenes

FOLDER = Path(__file__).parent / "pages"
LAST_DIGIT = 1.1e-5
"""One unit of the sixth digit, by which machines may differ."""
SLOW = {"double-beam", "double-beam-friction", "hysteresis", "ks-friction", "three-point-friction"}
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]\d+)?(?![\w.])")


def printed(scene: str) -> str:
    """Return the page."""
    out = StringIO()
    with redirect_stdout(out):
        assert main(["solve", scene, "--quiet"]) == 0
    return out.getvalue()


def parts(page: str) -> tuple[list[str], list[float]]:
    """Return the words and the numbers of a page; events at one load parameter may come in either order."""
    head, events, listed = page.partition("\nEvents\n")
    text = head + events + "\n".join(sorted(listed.splitlines()))
    return NUMBER.sub("#", text).split(), [float(number) for number in NUMBER.findall(text)]


@pytest.mark.slow_at("beam-on-springs", "hysteresis-stages", "ks-tied-tip")
@pytest.mark.parametrize(
    "scene",
    [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in built_in_scenes()],
)
def test_the_page_of_a_built_in_scene(scene: str) -> None:
    words, numbers = parts(printed(scene))
    kept, values = parts((FOLDER / f"{scene}.txt").read_text(encoding="utf-8"))
    assert words == kept
    assert numbers == pytest.approx(values, rel=LAST_DIGIT, abs=0.0)


def test_every_page_is_that_of_a_scene() -> None:
    assert {path.stem for path in FOLDER.iterdir()} == set(built_in_scenes())


if __name__ == "__main__":
    for name in sys.argv[1:] or built_in_scenes():
        (FOLDER / f"{name}.txt").write_text(printed(name), encoding="utf-8")

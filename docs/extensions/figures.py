"""The pictures of the README, the tutorial and the pages, drawn by the commands that the pages show: ``make figures``."""

import re
import shutil
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

from PIL import Image

from comparisons.cli import main

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / ".figures"
COLOURS = 200
"""Colours of a picture in the repository, which keep it small."""
COMMANDS = {
    "check mine.toml --out check.png": {"check.png": "mine-check.png"},
    "solve mine.toml --out solve.png": {"solve.png": "mine-solve.png"},
    "compare mine.toml --out mine --quiet": {
        "mine/shapes.png": "mine-shapes.png",
        "mine/side-by-side.png": "mine-side-by-side.png",
        "mine/budget.png": "mine-budget.png",
    },
    "compare ks-cantilever --out ks --quiet": {
        "ks/shapes.png": "ks-shapes.png",
        "ks/side-by-side.png": "ks-side-by-side.png",
        "ks/budget.png": "ks-budget.png",
    },
    "run fig9 --out paper": {"paper/fig9.png": "double-beam.png"},
    "run fig7b --out paper": {"paper/fig7b-floor.png": "critical-area-floor.png"},
    "run trade ks-cantilever --out trade": {"trade/end-seconds.png": "ks-trade.png"},
}
"""What each command draws, and the names in the repository."""


def tutorial_scene() -> str:
    """Return the scene of the tutorial."""
    page = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    found = re.search(r"^```toml\n# mine.toml\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    assert found, "the tutorial has a scene"
    return found[1]


def draw(commands: dict[str, dict[str, str]], folder: Path) -> list[Path]:
    """Run commands in a folder of their own, and write their pictures with few colours to `folder`."""
    written = []
    with tempfile.TemporaryDirectory() as scratch, chdir(scratch):
        Path("mine.toml").write_text(tutorial_scene(), encoding="utf-8")
        for command, pictures in commands.items():
            status = main(command.split())
            assert status == 0, command
            for drawn, name in pictures.items():
                shutil.copy(drawn, folder / name)
                written.append(small(folder / name))
    return written


def small(path: Path) -> Path:
    """Write a picture again with `COLOURS` colours."""
    with Image.open(path) as picture:
        few = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    few.save(path, optimize=True)
    return path


if __name__ == "__main__":
    for path in draw(COMMANDS, FOLDER):
        sys.stdout.write(f"{path.relative_to(ROOT)} {path.stat().st_size // 1000} kB\n")

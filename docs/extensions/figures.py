"""The pictures of the README and the pages, drawn by the commands that the pages show: ``python -m docs.extensions.figures``."""

import re
import sys
import tempfile
from contextlib import chdir
from pathlib import Path

from PIL import Image

from comparisons.cli import main

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / ".figures"
COLOURS = 200  # few, which keep a picture small
COMPARED = ("shapes", "side-by-side", "budget")
SPECIMENS = ("leaf", "clip", "hook")
COMMANDS = {
    "check mine.toml --out check.png": {"check.png": "mine-check.png"},
    "solve mine.toml --out solve.png": {"solve.png": "mine-solve.png"},
    "compare mine.toml --out mine --quiet": {f"mine/{name}.png": f"mine-{name}.png" for name in COMPARED},
    "compare ks-cantilever --out ks --quiet": {f"ks/{name}.png": f"ks-{name}.png" for name in COMPARED},
    "run fig9 --out paper": {"paper/fig9.png": "double-beam.png"},
    "run fig7b --out paper": {"paper/fig7b-floor.png": "critical-area-floor.png"},
    **{f"solve {name}.toml --out {name}.png": {f"{name}.png": f"{name}-solve.png"} for name in SPECIMENS},
    "run trade ks-cantilever --out trade": {"trade/path-seconds.png": "ks-trade.png"},
}
"""What each command draws, and the names in the repository."""


def draw(commands: dict[str, dict[str, str]], folder: Path) -> list[Path]:
    """Run commands in a folder of their own with the scenes of two pages; write their pictures with few colours to `folder`."""
    pages = ((ROOT / "docs" / name).read_text("utf-8") for name in ("tutorial.md", "how-to/specimens.md"))
    written = []
    with tempfile.TemporaryDirectory() as scratch, chdir(scratch):
        for name, scene in re.findall(
            r"^```toml\n# (\S+)\n(.*?)^```$", "".join(pages), re.DOTALL | re.MULTILINE
        ):
            Path(name).write_text(scene, encoding="utf-8")
        for command, pictures in commands.items():
            assert main(command.split()) == 0, command
            for drawn, name in pictures.items():
                with Image.open(drawn) as picture:
                    few = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
                few.save(folder / name, optimize=True)
                written.append(folder / name)
    return written


if __name__ == "__main__":
    for path in draw(COMMANDS, FOLDER):
        sys.stdout.write(f"{path.relative_to(ROOT)} {path.stat().st_size // 1000} kB\n")

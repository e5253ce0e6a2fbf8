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
COMMANDS = {
    **{f"{name} mine.toml --out mine-{name}.png": [f"mine-{name}.png"] for name in ("check", "solve")},
    **{
        f"compare {scene} --out {name} --quiet": [
            f"{name}/{one}" for one in ("shapes.png", "stress.svg", "budget.svg")
        ]
        for scene, name in (("mine.toml", "mine"), ("ks-cantilever", "ks"))
    },
    "run fig9 --out paper": ["paper/fig9.png"],
    "run fig7b --out paper": ["paper/fig7b-floor.png"],
    **{f"solve {name}.toml --out {name}.png": [f"{name}.png"] for name in ("leaf", "clip", "hook")},
    "run trade ks-cantilever --out trade": ["trade/path-seconds.png"],
}
"""What each command draws; in the repository a hyphen stands in place of the slash."""


def draw(commands: dict[str, list[str]], folder: Path) -> list[Path]:
    """Run commands in a folder of their own with the scenes of two pages; write their pictures with few colours to `folder`."""
    pages = ((ROOT / "docs" / name).read_text("utf-8") for name in ("tutorial.md", "how-to/specimens.md"))
    written = []
    with tempfile.TemporaryDirectory() as scratch, chdir(scratch):
        for name, scene in re.findall(r"(?ms)^```toml\n# (\S+)\n(.*?)^```$", "".join(pages)):
            Path(name).write_text(scene, encoding="utf-8")
        for command, pictures in commands.items():
            assert main(command.split()) == 0, command
            for drawn in pictures:
                written.append(folder / drawn.replace("/", "-"))
                if drawn.endswith(".svg"):
                    written[-1].write_bytes(Path(drawn).read_bytes())
                    continue
                with Image.open(drawn) as picture:
                    few = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
                few.save(written[-1], optimize=True)
    return written


if __name__ == "__main__":
    for path in draw(COMMANDS, FOLDER):
        sys.stdout.write(f"{path.relative_to(ROOT)} {path.stat().st_size // 1000} kB\n")

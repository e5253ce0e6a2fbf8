"""``crossval check``: which models can state a scene, and a drawing of it, before anything is solved."""

import sys
from argparse import Namespace

from comparisons.cli.command import DONE
from comparisons.cli.options import STANDARD, outputs, write
from comparisons.models import find
from comparisons.models.model import Options
from comparisons.models.outside.exchange import request
from comparisons.report.sketch import draw, stated
from comparisons.scene import load_scene
from comparisons.scene.ends import near_ends


def run(given: Namespace) -> int:
    """Say which models can state the scene, and draw it."""
    scene = load_scene(given.scene)
    for name in given.others:
        find(name)
    files = outputs(given.out, ".json", ".png", ".svg")
    printed = (".json", STANDARD) in files
    if not printed:
        print(*stated(scene, given.others), *near_ends(scene), sep="\n")
    for file, (kind, path) in zip(given.out, files, strict=True):
        if kind == ".json":
            write(path, request(scene, Options(), scene.times))
        else:
            draw(scene, path)
        if path != STANDARD:
            print(f"written: {file}", file=sys.stderr if printed else sys.stdout)
    return DONE

"""``crossval scenes``: the built-in scenes, or the schema of scene files."""

import json
import re
import sys
from argparse import Namespace

from comparisons.cli.command import DONE, report
from comparisons.scene import built_in_scenes
from comparisons.scene.read import json_schema


def run(given: Namespace) -> int:
    """Print the names of the built-in scenes and what they are, or the schema."""
    if given.schema:
        print(json.dumps(json_schema(), indent=1))
        return DONE
    for scene, text in built_in_scenes().items():
        said = re.split(r"(?<!al)[:.]\s", text)[0].replace("\n# ", " ").removeprefix("# ")
        report(f"{scene:26s} {said}", sys.stdout, indent=27)
    return DONE

"""A program of others for the tests: it answers with a stored response, changed by a few lines of Python."""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from comparisons.cli import main
from comparisons.scene import Scene, load_scene, to_toml

KS = replace(load_scene("ks-cantilever"), load_parameters=5)
PAIR = "pin->cantilever"
PROGRAM = """
import json, math, os, sys, time
from pathlib import Path
scene = json.load(sys.stdin)
answer = json.loads(Path("truth.json").read_text())
contact, support = answer["contacts"]["pin->cantilever"], answer["supports"]["cantilever.start"]
axis = answer["axes"]["cantilever"]
{lines}
print(json.dumps(answer))
"""

Make = Callable[..., str]


def stored(scene: Scene) -> str:
    """Return the exact answer to a scene, as a program states it."""
    with TemporaryDirectory() as folder:
        file, answer = (Path(folder) / name for name in ("scene.toml", "answer.json"))
        file.write_text(to_toml(scene))
        assert main(["solve", str(file), "--element", "exact", "--out", str(answer), "--quiet"]) == 0
        data = json.loads(answer.read_text())
    for key in ("certificate", "index", "reported_success", "tips", "events", "material_force"):
        del data[key]
    return json.dumps({**data, "scene": scene.name})


@pytest.fixture(scope="session")
def truth() -> str:
    return stored(KS)


@pytest.fixture
def program(tmp_path: Path, truth: str) -> Make:
    """Return a function that writes a program file; the program runs some lines on the true answer before it prints it."""
    (tmp_path / "ks.toml").write_text(to_toml(KS))
    (tmp_path / "truth.json").write_text(truth)

    def write(lines: str = "", **keys: object) -> str:
        (tmp_path / "liar.py").write_text(PROGRAM.format(lines=lines))
        more = "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
        file = tmp_path / "liar.toml"
        command = json.dumps([sys.executable, "-I", "liar.py"])
        file.write_text(f'[program]\nname = "liar"\ncommand = {command}\n{more}')
        return str(file)

    return write

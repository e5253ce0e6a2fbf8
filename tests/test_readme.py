"""Every command and snippet of the README runs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.cli.command import command_parser
from comparisons.scene import load_scene
from tests.documentation.snippets import ROOT, blocks, make_targets, run_line, run_python

README = (ROOT / "README.md").read_text()
BLOCKS = blocks(README)
COMMANDS = [line for kind, text in BLOCKS if kind == "sh" for line in text.splitlines() if line]


ELSEWHERE = ("crossval trade", "crossval manual", "crossval extremes")
"""Commands of a minute and more, which have slow tests of their own: here only their arguments are read."""


SAID = {
    "doctor": ("numpy", "scikit-fem"),
    "scenes": ("double-beam", "ks-tied-tip"),
    "new strip": ("strip.toml",),
    "check": ("tsm: yes", "solid: yes", "rod: yes", "drawn: ks.png"),
    "solve": ("COMPLETED", "force"),
    "certify": ("CERTIFIED",),
    "compare": ("exact rod", "summary.json"),
    "view": ("view.png",),
    "gate": ("force", "shape", "<= 0.001"),
    "reproduce": ("claims-fig9.md",),
    "study": ("thin-beams.csv",),
}
"""What a command prints, beside its exit status."""


@pytest.mark.parametrize(
    "line",
    [
        pytest.param(line, marks=pytest.mark.slow if line.startswith("crossval view") else ())
        for line in COMMANDS
        if line.startswith("crossval") and not line.startswith(ELSEWHERE)
    ],
)
def test_crossval_commands(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    out = run_line(line)
    if "--json -" in line:
        assert json.loads(out)["status"] == "COMPLETED"
    else:
        [said] = [words for start, words in SAID.items() if line.startswith(f"crossval {start}")]
        assert all(word in out for word in said), out
    for written in re.findall(r" (?:--out|--junit|--vtk) (\S+)", line):
        assert Path(written).is_file() or any(Path(written).iterdir())


@pytest.mark.parametrize("command", ELSEWHERE)
def test_long_commands_can_be_read(command):
    [line] = (line for line in COMMANDS if line.startswith(command))
    assert command_parser().parse_args(line.split()[1:]).run


def test_make_targets_exist():
    named = set(re.findall(r"(?:^|`)make ([\w-]+)", README, re.MULTILINE))
    assert {"run", "test", "test-all", "bench"} <= named <= make_targets()


def test_python_snippet(tmp_path):
    snippet = next(text for kind, text in BLOCKS if kind == "python")
    assert float(run_python(snippet, tmp_path)) == pytest.approx(2.288274307175e-03, rel=1e-4)


SCENES = [text for kind, text in BLOCKS if kind == "toml"]


@pytest.mark.parametrize("model", ["tsm", "solid", "rod"])
def test_scene_snippet(model, tmp_path, capsys):
    scene = tmp_path / "mine.toml"
    scene.write_text(SCENES[0])
    assert main(["solve", str(scene), "--model", model]) == 0
    assert "COMPLETED" in capsys.readouterr().out
    scene.write_text(scene.read_text().replace("height = 0.01", "height = -0.01"))
    assert main(["solve", str(scene), "--model", model]) == 2
    assert "beam[0].height = -0.01: must be positive" in capsys.readouterr().err


def test_study_snippet(tmp_path, capsys):
    study, results = tmp_path / "slenderness.toml", tmp_path / "results.sqlite"
    study.write_text(SCENES[1])
    assert main(["study", str(study), "--results", str(results), "--quiet"]) == 0
    assert main(["results", str(results), "--csv"]) == 0
    assert len(capsys.readouterr().out.strip().splitlines()[1:]) >= 14


def test_pictures_are_there():
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", README):
        assert (ROOT / picture).is_file()
    assert load_scene("ks-cantilever").name == "ks-cantilever"

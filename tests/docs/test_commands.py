"""Every command of the README and of the page of commands runs and prints what it is for; other snippets that state numbers hold."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.cli.command import command_parser
from tests.docs.snippets import ROOT, blocks, make_targets, run_line, run_python

FOLDER = ROOT / "docs"
PAGES = {path: path.read_text() for path in sorted(FOLDER.rglob("*.md")) if "_generated" not in path.parts}
SOURCES = (ROOT / "README.md", FOLDER / "how-to" / "commands.md")
LINES = [
    shlex.join(shlex.split(line, comments=True))
    for source in SOURCES
    for kind, text in blocks(source.read_text())
    if kind == "sh"
    for line in text.splitlines()
    if line.startswith("crossval") and "mine.toml" not in line
]
COMMANDS = list(dict.fromkeys(LINES))
"""Each once; the README's own scene is run by the README's tests."""

ELSEWHERE = ("crossval trade", "crossval manual", "crossval extremes", "crossval league")
"""Commands of a minute and more, which have slow tests of their own: here only their arguments are read."""
LONG = (
    "crossval view",
    "crossval compare",
    "crossval reproduce",
    "crossval study",
    "crossval solve double-beam --model solid",
)
"""Commands of many seconds, left to the slow tests; the fast tests of the commands run them on smaller scenes."""

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


@pytest.mark.slow_at("crossval doctor", "crossval solve ks-cantilever --model rod")
@pytest.mark.parametrize(
    "line",
    [
        pytest.param(line, marks=pytest.mark.slow if line.startswith(LONG) else ())
        for line in COMMANDS
        if not line.startswith(ELSEWHERE)
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
    lines = [line for line in COMMANDS if line.startswith(command)]
    assert lines
    assert all(command_parser().parse_args(line.split()[1:]).run for line in lines)


def test_the_commands_that_were_always_shown_are_shown():
    named = {line.split()[1] for line in COMMANDS}
    assert named == {start.split()[0] for start in (*SAID, *(line.split()[1] for line in ELSEWHERE))}
    assert len(COMMANDS) >= 22


def test_make_targets_of_all_pages_exist():
    named = {
        target
        for text in PAGES.values()
        for target in re.findall(r"(?:^|`)make ([\w-]+)", text, re.MULTILINE)
    }
    assert {"run", "test", "test-all", "bench"} <= named <= make_targets()


def test_pictures_of_all_pages_are_there():
    pictures = [
        path.parent / picture
        for path, text in PAGES.items()
        for picture in re.findall(r"!\[.*?\]\((.*?)\)", text)
    ]
    assert len(pictures) >= 5
    assert all(picture.is_file() for picture in pictures)


def test_every_table_of_results_names_what_measures_it():
    """Near every table of numbers stands a command or a test."""
    for path, text in PAGES.items():
        if path.parent.name == "results":
            for section in re.split(r"^## ", text, flags=re.MULTILINE):
                if "|---" in section:
                    named = re.search(r"`(?:crossval|make|python) [^`]+`|\{test\}`", section)
                    assert named, f"{path.name}: {section.splitlines()[0]}"


def test_python_snippet(tmp_path):
    snippet = next(text for kind, text in blocks(PAGES[FOLDER / "how-to" / "python.md"]) if kind == "python")
    printed = re.search(r"force (\S+),", run_python(snippet, tmp_path))
    assert printed is not None
    assert float(printed[1]) == pytest.approx(2.288274307175e-03, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "runs"), [("stiffness", 14), ("friction", 12)])
def test_study_snippet(tmp_path, capsys, name, runs):
    page = PAGES[FOLDER / "how-to" / "study.md"]
    stated = next(text for kind, text in blocks(page) if kind == "toml" and f"# {name}.toml" in text)
    study, results = tmp_path / f"{name}.toml", tmp_path / "results.sqlite"
    study.write_text(stated)
    assert main(["study", str(study), "--results", str(results), "--quiet"]) == 0
    assert main(["results", str(results), "--csv"]) == 0
    assert len(capsys.readouterr().out.strip().splitlines()[1:]) >= runs

"""The README is short, and what it says holds: its scene, its commands, its links."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.scene import load_scene
from tests.docs.snippets import ROOT, blocks, make_targets, run_page

README = (ROOT / "README.md").read_text()
BLOCKS = blocks(README)
LINES, WORDS, COLUMNS = 120, 900, 160
"""What a new reader is asked to read, tables and code included."""


def test_it_is_short():
    assert len(README.splitlines()) <= LINES
    assert len(README.split()) <= WORDS
    assert max(map(len, README.splitlines())) <= COLUMNS


def test_it_has_one_table_of_at_most_eight_rows():
    rows = [line for line in README.splitlines() if line.startswith("|")]
    assert sum(bool(re.fullmatch(r"\|(-+\|)+", row)) for row in rows) == 1
    assert len(rows) - 2 <= 8


def test_make_targets_exist():
    named = set(re.findall(r"(?:^|`)make ([\w-]+)", README, re.MULTILINE))
    assert {"run", "test", "test-all", "bench"} <= named <= make_targets()


def test_it_names_what_continuous_integration_runs():
    ran = re.findall(r"^make ([\w-]+)$", (ROOT / ".ci" / "run").read_text(), re.MULTILINE)
    assert ran
    assert all(f"`make {target}`" in README for target in ran)


def test_links_lead_somewhere():
    targets = [target for target in re.findall(r"\]\(([^)]+)\)", README) if "://" not in target]
    assert len(targets) > 10
    assert [target for target in targets if not (ROOT / target).is_file()] == []


def test_every_sentence_on_trust_has_a_page():
    trust = README.partition("## How far to trust it\n")[2].partition("\n## ")[0].strip().splitlines()
    assert len(trust) == 5
    assert all(re.search(r"\(\[\w+\]\(docs/[\w/-]+\.md\)\)\.$", sentence) for sentence in trust)


def test_its_first_scene_prints_what_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    section = README.partition("## A first scene\n")[2].partition("\n## ")[0]
    assert [kind for kind, _ in blocks(section)] == ["toml", "sh", "text"]
    run_page(section, tmp_path, slow=False)


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


def test_pictures_are_there():
    pictures = re.findall(r"!\[.*?\]\((.*?)\)", README)
    assert pictures
    assert all((ROOT / picture).is_file() for picture in pictures)
    assert load_scene("ks-cantilever").name == "ks-cantilever"

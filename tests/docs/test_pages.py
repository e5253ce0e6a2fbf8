"""The README and the pages: their commands and snippets run and print what they say, their links lead somewhere, their pictures are drawn."""

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.cli import main
from docs.extensions.figures import COMMANDS, FOLDER, draw
from tests.docs.snippets import ROOT, SLOW, TARGETS, blocks, pages, run_line, run_page

TEXTS = pages()
README, HOW_TO = TEXTS["README.md"], "docs/how-to/"
ONE_BY_ONE = ("README.md", f"{HOW_TO}commands.md")
"""Pages whose commands are run one by one."""
RUN = {
    name: text
    for name, text in TEXTS.items()
    if any(kind for kind, _ in blocks(text)) and name not in ONE_BY_ONE
}
"""Pages that are run as a whole."""
LONG = {name for name, text in RUN.items() if any(f"\n{command}" in text for command in SLOW)}
LENGTHY = r"/(?:accuracy|beam-element|bench|compare|element|material|paraview|program|python|scene|specimens|study|tutorial)\.md"
SECONDS = {name for name in RUN if re.search(LENGTHY, name)}
"""Pages that take more than a second without the commands of `SLOW`."""


@pytest.mark.parametrize(
    ("page", "slow"),
    [
        *((page, False) for page in RUN if page not in SECONDS),
        *(pytest.param(page, True, marks=pytest.mark.slow) for page in RUN if page in SECONDS | LONG),
    ],
)
def test_snippets_run_and_print_what_the_page_says(page, slow, in_folder):
    run_page(RUN[page], in_folder, slow=slow)
    # yaml is for a CI system, py and bash are for programs of others
    assert {kind for kind, _ in blocks(RUN[page])} <= {"python", "toml", "sh", "text", "yaml", "py", "bash"}


LINES = dict.fromkeys(
    shlex.join(shlex.split(line, comments=True))
    for page in ONE_BY_ONE
    for kind, text in blocks(TEXTS[page])
    if kind == "sh"
    for line in text.splitlines()
    if line.startswith("crossval") and "mine.toml" not in line
)
"""Each command once, but for those of the README's own scene."""
SAID = {
    "--version": "numpy scikit-fem",
    "scenes": "double-beam ks-tied-tip",
    "new": "strip.toml",
    "check": "tsm:_yes solid:_yes rod:_yes written:_ks.png",
    "solve": "COMPLETED force",
    "certify": "CERTIFIED",
    "compare": "exact_rod summary.json",
    "compare_ks-cantilever_--max-error": "force shape <=_0.001",
    "view": "view.png",
    "run": "files:",
}
"""What a command, or one that begins with these words, prints beside its exit status."""
ELSEWHERE = ("run trade", "run manual", "run extremes", "compare tip-load")
"""Beginnings of commands of a minute and more, which have slow tests of their own: here only their arguments are read."""
MORE = tuple(
    f"crossval {one}" for one in ("solve double-beam", "certify", "check ks-cantilever --out", "--version", "solve ks-cantilever --model rod")
)  # fmt: skip
"""Lines of more than a second besides those of `SLOW`; the fast tests of the commands run them on smaller scenes."""


@pytest.mark.parametrize(
    "line",
    [pytest.param(line, marks=pytest.mark.slow if line.startswith((*SLOW, *MORE)) else ()) for line in LINES],
)
def test_commands_run_and_print_what_they_are_for(line, in_folder, capsys):
    if line.removeprefix("crossval ").startswith(ELSEWHERE):
        with pytest.raises(SystemExit):
            main([*shlex.split(line)[1:], "--invented"])
        assert capsys.readouterr().err.endswith("error: unrecognized arguments: --invented\n")
        return
    out = run_line(line)
    if "--out -" in line:
        assert json.loads(out)["status"] == "COMPLETED"
    else:
        said = max((key for key in SAID if line[9:].startswith(key.replace("_", " "))), key=len)
        assert [word for word in SAID[said].split() if word.replace("_", " ") not in out] == []
    for written in re.findall(r" --out (\S\S+)", line):
        assert Path(written).is_file() or any(Path(written).iterdir())


def test_every_command_is_shown():
    assert {line.split()[1] for line in LINES} == {key for key in SAID if "_" not in key}


SEARCHED = (
    "spring rate", "force-displacement", "PDF", "stress", "buckling", "buckles", "friction", "reaction", "units", "install",
)  # fmt: skip
"""Words that people search for."""


def test_what_people_search_for_is_found():
    text = " ".join(" ".join(text.split()) for page, text in TEXTS.items() if page.startswith("docs/"))
    assert [words for words in SEARCHED if words not in text] == []


def test_the_menu_has_three_doors_of_at_most_twelve_entries():
    doors = re.findall(r":caption: (.*)\n\n((?:[^\n`]+\n)+)```", TEXTS["docs/index.md"])
    assert [name for name, _ in doors] == ["Use it", "Trust it", "Extend it"]
    assert all(len(entries.splitlines()) <= 12 for _, entries in doors)


def test_no_page_is_long():
    assert {page: len(text.split()) for page, text in TEXTS.items() if len(text.split()) > 1200} == {}


def test_make_targets_links_and_pictures_are_there():
    whole = "".join(TEXTS.values())
    assert (
        {"run", "test", "test-all", "bench"} <= {*re.findall(r"(?m)(?:^|`)make ([\w-]+)", whole)} <= TARGETS
    )
    picture = re.compile(r"!\[.*?\]\((.*?)\)")
    shown = [Path(page).parent / name for page, text in TEXTS.items() for name in picture.findall(text)]
    links = [Path(target) for target in re.findall(r"\]\(([^)]+)\)", README) if "://" not in target]
    assert len(shown) > 5 < len(links)
    assert [str(path) for path in (*shown, *links) if not (ROOT / path).is_file()] == []
    kept = {name for text in TEXTS.values() for name in re.findall(r"\.figures/([\w-]+\.(?:png|svg))", text)}
    assert kept == {path.name for path in FOLDER.iterdir()}
    assert {name.replace("/", "-") for drawn in COMMANDS.values() for name in drawn} <= kept
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 1.2e6


def test_every_table_of_results_names_what_measures_it():
    """Near every table of numbers stands a command or a test."""
    sections = [
        part for page, text in TEXTS.items() if "/results/" in page for part in re.split(r"(?m)^## ", text)
    ]
    measured = re.compile(r"`(?:crossval|make|python) [^`]+`|\{abbr\}`")
    assert [part.splitlines()[0] for part in sections if "|---" in part and not measured.search(part)] == []


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(line, marks=pytest.mark.slow if line.startswith("solve") else ())
        for line in COMMANDS
        if line.startswith(("check", "solve"))
    ],
)
def test_the_tutorial_shows_what_its_commands_draw(command, tmp_path):
    (path,) = draw({command: COMMANDS[command]}, tmp_path)
    drawn, kept = (imread(folder / path.name)[..., :3] for folder in (tmp_path, FOLDER))
    assert drawn.shape == kept.shape
    assert np.abs(drawn - kept).mean() < 0.01


def test_the_readme_is_short_and_names_what_continuous_integration_runs():
    lines = README.splitlines()
    assert len(lines) <= 120
    assert len(README.split()) <= 900
    assert max(map(len, lines)) <= 160
    ran = re.findall(r"^make ([\w-]+)$", (ROOT / ".ci" / "run").read_text(), re.MULTILINE)
    assert ran
    assert all(f"`make {target}`" in README for target in ran)


def test_the_first_scene_of_the_readme_prints_what_it_says(in_folder):
    section = README.partition("## A first scene\n")[2].partition("\n## ")[0]
    assert [kind for kind, _ in blocks(section)] == ["toml", "sh", "text"]
    run_page(section, in_folder, slow=False)
    for model in ("tsm", "solid", "rod"):
        assert "COMPLETED" in run_line(f"crossval solve mine.toml --model {model}")

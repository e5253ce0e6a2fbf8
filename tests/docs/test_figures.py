"""The pictures in the repository are those that the pages show, and are drawn by the commands that the pages state."""

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from docs.extensions.figures import COMMANDS, FOLDER, draw
from tests.docs.snippets import ROOT

FAST = {
    command: drawn
    for command, drawn in COMMANDS.items()
    if not command.startswith(("compare", "reproduce", "trade"))
}


def test_every_picture_is_shown() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    shown = {name for page in pages for name in re.findall(r"\.figures/([\w-]+\.png)", page.read_text())}
    assert shown == {path.name for path in FOLDER.iterdir()}
    assert {name for drawn in COMMANDS.values() for name in drawn.values()} <= shown
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 1.2e6


@pytest.mark.parametrize("command", FAST)
def test_the_tutorial_shows_what_its_commands_draw(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (path,) = draw({command: FAST[command]}, tmp_path)
    assert "mine" in capsys.readouterr().out
    drawn, kept = (imread(folder / path.name)[..., :3] for folder in (tmp_path, FOLDER))
    assert drawn.shape == kept.shape
    assert np.abs(drawn - kept).mean() < 0.01

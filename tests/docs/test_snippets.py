"""Every snippet of the documentation runs and prints what the page says."""

from pathlib import Path

import pytest

from tests.docs.snippets import ROOT, SLOW, blocks, run_page, shows

FOLDER = ROOT / "docs"
LINE_BY_LINE = FOLDER / "how-to" / "commands.md"
"""Its commands are run one by one, in `test_commands.py`."""
PAGES = {
    str(path.relative_to(FOLDER)): path.read_text()
    for path in sorted(FOLDER.rglob("*.md"))
    if "_generated" not in path.parts
    and path != LINE_BY_LINE
    and any(kind for kind, _ in blocks(path.read_text()))
}
LONG = [page for page, text in PAGES.items() if any(f"\n{command}" in text for command in SLOW)]


def test_the_pages_are_found() -> None:
    assert {"tutorial.md", "how-to/scene.md", "how-to/element.md", "how-to/study.md"} <= set(PAGES)
    assert {"tutorial.md", "how-to/study.md"} <= set(LONG)
    known = {
        "python",
        "toml",
        "sh",
        "text",
        "yaml",
        "py",
        "bash",
    }  # yaml is for a CI system, py and bash for programs of others
    assert {kind for text in PAGES.values() for kind, _ in blocks(text)} <= known


@pytest.mark.slow_at(
    "how-to/accuracy.md",
    "how-to/cards.md",
    "how-to/ci-gate.md",
    "how-to/element.md",
    "how-to/material.md",
    "how-to/paraview.md",
    "how-to/program.md",
    "how-to/python.md",
    "how-to/scene.md",
    "how-to/study.md",
)
@pytest.mark.parametrize("page", PAGES)
def test_snippets(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_page(PAGES[page], tmp_path, slow=False)


@pytest.mark.slow
@pytest.mark.parametrize("page", LONG)
def test_snippets_of_many_seconds(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_page(PAGES[page], tmp_path, slow=True)


def test_output_that_differs_is_found(tmp_path: Path) -> None:
    page = "```python\nprint(1 + 1)\n```\n\n```text\n{}\n```\n"
    run_page(page.format("2"), tmp_path, slow=False)
    with pytest.raises(AssertionError, match="stated"):
        run_page(page.format("3"), tmp_path, slow=False)
    assert not shows("1\n2\n3", "1\n3")
    assert shows("1\n2\n3", "1\n...\n3")


@pytest.mark.parametrize(
    "block",
    [
        "sh\ncrossval solve no-such-scene --model tsm",
        "sh\nrm -r /",
        "sh\nmake nothing",
        "python\n1 / 0",
        "toml\n[scene]",
    ],
)
def test_a_snippet_that_fails_is_found(block: str, tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        run_page(f"```{block}\n```\n", tmp_path, slow=False)

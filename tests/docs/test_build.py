"""The site is built without a warning, shows its notebooks' figures, and loads nothing from elsewhere."""

import argparse
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from types import ModuleType

import pytest

import fem_reference
import tsm
from comparisons.cli.command import COMMANDS, command_parser
from tests.docs.snippets import ROOT

LOADED = {"script": "src", "img": "src", "iframe": "src", "source": "src", "link": "href"}


class Loaded(HTMLParser):
    """What a page loads when it is shown."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        address = dict(attrs).get(LOADED.get(tag, ""))
        if address:
            self.addresses.append(address)


def loaded_from_elsewhere(html: str) -> list[str]:
    page = Loaded()
    page.feed(html)
    inline = re.findall(r"@import\s+[\"']?(\S+)|url\([\"']?([^\"')]+)", html)
    return [a for a in [*page.addresses, *filter(None, sum(inline, ()))] if re.match(r"(https?:)?//", a)]


def test_an_address_elsewhere_is_found() -> None:
    assert loaded_from_elsewhere('<script src="https://cdn.example/x.js"></script>')
    assert loaded_from_elsewhere('<link rel="stylesheet" href="//fonts.example/f.css">')
    assert loaded_from_elsewhere("<style>@import 'https://fonts.example/f.css';</style>")
    assert not loaded_from_elsewhere('<a href="https://example.org">link</a><img src="_images/a.png">')


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site as ``make docs`` does it, in another place."""
    folder = tmp_path_factory.mktemp("site")
    makefile = (ROOT / "Makefile").read_text()
    target = re.search(r"-m sphinx (.*) -d out/docs/doctrees docs out/docs/html", makefile)
    assert target is not None
    options = target[1].split()
    assert {"-W", "-n", "--keep-going"} <= set(options)
    built = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, "-d", folder / "doctrees", "docs", folder / "html"],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr
    return folder / "html"


@pytest.mark.slow
@pytest.mark.long
def test_the_site_is_built_strictly(site: Path) -> None:
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > 25
    for page in [*pages, *site.rglob("*.css")]:
        assert loaded_from_elsewhere(page.read_text(encoding="utf-8")) == [], page
    manual = (site / "_generated" / "manual" / "index.html").read_text(encoding="utf-8")
    assert "Lee's frame" in manual.replace("\u2019", "'")
    assert manual.count(".svg") >= 20
    notebooks = sorted((site / "notebooks").glob("*.html"))
    assert len(notebooks) == len([*site.glob("_downloads/*/*.ipynb")]) == 3
    for notebook in notebooks:
        html = notebook.read_text(encoding="utf-8")
        assert "cell_output" in html
        pictures = re.findall(r'<img [^>]*src="\.\./(_images/[^"]+\.png)"', html)
        assert pictures, notebook
        assert all((site / picture).stat().st_size > 5000 for picture in pictures)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("package", [tsm, fem_reference], ids=lambda package: package.__name__)
def test_every_public_name_is_in_the_api(site: Path, package: ModuleType) -> None:
    page = (site / "api" / f"{package.__name__}.html").read_text(encoding="utf-8")
    assert [name for name in package.__all__ if f'id="{package.__name__}.{name}"' not in page] == []


@pytest.mark.slow
@pytest.mark.long
def test_every_command_and_option_is_listed(site: Path) -> None:
    page = (site / "reference" / "command-line.html").read_text(encoding="utf-8")
    [commands] = (a.choices for a in command_parser()._actions if isinstance(a, argparse._SubParsersAction))
    assert len(commands) >= len(COMMANDS)
    for name, command in commands.items():
        options = [option for action in command._actions for option in action.option_strings]
        assert [o for o in options if f'id="crossval-{name}-{o}"' not in page] == [], name

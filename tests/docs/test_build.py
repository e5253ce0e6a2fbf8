"""The site is built without a warning, and loads nothing from elsewhere."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fem_reference
import tsm
from tests.docs.snippets import ROOT

LOADED = re.compile(
    r"""<(?:script|img|iframe|source|link)\b[^>]*?\b(?:src|href)=["']?((?:https?:)?//[^"'\s>]*)"""
    r"""|@import\s+["']?((?:https?:)?//\S+)|url\(["']?((?:https?:)?//[^"')]+)"""
)
"""What a page or a style loads from elsewhere when it is shown."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site as ``make docs`` does it, in another place."""
    folder = tmp_path_factory.mktemp("site")
    makefile = (ROOT / "Makefile").read_text()
    (options,) = re.findall(r"-m sphinx (.*) -d out/docs/doctrees docs out/docs/html", makefile)
    assert {"-W", "-n", "--keep-going"} <= set(options.split())
    places = ["-d", folder / "doctrees", "docs", folder / "html"]
    command = [sys.executable, "-m", "sphinx", *options.split(), *places]
    path = {**os.environ, "PYTHONPATH": str(ROOT)}
    built = subprocess.run(command, cwd=ROOT, env=path, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    return folder / "html"


@pytest.mark.slow
@pytest.mark.long
def test_the_site_is_built_strictly_and_is_whole(site):
    pages = {str(page.relative_to(site)): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    assert len(pages) > 25
    styles = {page.name: page.read_text(encoding="utf-8") for page in site.rglob("*.css")}
    assert LOADED.search('<link rel="a" href="https://b/c.css">')
    assert [name for name, text in (pages | styles).items() if LOADED.search(text)] == []
    manual = pages["_generated/manual/index.html"]
    assert "Lee's frame" in manual.replace("\u2019", "'")
    assert manual.count(".svg") >= 20
    for package in (tsm, fem_reference):
        api = pages[f"api/{package.__name__}.html"]
        assert [name for name in package.__all__ if f'id="{package.__name__}.{name}"' not in api] == []
    listed = pages["reference/command-line.html"]
    options = ("solve---accuracy", "compare---max-error", "run---quick", "view---scale")
    assert [one for one in options if f'id="crossval-{one}"' not in listed] == []

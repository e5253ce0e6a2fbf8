"""A short comparison with its page, and a browser to look at pages."""

import io
import json
import re
import shutil
import subprocess
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, replace
from html import escape, unescape
from pathlib import Path
from typing import Any

import pytest

from comparisons.cli import main
from comparisons.scene import load_scene, to_toml

KS = replace(load_scene("ks-cantilever"), load_parameters=5)


@dataclass(frozen=True, kw_only=True)
class Compared:
    """What a comparison wrote and said."""

    folder: Path
    printed: str
    progress: str


@pytest.fixture(scope="session")
def compared(tmp_path_factory: pytest.TempPathFactory) -> Compared:
    """A comparison of `KS` by the command."""
    folder, out, err = tmp_path_factory.mktemp("compared"), io.StringIO(), io.StringIO()
    scene = folder.with_suffix(".toml")
    scene.write_text(to_toml(KS))
    with redirect_stdout(out), redirect_stderr(err):
        assert main(["compare", str(scene), "--out", str(folder)]) == 0
    return Compared(folder=folder, printed=out.getvalue(), progress=err.getvalue())


@dataclass(frozen=True, kw_only=True)
class Browser:
    """Chromium without a window."""

    program: str
    folder: Path

    def _run(self, page: Path, *flags: str) -> subprocess.CompletedProcess[str]:
        command = [
            self.program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr",
            "--virtual-time-budget=4000", f"--user-data-dir={self.folder / 'profile'}", *flags, page.as_uri(),
        ]  # fmt: skip
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)

    def told(self, page: Path, script: str, *flags: str, width: int = 1200) -> Any:
        """Run `script`, which fills the table `told`, in a copy of `page`; return the table and what the console says.

        The copy is in a frame of that width: windows are at least 500 pixels wide.
        """
        copy = self.folder / "copy.html"
        probe = (
            f"<script>{{ const told = {{}}; {script}; "
            'parent.document.getElementById("told").textContent = JSON.stringify(told); }</script></body>'
        )
        inner = escape(page.read_text().replace("</body>", probe))
        frame = f'<iframe style="border:0;width:{width}px;height:900px" srcdoc="{inner}"></iframe>'
        copy.write_text(f'<!DOCTYPE html><meta charset="utf-8"><pre id="told"></pre>{frame}')
        done = self._run(copy, "--window-size=1400,1000", "--dump-dom", *flags)
        console = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
        found = re.search(r'<pre id="told">(.*?)</pre>', done.stdout, re.DOTALL)
        assert found, done.stderr
        assert found[1], console
        return json.loads(unescape(found[1])), console

    def screenshot(self, page: Path, *flags: str, width: int = 1200, height: int = 2400) -> Path:
        """Return a picture of the page."""
        picture = self.folder / "picture.png"
        self._run(page, f"--window-size={width},{height}", f"--screenshot={picture}", *flags)
        return picture

    def printed(self, page: Path) -> Path:
        """Return the page on paper."""
        paper = self.folder / "paper.pdf"
        self._run(page, f"--print-to-pdf={paper}")
        return paper


@pytest.fixture
def browser(tmp_path: Path) -> Browser:
    """Chromium, or a skipped test."""
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("Chromium is not installed")
    return Browser(program=program, folder=tmp_path)

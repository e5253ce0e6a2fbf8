"""A short comparison with its page, and a browser to look at pages."""

import io
import json
import re
import shutil
import subprocess
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from html import escape, unescape
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from comparisons.cli import main
from comparisons.scene import load_scene, to_toml

KS = load_scene("ks-cantilever")
KS = replace(KS, load_parameters=5, beams=(replace(KS.beams[0], mesh=(16, 1)),))


class Compared(NamedTuple):
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
    return Compared(folder, out.getvalue(), err.getvalue())


class Browser(NamedTuple):
    """Chromium without a window."""

    program: str
    folder: Path

    def run(self, page: Path, *flags: str) -> subprocess.CompletedProcess[str]:
        """Show a page."""
        command = [
            self.program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr",
            "--virtual-time-budget=4000", f"--user-data-dir={self.folder / 'profile'}", *flags, page.as_uri(),
        ]  # fmt: skip
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)

    def told(self, page: Path, script: str, *flags: str, width: int = 1200) -> Any:
        """Run `script`, which fills the table `told`, in a copy of `page` of that width; return the table. The console must say nothing.

        The copy is in a frame: windows are at least 500 pixels wide.
        """
        copy = self.folder / "copy.html"
        answer = 'parent.document.getElementById("told").textContent = JSON.stringify(told);'
        probe = f"<script>{{ const told = {{}}; {script}; {answer} }}</script></body>"
        inner = escape(page.read_text().replace("</body>", probe))
        frame = f'<iframe style="border:0;width:{width}px;height:900px" srcdoc="{inner}"></iframe>'
        copy.write_text(f'<!DOCTYPE html><meta charset="utf-8"><pre id="told"></pre>{frame}')
        done = self.run(copy, "--window-size=1400,1000", "--dump-dom", *flags)
        assert [line for line in done.stderr.splitlines() if ":CONSOLE" in line] == []
        found = re.search(r'<pre id="told">(.*?)</pre>', done.stdout, re.DOTALL)
        assert found, done.stderr
        return json.loads(unescape(found[1]))


@pytest.fixture
def browser(tmp_path: Path) -> Browser:
    """Chromium, or a skipped test."""
    program = shutil.which("chromium") or pytest.skip("Chromium is not installed")
    return Browser(program, tmp_path)

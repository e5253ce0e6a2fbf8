"""What a person sees while a scene is solved, and what a shell completes."""

import io
import re
import subprocess
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.cli import progress as shown
from comparisons.cli.command import command_parser
from comparisons.cli.completion import FILES, arguments
from comparisons.cli.progress import staging, watching
from comparisons.models import solve
from comparisons.models.options import Options
from comparisons.models.progress import Reached
from comparisons.scene import load_scene

SCENE = replace(load_scene("ks-cantilever"), load_parameters=4)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("model", "options"), [("tsm", Options(elements=10)), ("solid", Options(mesh=(16, 1)))]
)
def test_every_load_parameter_is_told_of(model: str, options: Options) -> None:
    reported: list[Reached] = []
    response = solve(SCENE, model, options, reported.append)
    times = [reached.load_parameter for reached in reported]
    assert times == sorted(times)
    assert set(response.load_parameter) <= set(times)
    assert sum(reached.iterations for reached in reported) == response.newton_iterations.sum()
    place = r"pin->cantilever on element \d+ of 10" if model == "tsm" else r"pin->cantilever at 0\.\d+"
    assert all(re.fullmatch(place, contact) for reached in reported for contact in reached.contacts)
    assert reported[-1].contacts


def test_the_element_is_that_of_the_contact() -> None:
    reported: list[Reached] = []
    response = solve(SCENE, "tsm", Options(elements=10), reported.append)
    arc = response.contacts["pin->cantilever"].arc_position[-1]
    assert reported[-1].contacts == (f"pin->cantilever on element {int(10 * arc) + 1} of 10",)


def test_a_bar_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shown, "REDRAW", 0.0)
    monkeypatch.setenv("COLUMNS", "200")
    stream = Terminal()
    with watching("solid", stream=stream) as watch:
        watch(Reached(0.5, 7, ("pin->beam on element 3 of 10",)))
        watch(Reached(1.0, 5, ()))
    pictures = [picture.removesuffix("\x1b[K") for picture in stream.getvalue().split("\r")]
    assert pictures == [
        "",
        "solid [###############...............] t = 0.5000, 7 iterations, pin->beam on element 3 of 10",
        f"solid [{30 * '#'}] t = 1.0000, 12 iterations",
        "",
    ]


def test_a_bar_fits_into_its_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shown, "REDRAW", 0.0)
    monkeypatch.setenv("COLUMNS", "40")
    stream = Terminal()
    with watching("solid", stream=stream) as watch:
        watch(Reached(0.5, 7, ("pin->beam on element 3 of 10",)))
    assert max(len(picture) for picture in stream.getvalue().replace("\x1b[K", "").split("\r")) == 39


@pytest.mark.parametrize(("stream", "quiet"), [(io.StringIO(), False), (Terminal(), True)])
def test_nothing_elsewhere_and_where_it_is_quiet(stream: io.StringIO, quiet: bool) -> None:
    with watching("solid", quiet=quiet, stream=stream) as watch:
        watch(Reached(0.5, 7, ()))
    assert stream.getvalue() == ""


@pytest.mark.parametrize("patience", [0.0, 1e9])
def test_a_stage_is_a_line_and_a_bar_once_it_takes_long(
    patience: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shown, "REDRAW", 0.0)
    monkeypatch.setattr(shown, "PATIENCE", patience)
    stream = Terminal()
    with staging("drawing 4 pictures", stream=stream) as count:
        count(1, 4)
        count(4, 4)
    pictures = [picture.removesuffix("\x1b[K") for picture in stream.getvalue().split("\r")]
    bars = ["[#######.......................] 1 of 4", f"[{30 * '#'}] 4 of 4"]
    assert pictures == ["drawing 4 pictures\n", *(bars if patience == 0.0 else []), ""]


@pytest.mark.parametrize(("quiet", "said"), [(False, "drawing\n"), (True, "")])
def test_a_stage_elsewhere_is_a_line_unless_it_is_quiet(
    quiet: bool, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shown, "PATIENCE", 0.0)
    stream = io.StringIO()
    with staging("drawing", quiet=quiet, stream=stream) as count:
        count(1, 4)
    assert stream.getvalue() == said


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_completion(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert "doctor" in script
    # of tcsh only commands are completed
    assert ("--accuracy" in script) == (shell != "tcsh")


@pytest.fixture(scope="module")
def bash_script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    script = tmp_path_factory.mktemp("completion") / "crossval"
    out = io.StringIO()
    with redirect_stdout(out):
        assert main(["completion", "bash"]) == 0
    script.write_text(out.getvalue())
    return script


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("sol", {"solve"}),
        ("solve tip", {"tip-load"}),
        ("solve m", {"mine.toml", "more"}),
        ("compare williams", {"williams-toggle"}),
        ("view double-beam-", {"double-beam-friction"}),
        ("solve tip-load --model el", {"elastica"}),
        ("solve tip-load --element ex", {"exact"}),
        ("study loc", {"locking"}),
        ("certify m", {"mine.toml", "more", "mine.json"}),
        ("manual --only eu", {"euler-column"}),
        ("compare tip-load --out m", {"more"}),
    ],
)
def test_bash_completes(line: str, words: set[str], bash_script: Path, tmp_path: Path) -> None:
    for name in ("mine.toml", "mine.json", "mine.txt"):
        (tmp_path / name).touch()
    (tmp_path / "more").mkdir()
    typed = line.split()
    ask = f"source {bash_script}; COMP_WORDS=(crossval {line}); COMP_CWORD={len(typed)}; _shtab_crossval; echo ${{COMPREPLY[*]}}"
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert set(done.stdout.split()) == words, done.stderr


def test_the_shell_knows_what_every_value_can_be() -> None:
    values = {
        str(action.metavar)
        for action in arguments(command_parser())
        if action.nargs != 0 and action.choices is None
    }
    unknown_to_the_shell = {"ADDRESS", "FACTOR", "N", "NAME", "NXxNY", "QUANTITY=X", "X"}
    assert {*FILES, *unknown_to_the_shell} <= values
    assert values <= {*FILES, *unknown_to_the_shell, "ELEMENT", "PROBLEM"}

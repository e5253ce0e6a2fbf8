"""What a person sees while a scene is solved."""

import io
import re
from contextlib import redirect_stderr, redirect_stdout, suppress
from dataclasses import replace

import pytest

from comparisons.cli import main
from comparisons.cli import screen as shown  # its clock: a command draws what its own speed lets it
from comparisons.models import solve
from comparisons.models.model import Options, Reached
from comparisons.scene import load_scene

SCENE = replace(load_scene("ks-cantilever"), load_parameters=4)


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True

    @property
    def pictures(self) -> list[str]:
        return [picture.removesuffix("\x1b[K") for picture in self.getvalue().split("\r")]


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shown, "REDRAW", 0.0)
    monkeypatch.setattr(shown, "PATIENCE", 0.0)


@pytest.mark.parametrize("options", [Options(elements=10), Options(mesh=(16, 1))], ids=["tsm", "solid"])
def test_every_load_parameter_is_told_with_its_contacts(options):
    model = "solid" if options.mesh else "tsm"
    reported: list[Reached] = []
    response = solve(SCENE, model, options, reported.append)
    times = [reached.load_parameter for reached in reported]
    assert times == sorted(times)
    assert set(response.load_parameter) <= set(times)
    assert sum(reached.iterations for reached in reported) == response.newton_iterations.sum()
    arc = response.contacts["pin->cantilever"].arc_position[-1]
    place = f"on element {int(10 * arc) + 1} of 10" if model == "tsm" else r"at 0\.\d+"
    assert re.fullmatch(f"pin->cantilever {place}", reported[-1].contacts[0])


def test_a_bar_on_a_terminal_fits_into_it(monkeypatch):
    whole = f"solid [{15 * '#'}{15 * '.'}] t = 0.5000, 7 iterations, pin->beam on element 3 of 10"
    monkeypatch.setenv("COLUMNS", "40")
    stream = Terminal()
    with redirect_stderr(stream), shown.watching("solid") as watch:
        watch(Reached(0.5, 7, ("pin->beam on element 3 of 10",)))
        watch(Reached(1.0, 5, ()))
    last = f"solid [{30 * '#'}] t = 1.0000, 12 iterations"[:39]
    assert stream.pictures == ["", whole[:39], last, ""]


@pytest.mark.parametrize("mistake", ["--elements 0", "--model nothing", "--elements x"])
def test_a_message_on_a_terminal_fits_into_it_and_is_one_line_elsewhere(monkeypatch, mistake):
    monkeypatch.setenv("COLUMNS", "60")
    folded, whole = Terminal(), io.StringIO()
    for stream in (folded, whole):
        with redirect_stderr(stream), suppress(SystemExit):
            assert main(["solve", "ks-cantilever", *mistake.split()]) == 2
    assert max(map(len, folded.getvalue().splitlines())) <= 60
    message = whole.getvalue().splitlines()[-1]
    assert len(message) > 60
    assert " ".join(folded.getvalue().split()).endswith(message)


@pytest.mark.parametrize(
    "command",
    [
        *("scenes", "check hysteresis", "solve ks-cantilever", "certify tip-load"),
        pytest.param("compare tip-load --quiet --out page", marks=pytest.mark.slow),
    ],
)
def test_what_is_printed_fits_the_terminal_and_no_word_is_broken(command, in_folder, monkeypatch):
    """Only what is found is bold, and only on a terminal that may have it."""
    said: list[set[str]] = []
    for columns, refused in ((80, ""), (100, "1"), (130, "1"), (130, "piped")):
        stream = io.StringIO() if refused == "piped" else Terminal()
        monkeypatch.setenv("COLUMNS", str(columns))
        monkeypatch.setenv("NO_COLOR", refused.removeprefix("piped"))
        with redirect_stdout(stream):
            assert main(command.split()) == 0
        lines = re.sub(r"\x1b\[[01]m", "", stream.getvalue()).splitlines()
        bold = not said and command.startswith("compare")
        assert bold == stream.getvalue().startswith("\x1b[1m") == ("\x1b" in stream.getvalue())
        assert max(map(len, lines)) <= columns or not stream.isatty()
        said.append({*re.sub(r"\b\d+\.\d{3}\b", "", " ".join(lines)).split()})  # without seconds
        assert said[-1] == said[0]


@pytest.mark.parametrize("quiet", [False, True])
def test_without_a_terminal_there_are_lines_and_where_it_is_quiet_nothing(quiet):
    stream = Terminal() if quiet else io.StringIO()
    with redirect_stderr(stream), shown.watching("solid", quiet=quiet) as watch:
        watch(Reached(0.5, 7, ()))
    with redirect_stderr(stream), shown.staging("drawing", quiet=quiet) as count:
        count(1, 4)
    assert stream.getvalue() == ("" if quiet else "drawing\n")

"""What a person sees of a run."""

import io
import re

import pytest

from comparisons.cases.progress import clock, line, line_ended, shown
from comparisons.cases.run import Tally


def tally(done: int, failed: int = 0, total: int = 40) -> Tally:
    left = float("nan") if not done else (total - done) * 2.5
    return Tally(total=total, done=done, failed=failed, statuses={}, seconds=done * 2.5, left=left, older={})


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_line_and_clock() -> None:
    assert line(tally(0)) == "0 of 40 cases done, 0 failed"
    assert line(tally(10, 2)) == "10 of 40 cases done, 2 failed, 1:15 left"
    assert line(tally(40, 2)) == "40 of 40 cases done, 2 failed"
    assert (clock(0.2), clock(59.9), clock(3725)) == ("0:01", "1:00", "1:02:05")


def test_a_bar_on_a_terminal() -> None:
    stream = Terminal()
    show = shown(stream)
    for done in (0, 10, 40):
        show(tally(done, 1))
    pictures = stream.getvalue().split("\r")[1:]
    assert [picture.count("#") for picture in pictures] == [0, 7, 30]
    assert "10 of 40 cases done, 1 failed, 1:15 left" in pictures[1]
    assert pictures[-1].endswith("\n")


def test_lines_elsewhere() -> None:
    stream = io.StringIO()
    show = shown(stream)
    for done in range(41):
        show(tally(done))
    lines = stream.getvalue().splitlines()
    assert len(lines) == 11
    assert all(re.match(r"\d+ of 40 cases done, 0 failed", text) for text in lines)


@pytest.mark.parametrize("stream", [Terminal(), io.StringIO()])
def test_nothing_where_it_is_quiet(stream: io.StringIO) -> None:
    show = shown(stream, quiet=True)
    for done in range(41):
        show(tally(done))
    assert stream.getvalue() == ""


@pytest.mark.parametrize(("stream", "ended"), [(Terminal(), "\n"), (io.StringIO(), "")])
def test_an_exception_ends_the_line_of_the_bar(stream: io.StringIO, ended: str) -> None:
    with pytest.raises(KeyboardInterrupt), line_ended(stream):
        raise KeyboardInterrupt
    assert stream.getvalue() == ended

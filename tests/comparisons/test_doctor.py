"""``crossval doctor``: what is there, what is missing and what for."""

import os
from importlib import metadata

import pytest

from comparisons.cli import machine as doctor
from comparisons.cli import main

Output = pytest.CaptureFixture[str]


def looked_at(capsys: Output) -> list[tuple[str, ...]]:
    return [tuple(line.split(maxsplit=2)) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.slow
def test_everything_needed_is_here(capsys: Output) -> None:
    assert main(["doctor"]) == 0
    lines = looked_at(capsys)
    assert ("ok", "numpy", metadata.version("numpy")) in lines
    assert lines[-1][1] == "OpenGL"
    if os.environ.get("CI") == "true":
        assert [line for line in lines if line[0] != "ok"] == []


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, capsys: Output) -> None:
    monkeypatch.setattr(doctor, "NEEDED", ("numpy", "no-such-distribution"))
    monkeypatch.setattr(doctor, "PROGRAMS", {"no-such-program": "what it is for"})
    monkeypatch.setattr("comparisons.show.render.renders", lambda: False)
    assert main(["doctor"]) == 1
    mark = {what: (mark, state) for mark, what, state in looked_at(capsys)}
    assert mark["no-such-distribution"] == ("MISSING", "missing")
    assert mark["no-such-program"] == ("-", "missing, what it is for")
    assert mark["OpenGL"][0] == "-"
    assert "matplotlib" in mark["OpenGL"][1]

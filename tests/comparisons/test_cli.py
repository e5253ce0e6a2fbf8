"""The command ``crossval``: exit statuses, messages, files; never a traceback."""

import json
import re
import subprocess
import sys
import tomllib
from importlib import import_module, metadata
from pathlib import Path

import pytest

# the table of the commands: that it is whole is the contract
from comparisons.cli.command import STATED
from comparisons.scene import built_in_scenes
from tests.comparisons.suite.conftest import crossval

KS = built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 4")
BIN = Path(sys.executable).parent


def run(line: str) -> int:
    return crossval(*line.split())


def test_the_table_of_commands_is_whole_and_its_old_names_are_gone():
    commands = {name: stated["arguments"].split() for name, stated in STATED["command"].items()}
    named = [argument for arguments in commands.values() for argument in arguments]
    options = [argument.partition("=")[0] for argument in named if argument.startswith("-")]
    assert all(callable(import_module(f"comparisons.cli.{name}").run) for name in commands)
    assert set(named) == STATED["argument"].keys()
    assert len(["--version", *options]) <= 35
    assert not STATED["gone"].keys() & {*commands, *options}
    for line in STATED["gone"].values():
        assert {*re.findall(r"--[a-z-]+", line)} <= {"--version", "--help", *options}
        assert {*re.findall(r"crossval ([a-z]+)", line)} <= commands.keys()


def test_solve_to_an_accuracy(in_folder, capsys, monkeypatch):
    Path("my.toml").write_text(KS)
    monkeypatch.setenv("COLUMNS", "150")
    assert run("solve my.toml --accuracy 1e-3") == 0
    out, err = capsys.readouterr()
    assert "tsm: exact elements, one a beam, 10 unknowns" in out
    assert "beam theory itself" in out
    assert "exact rods suffice" in err
    assert run("solve my.toml --accuracy arc=1e-4 --element mixed --out -") == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["accuracy"]["quantity"], data["accuracy"]["reached"]) == ("arc", True)
    assert 0 < data["accuracy"]["estimate"] <= 1e-4
    assert data["unknowns"] > 10
    assert run("solve my.toml --accuracy 1e-12") == 3
    assert "ACCURACY_NOT_REACHED: estimated error" in capsys.readouterr().err


def test_an_answer_on_standard_output_is_alone_there(in_folder, capsys):
    Path("my.toml").write_text(KS)
    assert run("solve my.toml --elements 4 --quiet --out - --out a.json") == 0
    assert json.loads(capsys.readouterr().out) == json.loads(Path("a.json").read_text())


def test_the_version_names_what_is_missing_and_the_extra_that_installs_it(monkeypatch, capsys):
    version = metadata.version

    def only_numpy(name: str) -> str:
        if name not in ("numpy", "tsm-crossval"):
            raise metadata.PackageNotFoundError(name)
        return version(name)

    monkeypatch.setattr(metadata, "version", only_numpy)
    monkeypatch.setenv("PATH", "")
    assert run("--version") == 1
    release, *listed = capsys.readouterr().out.splitlines()
    assert release == f"crossval {version('tsm-crossval')}"
    lines = [line.split(maxsplit=2) for line in listed]
    found = {what: (mark, state) for mark, what, state in lines}
    assert (found["numpy"], found["scipy"]) == (("ok", version("numpy")), ("MISSING", "missing"))
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    own = [(name, line) for name in ("cluster", "peers") for line in extras[name]]
    stated = {(re.split(r"[>=\[]", line)[0], name) for name, line in own}
    told = {(what, re.match(r"missing, extra (\w+): ", state)) for what, (_, state) in found.items()}
    assert {(what, extra[1]) for what, extra in told if extra} == stated


@pytest.mark.slow
def test_the_installed_command_runs_and_a_reader_that_stops_early_is_no_error():
    command = "crossval solve ks-cantilever --model rod --out - | head -1"
    path = {"PATH": f"{BIN}:/usr/bin:/bin"}
    bash = ["bash", "-o", "pipefail", "-c", command]
    done = subprocess.run(bash, capture_output=True, text=True, env=path, check=True)
    assert (done.stdout.strip(), done.stderr) == ("{", "")

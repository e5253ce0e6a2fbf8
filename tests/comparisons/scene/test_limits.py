"""Extreme numbers and odd files: one line, exit status 2, nothing computed, and soon."""

import os
from pathlib import Path
from time import monotonic

import pytest

from comparisons.cli import main
from comparisons.scene import built_in_scenes
from comparisons.scene.tables import DEEPEST, LARGEST_FILE

KS = built_in_scenes()["ks-cantilever"]
END, START, MODULUS = "end = [1.0, 0.0]", "start = [0.0, 0.0]", "youngs_modulus = 2.1e4"
EXTREME = {
    "far end": (END, "end = [1e155, 0]", "beam[0].end = [1e+155, 0]: must be at most 1e+50 in size"),
    "far start": (START, "start = [-1e308, 0]", "beam[0].start = [-1e+308, 0]: must be at most 1e+50 in size"),
    "short": (END, "end = [1e-320, 0]", "beam[0].end = [1e-320, 0.0]: must differ from start, the distance"),
    "stiff": (MODULUS, "youngs_modulus = 1e308", "beam[0].youngs_modulus = 1e+308: must lie between 1e-100 and 1e+100"),
    "soft": (MODULUS, "youngs_modulus = 5e-324", "beam[0].youngs_modulus = 5e-324: must lie between 1e-100 and 1e+100"),
    "soft in bending": (MODULUS, "youngs_modulus = 1e-95", "beam[0].youngs_modulus = 1e-95: EI = 1.33333e-103 must lie between"),
    "far pin": ("start = [1.0, 0.0]", "start = [1e300, 0]", "pin[0].start = [1e+300, 0]: must be at most 1e+50 in size"),
    "deep key": ("[[pin]]", "a." * 20_000 + "a = 1\n[[pin]]", f"must be valid TOML: a key has more than {DEEPEST} parts"),
    "deep header": ("[[pin]]", "[" + "'b' . " * 20_000 + "a]\n[[pin]]", f"must be valid TOML: a key has more than {DEEPEST} parts"),
    "deep inline key": ("[[pin]]", "x = {" + '"". ' * 20_000 + "a = 1}\n[[pin]]", f"must be valid TOML: a key has more than {DEEPEST} parts"),
    "deep list": ("[[pin]]", "x = " + "[" * 20_000 + "]" * 20_000 + "\n[[pin]]", "must be valid TOML: "),
    "half deep key": ("[[pin]]", "a." * (DEEPEST - 1) + "a = 1\n[[pin]]", "beam[0].a = {a = "),
    "many steps": ("load_parameters = 50 ", "load_parameters = 100_000 ", "tsm: load_parameters = 100000: with 100000 elements and 1 contacts needs 6.5e+03 GB"),
}  # fmt: skip


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str], lines: int = 1) -> str:
    began = monotonic()
    assert main(arguments) == 2
    assert monotonic() - began < 20
    out, err = capsys.readouterr()
    assert out == ""
    assert all(line.startswith("crossval: ") for line in err.splitlines())
    assert err.count("\n") == lines
    return err


@pytest.mark.parametrize("case", EXTREME)
def test_an_extreme_scene_is_refused(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    old, new, sentence = EXTREME[case]
    assert KS.count(old) == 1 or case == "far pin"
    text = KS.replace(old, new)
    if case == "many steps":
        text = text.replace("elements = 20 ", "elements = 100_000 ")
    file = tmp_path / "my.toml"
    file.write_text(text)
    assert sentence in refused(["solve", str(file), "--model", "tsm", "--element", "mixed"], capsys)


@pytest.mark.parametrize(
    "text", ["a" * 300_000, "a." * 49 + "\n", "'" * 100_000, "# " + "." * 100_000, '"a"' * 50_000]
)
def test_looking_for_deep_keys_takes_no_time(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "my.toml"
    file.write_text(text)
    empty = text.startswith("#")
    assert "parts" not in refused(["solve", str(file), "--model", "tsm"], capsys, lines=2 if empty else 1)


def odd(kind: str, folder: Path) -> str:
    file = folder / "my.toml"
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "large":
        with file.open("wb") as sparse:
            sparse.write(KS.encode())
            sparse.truncate(100 * LARGEST_FILE)
    else:
        return kind
    return str(file)


@pytest.mark.parametrize(
    ("kind", "sentence"),
    [
        ("/dev/zero", "cannot be read: is not a regular file"),
        ("pipe", "cannot be read: is not a regular file"),
        ("large", "cannot be read: has more than 16 MB"),
    ],
)
@pytest.mark.parametrize("command", ["solve", "check", "study"])
def test_an_odd_file_is_not_read(
    kind: str, sentence: str, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name = odd(kind, tmp_path)
    more = {"solve": ["--model", "tsm"], "check": [], "study": ["--out", str(tmp_path / "out")]}[command]
    assert refused([command, name, *more], capsys) == f"crossval: {name}: {sentence}\n"


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve", "{}.toml", "--model", "tsm"],
        ["check", "{}.toml"],
        ["study", "{}.toml"],
        ["results", "{}.sqlite"],
        ["view", "./{}"],
        ["solve", "ks-cantilever", "--model", "tsm", "--vtk", "/proc/{}"],
        ["solve", "ks-cantilever", "--model", "tsm", "--json", "/proc/{}/a.json"],
    ],
)
def test_a_name_commands_no_terminal(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    name = "a\x1b[31m\n\u202eb\udcff"
    err = refused([part.format(name) for part in arguments], capsys)
    assert r"a\x1b[31m\n\u202eb\udcff" in err or r"a\x1b[31m \u202eb\udcff" in err
    assert err.rstrip("\n").isprintable()


def test_an_argument_commands_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["solve", "ks-cantilever", "\x1b[31m"])
    assert capsys.readouterr().err.endswith("error: unrecognized arguments: \\x1b[31m\n")

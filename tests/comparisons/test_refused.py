"""What the command refuses: exit status 2, one line that says why, and no file written or changed."""

import tomllib
from pathlib import Path

import pytest

from comparisons.scene import built_in_scenes
from tests.comparisons.suite.conftest import crossval

REFUSED = tomllib.loads(Path(__file__).with_name("refused.toml").read_text(encoding="utf-8"))
"""Parts of the line by commands; and studies and files of programs by parts of the line."""
KS = built_in_scenes()["ks-cantilever"].replace("load_parameters = 50", "load_parameters = 4")
STUDY = '[study]\nname = "mine"\nscene = "ks-cantilever"\nrepeats = 1\n[[run]]\nmodel = "tsm"\n'
FILES = {"my.toml": KS, "there.toml": KS.replace('side = "right"', 'side = "below"'), "study.toml": STUDY}
FILES["many.toml"] = KS.replace("load_parameters = 4", "load_parameters = 100_000")
CASES = [
    *((line, said, {}) for line, said in REFUSED["commands"].items()),
    *(("run my.toml --out out", f"my.toml: {said}", {"my.toml": STUDY + text}) for said, text in REFUSED["runs"].items()),
    *(("run my.toml --out out", said, {"my.toml": text}) for said, text in REFUSED["studies"].items()),
    *(("solve ks-cantilever --model my.toml", said, {"my.toml": text}) for said, text in REFUSED["programs"].items()),
]  # fmt: skip


@pytest.mark.parametrize(
    ("line", "said", "changed"), CASES, ids=[f"{line} {said}" for line, said, _ in CASES]
)
def test_what_is_refused_is_one_line_and_no_file(line, said, changed, in_folder, capsys):
    for name, text in (files := FILES | changed).items():
        Path(name).write_text(text)
    assert crossval(*line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert [one for one in err.splitlines() if one.startswith("crossval")] == err.splitlines()[-1:]
    assert said in err.splitlines()[-1]
    assert {path.name: path.read_text() for path in in_folder.iterdir()} == files

"""The results as records, as a table and as CSV."""

import csv
import io
import sqlite3
import zlib
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons.cases.case import Case
from comparisons.cases.measure import Measurement, measure
from comparisons.cases.results import read_results, result_rows, result_table, varied
from comparisons.cases.settings import in_order, settings
from comparisons.cases.store import Store
from comparisons.cli import main
from comparisons.models.options import Options
from comparisons.scene import Scene, load_scene, to_toml
from comparisons.version import version

KS = replace(load_scene("ks-cantilever"), load_parameters=2)


def thick(height: float) -> Scene:
    return replace(KS, beams=(replace(KS.beams[0], height=height),))


CASES = [
    Case(scene=thick(0.03), model="tsm", options=Options(elements=10)),
    Case(scene=thick(0.03), model="tsm", options=Options(elements=4)),
    Case(scene=thick(0.01), model="tsm", options=Options(elements=4)),
    Case(scene=thick(0.01), model="solid", options=Options(mesh=(10, 1))),
    Case(scene=thick(0.01), model="rod"),
    Case(scene=thick(0.01), model="tsm", options=Options(integration_tolerance=1e-9)),
]


@pytest.fixture(scope="module")
def measured() -> list[Measurement]:
    return [measure(case, repeats=1) for case in CASES]


@pytest.fixture
def file(tmp_path: Path, measured: list[Measurement]) -> Path:
    with Store(tmp_path / "a.sqlite") as store:
        for case, measurement in zip(CASES, measured, strict=True):
            store.record(case.key, case, measurement)
    return tmp_path / "a.sqlite"


@pytest.mark.slow
def test_rows_are_sorted_by_what_varies(file: Path, measured: list[Measurement]) -> None:
    found = read_results(file)
    assert varied(found) == ["elements", "integration_tolerance", "mesh", "beam.height"]
    rows = result_rows(found)
    shown = [(row["model"], row["elements"], row["mesh"], row["beam.height"]) for row in rows]
    assert shown == [
        ("rod", None, None, 0.01),
        ("solid", None, "10x1", 0.01),
        ("tsm", None, None, 0.01),
        ("tsm", 4, None, 0.01),
        ("tsm", 4, None, 0.03),
        ("tsm", 10, None, 0.03),
    ]
    last = rows[-1]
    assert last["force:pin->cantilever"] == measured[0].response.contacts["pin->cantilever"].force[-1]
    assert last["tip_y:cantilever"] == measured[0].response.tips["cantilever"][-1, 1]
    assert (last["seconds"], last["peak_memory"]) == (measured[0].seconds, measured[0].peak_memory)
    assert (rows[2]["status"], rows[2]["verdict"]) == ("REFUSED", "")
    assert last["verdict"] == "CERTIFIED"
    assert rows[2]["force:pin->cantilever"] is None


def test_the_order_of_recording_does_not_matter(
    file: Path, tmp_path: Path, measured: list[Measurement]
) -> None:
    with Store(tmp_path / "b.sqlite") as store:
        for case, measurement in reversed(list(zip(CASES, measured, strict=True))):
            slower = replace(measurement, seconds=measurement.seconds + 1, peak_memory=7)
            store.record(case.key, case, slower)
    one, other = read_results(file), read_results(tmp_path / "b.sqlite")
    assert result_rows(one) != result_rows(other)
    assert result_rows(one, timings=False) == result_rows(other, timings=False)


def test_the_command_prints_a_table_or_csv(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["results", str(file)]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[0].split()[:4] == ["model", "elements", "integration_tolerance", "mesh"]
    assert out.splitlines()[-1].startswith("ks-cantilever, tsm mixed 20 tolerance 1e-09: REFUSED: tsm: ")
    assert main(["results", str(file), "--csv"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert len(rows) == len(CASES)
    assert (
        float(rows[-1]["force:pin->cantilever"])
        == result_rows(read_results(file))[-1]["force:pin->cantilever"]
    )
    assert main(["results", str(file), "--csv", "--no-timings"]) == 0
    header = capsys.readouterr().out.splitlines()[0].split(",")
    assert set(rows[0]) - set(header) == {"seconds", "repeats", "peak_memory"}


def test_several_scenes_and_none(tmp_path: Path, measured: list[Measurement]) -> None:
    with Store(tmp_path / "a.sqlite") as store:
        assert result_table(read_results(store.path)) == "no results yet"
        for scene in (KS, replace(load_scene("ks-face"), load_parameters=2)):
            case = Case(scene=scene, model="tsm")
            store.record(case.key, case, measured[0])
        found = read_results(store.path)
    assert varied(found) == []
    assert [row["scene"] for row in result_rows(found)] == ["ks-cantilever", "ks-face"]
    assert result_table(found).startswith("scene")


def test_settings_have_the_names_of_study_files() -> None:
    scene = load_scene("double-beam")
    found = settings(to_toml(scene), '{"element": "mixed"}')
    assert found["element"] == "mixed"
    assert found["scene.load_parameters"] == scene.load_parameters
    assert found["beam.upper.elements"] == 10
    assert found["contact.upper.end->lower.side"] == "left"
    assert found["pin.start"] == [0.8, 0.0]


def test_order_of_values_of_any_kind() -> None:
    values = ["b", 10, None, [50, 2], 9.5, "a", [6, 1], True]
    ordered = sorted(values, key=lambda value: in_order([value]))
    assert ordered == [None, True, 9.5, 10, "a", "b", [6, 1], [50, 2]]


@pytest.mark.parametrize(
    "blob",
    [b"", b"mine", zlib.compress(b"{}"), zlib.compress(b"[1]"), zlib.compress(b"\xff"), "text", None, 7],
)
def test_a_damaged_result_is_one_line(blob: object, file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with closing(sqlite3.connect(file)) as connection, connection:
        if blob is None:
            connection.execute(
                "UPDATE result SET measurement = substr(measurement, 1, 40) WHERE model = 'rod'"
            )
        else:
            connection.execute("UPDATE result SET measurement = ? WHERE model = 'rod'", (blob,))
    assert main(["results", str(file)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert (
        captured.err == f"crossval: {file}: cannot be read: the result of 'ks-cantilever, rod' is damaged\n"
    )


def test_versions_are_shown(file: Path) -> None:
    assert f"\nversion {version()}\n" in result_table(read_results(file))
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute("UPDATE result SET version = '0.1.0' WHERE model = 'rod'")
    text = result_table(read_results(file))
    assert f"\nversion 0.1.0, {version()}\n" in text
    assert text.splitlines()[0].endswith("version")
    assert text.splitlines()[1].endswith("0.1.0")

"""The page in Chromium: slider, switches, keys, narrow and dark screens, paper; no error on the console."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.models import solve
from comparisons.scene import SupportSpec, read_scene
from comparisons.show.pages import Section, motion_section, page, tracks
from tests.comparisons.show.pages.conftest import KS, Browser, Compared
from tests.comparisons.show.specimen import SPECIMEN

pytestmark = pytest.mark.slow
MOVED = SupportSpec(beam="hook", end="start", kind="clamped", displacement=(0.0, 3.0))

HELPERS = """
const one = (selector) => document.querySelector(selector);
const shape = (n) => one(`.shapes [data-run="${n}"]`).getAttribute("points");
const state = () => ({
  output: one("output").textContent, value: one("input[type=range]").value, shapes: [0, 1, 2, 8].map(shape),
  zoom: one(".zoom [data-run='1']").getAttribute("points"), star: one(".shapes .pin").getAttribute("points"),
  table: [...document.querySelectorAll(".values tbody tr")].map((row) => [...row.children].map((cell) => cell.textContent)),
  vtu: [...document.querySelectorAll(".vtu a")].map((link) => link.getAttribute("href")),
  cursor: one(".chart .cursor").getAttribute("x1"),
});
const slide = (k) => {
  one("input[type=range]").value = k;
  one("input[type=range]").dispatchEvent(new Event("input", { bubbles: true }));
};
const seen = (n) => [".shapes", ".zoom", ".chart"].map((drawing) => getComputedStyle(one(`${drawing} [data-run="${n}"]`)).display !== "none");
"""


def told(browser: Browser, folder: Path, script: str, *flags: str, width: int = 1200) -> dict:
    found, console = browser.told(folder / "report.html", HELPERS + script, *flags, width=width)
    assert console == []
    return found


def written(folder: Path, *sections: Section) -> Path:
    (folder / "report.html").write_text(page("t", "", sections))
    return folder


def test_the_slider_moves_shapes_marks_and_values(browser: Browser, compared: Compared) -> None:
    script = "told.end = state(); slide(3); told.fourth = state(); slide(4); told.again = state();"
    found = told(browser, compared.folder, script)
    end, fourth = found["end"], found["fourth"]
    assert found["again"] == end
    assert (end["output"], fourth["output"]) == ("t = 1", "t = 0.8")
    assert end["value"] == "4"
    for name in ("zoom", "star", "cursor"):
        assert end[name] != fourth[name]
    assert all(a != b for a, b in zip(end["shapes"], fourth["shapes"], strict=True))
    assert fourth["vtu"] == ["tsm/tsm-0004.vtm", "solid/solid-0004.vtm"]
    assert all((compared.folder / name).is_file() for name in fourth["vtu"])
    runs = {run["label"]: run for run in json.loads((compared.folder / "summary.json").read_text())["runs"]}
    assert {row[0] for row in fourth["table"]} == set(runs)
    for label, force, _, arc, _, moment, _, _, _ in fourth["table"]:
        contact, support = (runs[label][kind].values() for kind in ("contacts", "supports"))
        stated = [values[3] for one in contact for values in (one["force"], one["arc_position"])]
        stated += [one["moment"][3] for one in support]
        assert [float(force), float(arc), float(moment)] == pytest.approx(stated, rel=6e-5)


def test_switches_hide_and_show_a_run_everywhere(browser: Browser, compared: Compared) -> None:
    script = """
    const box = (n) => one(`[data-switch="${n}"]`);
    told.before = [0, 1].map(seen); box(1).click(); told.off = [0, 1].map(seen);
    slide(2); told.moved = [0, 1].map(seen); box(1).click(); told.on = [0, 1].map(seen);
    """
    found = told(browser, compared.folder, script)
    assert found["before"] == found["on"] == [[True] * 3] * 2
    assert found["off"] == found["moved"] == [[True] * 3, [False] * 3]


def test_charts_follow_the_keys_and_the_pointer(browser: Browser, compared: Compared) -> None:
    script = """
    const chart = one(".chart"), key = (name) => chart.dispatchEvent(new KeyboardEvent("keydown", { key: name, cancelable: true }));
    const value = () => Number(one("input[type=range]").value);
    key("ArrowLeft"); told.left = value(); key("Home"); told.home = value(); key("ArrowLeft"); told.still = value();
    key("End"); told.end = value();
    const frame = chart.getBoundingClientRect();
    const point = (part) => chart.dispatchEvent(new PointerEvent("pointermove", {
      pointerType: "mouse", clientX: frame.left + 64 + part * (frame.width - 78) }));
    point(0.6); told.half = one("output").textContent; point(0.0); told.first = one("output").textContent;
    """
    found = told(browser, compared.folder, script)
    assert [found[name] for name in ("left", "home", "still", "end")] == [3, 0, 0, 4]
    assert (found["half"], found["first"]) == ("t = 0.6", "t = 0.2")


def test_play_runs_to_the_end_and_stops(browser: Browser, compared: Compared) -> None:
    script = """
    let steps = 0, fire = null;
    window.setInterval = (call) => { fire = call; return 1; };
    window.clearInterval = () => { fire = null; };
    const play = one(".play");
    play.click(); told.pressed = play.getAttribute("aria-pressed"); told.start = one("output").textContent;
    while (fire && steps < 100) { fire(); steps++; }
    told.steps = steps; told.end = one("output").textContent; told.released = play.getAttribute("aria-pressed");
    """
    found = told(browser, compared.folder, script)
    assert found == {"pressed": "true", "start": "t = 0.2", "steps": 5, "end": "t = 1", "released": "false"}


def test_everything_that_acts_has_a_name_and_a_place_among_the_tabs(
    browser: Browser, compared: Compared
) -> None:
    script = """
    const acting = [...document.querySelectorAll("a[href], input, button, summary, [tabindex]")];
    told.negative = acting.filter((item) => item.tabIndex !== 0).length;
    told.unnamed = acting.filter((item) => !(item.getAttribute("aria-label") || item.closest("label")?.textContent.trim()
      || item.textContent.trim())).map((item) => item.outerHTML.slice(0, 80));
    told.kinds = ["a", "input", "button", "svg"].map((name) => acting.filter((item) => item.localName === name).length);
    one("input[type=range]").focus(); told.focus = document.activeElement.type;
    told.aria = one("input[type=range]").getAttribute("aria-valuetext");
    told.images = [...document.querySelectorAll("img")].filter((image) => !image.alt || !image.naturalWidth).length;
    """
    found = told(browser, compared.folder, script)
    assert (found["negative"], found["unnamed"], found["images"]) == (0, [], 0)
    links, inputs, buttons, charts = found["kinds"]
    assert (inputs, buttons, charts) == (10, 1, 8)
    assert links > 15
    assert (found["focus"], found["aria"]) == ("range", "load parameter 1")


def test_a_phone_needs_no_sideways_scrolling_and_letters_are_legible(
    browser: Browser, compared: Compared
) -> None:
    script = """
    told.widths = [innerWidth, document.documentElement.scrollWidth];
    told.drawing = one(".shapes").clientWidth;
    told.letters = Math.min(...[...document.querySelectorAll(".shapes text, .chart text")].map((text) => text.getBoundingClientRect().height));
    told.reach = Math.min(...[...document.querySelectorAll(".switch, .play")].map((item) => item.getBoundingClientRect().height));
    """
    found = told(browser, compared.folder, script, width=360)
    assert found["widths"] == [360, 360]
    assert found["drawing"] > 300
    assert found["letters"] > 10
    assert found["reach"] >= 32
    script = """
    told.letters = Math.min(...[...document.querySelectorAll("svg text")].map((text) => text.getBoundingClientRect().height));
    told.picture = one("#error-budget img").clientWidth / one("#error-budget img").naturalWidth;
    """
    found = told(browser, compared.folder, script)
    assert found["letters"] > 10
    assert found["picture"] > 1.0, "pictures are drawn with letters of 10 points"


def test_light_dark_and_paper(browser: Browser, compared: Compared) -> None:
    path = compared.folder / "report.html"
    light = imread(browser.screenshot(path, height=3800))[..., :3]
    pixels = np.round(255 * light).reshape(-1, 3)
    assert np.median(light) > 0.9
    for code in ("#0072B2", "#009E73", "#CC79A7", "#D55E00"):  # swatches, bars of the budget
        near = np.abs(pixels - [int(code[i : i + 2], 16) for i in (1, 3, 5)]).max(axis=1) < 12
        assert near.sum() > 20, code
    dark = imread(browser.screenshot(path, "--blink-settings=preferredColorScheme=0"))[..., :3]
    assert np.median(dark) < 0.2
    paper = browser.printed(path).read_bytes()
    assert paper.startswith(b"%PDF")
    assert 3 <= paper.count(b"/Type /Page\n") <= 12


def test_a_section_may_bring_a_script_and_data_of_its_own(browser: Browser, tmp_path: Path) -> None:
    own = 'const own = document.querySelector("#{0} p"); own.textContent = DATA["{0}"].sum.join("+");'
    sections = [
        Section(title=title, html="<p>-</p>", data={"sum": [number, 1]}, script=own.format(title))
        for title, number in (("first", 2), ("second", 3))
    ]
    script = 'told.texts = [...document.querySelectorAll("section p")].map((p) => p.textContent);'
    found, console = browser.told(written(tmp_path, *sections) / "report.html", script)
    assert (found["texts"], console) == (["2+1", "3+1"], [])


def test_true_pins_supports_and_arcs_are_drawn(browser: Browser, tmp_path: Path) -> None:
    """A round pin is a circle of its radius in the scale of the drawing; an undeformed arc has many points; supports move."""
    scene = read_scene(SPECIMEN, "specimen")
    scene = replace(scene, beams=(replace(scene.beams[0], clamped=()), *scene.beams[1:]), supports=(MOVED,))
    section = motion_section("Drawn", scene, {"TSM mixed": solve(scene, "tsm")}, [], focus="TSM mixed")
    script = """
    const box = (selector) => { const b = [...document.querySelectorAll(selector)].at(-1).getBBox(); return [b.x, b.y, b.width, b.height]; };
    const look = () => ({
      disc: box(".shapes .disc"), path: box(".shapes .path"),
      symbol: box(".shapes .symbol"), arc: one(".shapes .rest").getAttribute("points").split(" ").length,
    });
    told.end = look(); slide(1); told.second = look();
    """
    found = told(browser, written(tmp_path, section), script)
    disc, path = found["end"]["disc"], found["end"]["path"]
    assert disc[2] == pytest.approx(disc[3], rel=0.01)
    assert disc[2] / path[2] == pytest.approx(2 * 12 / 20, rel=0.01)  # the pin goes 20 mm to the right
    assert found["end"]["arc"] == 25
    assert found["end"]["symbol"] != found["second"]["symbol"]
    assert found["end"]["disc"] != found["second"]["disc"]


def test_a_run_that_stopped_leaves_no_error(browser: Browser, tmp_path: Path) -> None:
    rod, beams = solve(KS, "rod"), solve(KS, "tsm")
    cut = {
        name: replace(beams, load_parameter=beams.load_parameter[:k])
        for name, k in (("mixed", 2), ("exact", 0))
    }
    responses = {**{f"TSM {name}": one for name, one in cut.items()}, "exact rod": rod}
    made = tracks(responses, "exact rod", KS)
    section = motion_section("Stopped", KS, responses, made, focus="TSM mixed")
    script = """
    const count = () => [0, 1, 2].map((n) => document.querySelectorAll(`.shapes [data-run="${n}"]`).length);
    told.end = count(); slide(1); told.second = count(); told.row = one(".values tbody tr").textContent;
    """
    found = told(browser, written(tmp_path, section), script)
    assert (found["end"], found["second"]) == ([0, 0, 1], [1, 0, 1])

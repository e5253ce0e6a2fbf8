"""The page in Chromium: slider, switches, keys, narrow and dark screens, paper; no error on the console."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from comparisons.models import solve
from comparisons.report.brief import Brief  # a page without an answer
from comparisons.report.motion import motion_section  # of scenes that no comparison draws at once
from comparisons.report.pages import Section, page
from comparisons.scene import SupportSpec
from tests.comparisons.report.pages.conftest import Browser
from tests.comparisons.report.specimen import SPECIMEN

pytestmark = pytest.mark.slow
MOVED = SupportSpec(beam="hook", end="start", kind="clamped", displacement=(0.0, 3.0))
HELPERS = """
const one = (selector) => document.querySelector(selector), all = (selector) => [...document.querySelectorAll(selector)];
const state = () => ({
  output: one("output").textContent, value: one("input[type=range]").value,
  shapes: [0, 1, 2, 8].map((n) => one(`.shapes [data-run="${n}"]`).getAttribute("points")),
  apart: one(".apart [data-run='0']").getAttribute("points"), star: one(".shapes .pin").getAttribute("points"),
  table: all(".values tbody tr").map((row) => [...row.children].map((cell) => cell.textContent)),
  vtu: all(".vtu a").map((link) => link.getAttribute("href")), cursor: one(".chart .cursor").getAttribute("x1"),
});
const MIXED = all(".switch").findIndex((label) => label.textContent === "TSM mixed, 20 elements");
for (const folded of all("details")) folded.open = true;
dispatchEvent(new Event("resize"));
const slide = (k) => {
  one("input[type=range]").value = k;
  one("input[type=range]").dispatchEvent(new Event("input", { bubbles: true }));
};
const seen = () => [0, MIXED].map((n) => [".shapes", ".chart"].map((drawing) => getComputedStyle(one(`${drawing} [data-run="${n}"]`)).display !== "none"));
const least = (selector) => Math.min(...all(selector).map((item) => item.getBoundingClientRect().height).filter((height) => height));
"""


def told(browser: Browser, folder: Path, script: str, width: int = 1200) -> dict:
    return browser.told(folder / "report.html", HELPERS + script, width=width)


def written(folder: Path, *sections: Section) -> Path:
    (folder / "report.html").write_text(page("t", Brief("found"), sections))
    return folder


def test_the_slider_moves_shapes_marks_and_values(browser, compared):
    script = "told.first = state(); slide(4); told.end = state(); slide(3); told.fourth = state();"
    found = told(browser, compared.folder, script)
    end, fourth = found["end"], found["fourth"]
    assert found["first"] == fourth, "the force is largest there"
    assert (end["output"], end["value"], fourth["output"]) == ("t = 1", "4", "t = 0.8")
    assert [name for name in ("apart", "star", "cursor") if end[name] == fourth[name]] == []
    assert all(a != b for a, b in zip(end["shapes"], fourth["shapes"], strict=True))
    assert fourth["vtu"] == ["tsm/tsm-0004.vtm", "solid/solid-0004.vtm"]
    assert all((compared.folder / name).is_file() for name in fourth["vtu"])
    runs = {run["label"]: run for run in json.loads((compared.folder / "summary.json").read_text())["runs"]}
    assert {row[0] for row in fourth["table"]} == set(runs)
    for label, force, _, arc, _, moment, _, _, _ in fourth["table"]:
        (contact,), (support,) = runs[label]["contacts"].values(), runs[label]["supports"].values()
        stated = [contact["force"][3], contact["arc_position"][3], support["moment"][3]]
        assert [float(force), float(arc), float(moment)] == pytest.approx(stated, rel=6e-5)


def test_switches_keys_pointer_and_play_act_and_have_names(browser, compared):
    script = """
    const box = one(`[data-switch="${MIXED}"]`), chart = one(".chart"), value = () => Number(one("input[type=range]").value);
    told.seen = [seen()]; box.click(); told.seen.push(seen()); slide(2); told.seen.push(seen()); box.click(); told.seen.push(seen()); slide(4);
    const key = (name) => { chart.dispatchEvent(new KeyboardEvent("keydown", { key: name, cancelable: true })); return value(); };
    told.keys = ["ArrowLeft", "Home", "ArrowLeft", "End"].map(key);
    const frame = chart.getBoundingClientRect();
    const point = (part) => { chart.dispatchEvent(new PointerEvent("pointermove", {
      pointerType: "mouse", clientX: frame.left + 64 + part * (frame.width - 78) })); return one("output").textContent; };
    told.points = [0.6, 0.0].map(point); slide(4);
    let steps = 0, fire = null;
    window.setInterval = (call) => { fire = call; return 1; };
    window.clearInterval = () => { fire = null; };
    const play = one(".play"), now = () => [play.getAttribute("aria-pressed"), one("output").textContent];
    play.click(); told.play = now();
    while (fire && steps < 100) { fire(); steps++; }
    told.play.push(steps, ...now());
    const acting = all("a[href], input, button, summary, [tabindex]");
    told.negative = acting.filter((item) => item.tabIndex !== 0).length;
    told.unnamed = acting.filter((item) => !(item.getAttribute("aria-label") || item.closest("label")?.textContent.trim()
      || item.textContent.trim())).map((item) => item.outerHTML.slice(0, 80));
    told.kinds = ["input", "button", "svg", "a"].map((name) => acting.filter((item) => item.localName === name).length);
    one("input[type=range]").focus();
    slide(4); told.focus = [document.activeElement.type, one("input[type=range]").getAttribute("aria-valuetext")];
    told.images = all("img").filter((image) => !image.alt || !image.naturalWidth).length;
    """
    found = told(browser, compared.folder, script)
    on, off = [[True] * 2] * 2, [[True] * 2, [False] * 2]
    assert found["seen"] == [on, off, off, on]
    assert found["keys"] == [3, 0, 0, 4]
    assert found["points"] == ["t = 0.6", "t = 0.2"]
    assert found["play"] == ["true", "t = 0.2", 5, "false", "t = 1"]
    assert (found["negative"], found["unnamed"], found["images"]) == (0, [], 0)
    assert found["kinds"][:3] == [10, 1, 8]
    assert (
        found["kinds"][3] == 2 + len(json.loads((compared.folder / "summary.json").read_text())["files"]) - 1
    )
    assert found["focus"] == ["range", "load parameter 1"]


def test_letters_are_legible_and_switches_in_reach_on_a_phone(browser, compared):
    script = """
    told.shapes = one(".shapes").clientWidth;
    told.letters = least("svg text"); told.reach = least(".switch, .play");
    told.picture = one("#error-budget img").clientWidth / one("#error-budget img").naturalWidth;
    """
    phone, screen = (told(browser, compared.folder, script, width) for width in (360, 1200))
    assert phone["shapes"] > 300
    assert phone["reach"] >= 32
    assert min(phone["letters"], screen["letters"]) > 10
    assert screen["picture"] > 1.0, "pictures are drawn with letters of 10 points"


def test_light_dark_and_paper(browser, compared, tmp_path):
    unfolded = tmp_path / "unfolded.html"
    unfolded.write_text((compared.folder / "report.html").read_text().replace("<details>", "<details open>"))

    def printed(name: str, *flags: str) -> Path:
        browser.run(unfolded, f"--{Path(name).stem}={tmp_path / name}", *flags)
        return tmp_path / name

    tall = "--window-size=1200,3800"
    light = imread(printed("screenshot.png", tall))[..., :3]
    assert np.median(light) > 0.9
    for code in ("#0072B2", "#009E73", "#CC79A7", "#D55E00"):  # swatches, bars of the budget
        colour = [int(code[i : i + 2], 16) for i in (1, 3, 5)]
        assert (np.abs(np.round(255 * light) - colour).max(axis=-1) < 12).sum() > 20, code
    dark = imread(printed("screenshot.png", tall, "--blink-settings=preferredColorScheme=0"))[..., :3]
    assert np.median(dark) < 0.2
    paper = printed("print-to-pdf.pdf").read_bytes()
    assert paper.startswith(b"%PDF")
    assert 3 <= paper.count(b"/Type /Page\n") <= 12


def test_true_pins_supports_and_arcs_are_drawn(browser, tmp_path):
    """A round pin is a circle of its radius in the scale of the drawing; an undeformed arc has many points; supports move."""
    first, *others = SPECIMEN.beams
    scene = replace(SPECIMEN, beams=(replace(first, clamped=()), *others), supports=(MOVED,))
    section = motion_section("Drawn", scene, {"TSM mixed": solve(scene, "tsm")}, [], focus="TSM mixed")
    script = """
    const box = (selector) => { const b = all(selector).at(-1).getBBox(); return [b.x, b.y, b.width, b.height]; };
    const look = () => [".shapes .disc", ".shapes .symbol", ".shapes .path"].map(box);
    told.end = look(); told.arc = one(".shapes .rest").getAttribute("points").split(" ").length; slide(1); told.second = look();
    """
    found = told(browser, written(tmp_path, section), script)
    disc, symbol, path = found["end"]
    assert disc[2] == pytest.approx(disc[3], rel=0.01)
    assert disc[2] / path[2] == pytest.approx(2 * 12 / 20, rel=0.01)  # the pin goes 20 mm to the right
    assert found["arc"] == 25
    assert symbol != found["second"][1]
    assert disc != found["second"][0]

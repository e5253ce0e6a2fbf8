"""Ten pages at the widths of a telephone, a tablet and a screen, light and dark: whole words, nothing wider than its page, all on the first screen."""

import io
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from comparisons.cli import main
from tests.comparisons.report.pages.conftest import Browser, Compared

pytestmark = pytest.mark.slow
SHEETS = (
    "double-beam", "hysteresis-stages", "ks-cantilever", "portal-frame", "three-point-friction", "two-pins", "clamped-column",
)  # fmt: skip
"""Scenes whose sheets are pages, and fit on one sheet of paper."""
DARK = "--blink-settings=preferredColorScheme=0"
LOOK = """
const frame = parent.document.querySelector("iframe"), all = (selector) => [...document.querySelectorAll(selector)];
const bottom = (selector) => all(selector).map((one) => one.getBoundingClientRect()).map((box) => [box.top, box.bottom])[0] ?? [0, 0];
const broken = () => {
  const found = [], walker = document.createTreeWalker(document.querySelector("main"), NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    for (const word of node.textContent.matchAll(/[A-Za-z0-9_.+]+/g)) {
      const range = document.createRange();
      range.setStart(node, word.index);
      range.setEnd(node, word.index + word[0].length);
      if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) found.push(word[0]);
    }
  }
  return found;
};
const wide = () => [document.documentElement, ...all(".scroll, pre, figure")].filter((one) => one.scrollWidth > one.clientWidth + 1)
  .map((one) => `${one.localName} ${one.scrollWidth} in ${one.clientWidth}: ${one.textContent.trim().slice(0, 60)}`);
// a plot clips what is drawn in it
const room = (plot) => plot.getScreenCTM().e + plot.width.baseVal.value;
const cut = () => all("text.name").filter((one) => one.getBoundingClientRect().right > room(one.ownerSVGElement) + 1).map((one) => one.textContent);
for (const width of [390, 800, 1400]) {
  frame.style.width = `${width}px`;
  for (const one of all("details")) one.open = false;
  dispatchEvent(new Event("resize"));
  const first = { lead: bottom(".lead")[1], answer: bottom(".answer table")[1], picture: bottom(".picture svg.shapes, .first img, .picture table")[0] };
  for (const one of all("details")) one.open = true;
  dispatchEvent(new Event("resize"));
  told[width] = { first, wide: [...wide(), ...cut()], broken: broken() };
}
told.points = all(".points li").length;
told.ground = getComputedStyle(document.body).backgroundColor;
"""


@pytest.fixture(scope="module")
def pages(compared: Compared, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages by their names."""
    folder = tmp_path_factory.mktemp("pages")
    sheets = {scene: folder / f"{scene}.html" for scene in SHEETS}
    with redirect_stdout(io.StringIO()):
        for scene, file in sheets.items():
            assert main(["solve", scene, "--out", str(file), "--quiet"]) in {0, 3}
        assert (
            main(["compare", "tip-load", "two-pins", "--quick", "--quiet", "--out", str(folder / "league")])
            == 0
        )
        assert main(["run", "fig9", "--quick", "--out", str(folder / "fig9")]) == 0
    more = {name: folder / name / "report.html" for name in ("league", "fig9")}
    return {**sheets, **more, "compared": compared.folder / "report.html"}


@pytest.mark.parametrize("name", [*SHEETS, "league", "fig9", "compared"])
def test_a_page_is_seen_whole(name: str, pages: dict[str, Path], browser: Browser) -> None:
    light, dark = (browser.told(pages[name], LOOK, *flags) for flags in ((), (DARK,)))
    for found in (light, dark):
        assert found["points"] <= 5
        for width in ("390", "800", "1400"):
            assert found[width]["wide"] == []
            assert found[width]["broken"] == []
            first = found[width]["first"]
            assert max(first["lead"], first["answer"]) <= 900, width
            assert first["picture"] <= 700, width
    assert light["ground"] == "rgb(255, 255, 255)"
    assert dark["ground"] == "rgb(20, 22, 26)"


@pytest.mark.parametrize("name", SHEETS)
def test_a_sheet_is_one_page_of_paper(name: str, pages: dict[str, Path], browser: Browser) -> None:
    file = browser.folder / "sheet.pdf"
    browser.run(pages[name], f"--print-to-pdf={file}")
    paper = file.read_bytes()
    assert paper.count(b"/Type /Page\n") == 1
    assert b"/MediaBox [0 0 594" in paper or b"/MediaBox [0 0 595" in paper, "A4"

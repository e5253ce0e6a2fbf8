"""The verification manual as a page: solved anew where the code is younger than it."""

import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util.logging import getLogger

ROOT = Path(__file__).parents[2]
PACKAGES = ("tsm", "fem_reference", "comparisons")


def as_page(markdown: str) -> str:
    """Return the manual with targets that Sphinx knows in place of anchors, under names of their own.

    Examples
    --------
    >>> as_page('[Roll-up](#roll-up) <a id="roll-up"></a>')
    '[Roll-up](#manual-roll-up) (manual-roll-up)='
    """
    targets = re.sub(r'<a id="([\w-]+)"></a>', r"(manual-\1)=", markdown)
    return targets.replace("](#", "](#manual-")


def up_to_date(page: Path) -> bool:
    """Whether a page is younger than every module of the packages."""
    if not page.is_file():
        return False
    modules = (path for name in PACKAGES for path in (ROOT / name).rglob("*.*"))
    return page.stat().st_mtime > max(path.stat().st_mtime for path in modules)


def _on_start(app: Sphinx) -> None:
    from comparisons.claims.manual import problems, write_manual

    page = Path(app.srcdir) / "_generated" / "manual" / "index.md"
    if up_to_date(page):
        return
    log = getLogger(__name__)
    page.unlink(missing_ok=True)  # it was changed after it was written, and a changed file is not replaced
    manual = write_manual(page.parent, lambda line: log.info("manual: %s", line), problems())
    if not manual.passed:
        log.warning("manual: an answer lies beyond its tolerance")
    page.write_text(as_page(page.read_text(encoding="utf-8")), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the manual when a build starts."""
    app.connect("builder-inited", _on_start)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""What the site has besides Sphinx: equations as MathML, and pages that are made from the code."""

import re
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.locale import _
from sphinx.util.logging import getLogger
from sphinx.util.math import get_node_equation_number

from comparisons.files import writable_folder
from comparisons.suites.manual import manual, problems
from docs.extensions.gallery import gallery, stale
from docs.extensions.generated import write_pages

ROOT = Path(__file__).parents[2]
PRIMES = {"''": "\\text{\u2033}", "'": "\\text{\u2032}"}
"""Primes of a font, which is raised and small already; only fonts for mathematics have another one for superscripts."""


def mathml(latex: str, display: str) -> str:
    """Return the MathML element of a formula, which needs no script and no font; `display` is "inline" or "block".

    Examples
    --------
    >>> mathml("x^2", "inline")
    '<math xmlns="http://www.w3.org/1998/Math/MathML" display="inline"><mrow><msup><mi>x</mi><mn>2</mn></msup></mrow></math>'
    """
    text = re.sub(r"\\mathrm\{(\w+)\}", r"\\text{\1}", " ".join(latex.split()))
    for mark, prime in PRIMES.items():
        text = text.replace(mark, prime)
    return str(convert(text, display=display))


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(f'<span class="math">{mathml(node.astext(), "inline")}</span>')
    raise nodes.SkipNode


def _block(writer: Any, node: nodes.math_block) -> None:
    writer.body.append(writer.starttag(node, "div", CLASS="math"))
    if node["number"]:
        writer.body.append(f'<span class="eqno">({get_node_equation_number(writer, node)})')
        writer.add_permalink_ref(node, _("Link to this equation"))
        writer.body.append("</span>")
    writer.body.append(f'<div class="formula">{mathml(node.astext(), "block")}</div></div>\n')
    raise nodes.SkipNode


def _write(app: Sphinx) -> None:
    """Write what is made from the code: pages, and pictures and the manual where something is younger than they are."""
    folder, log = Path(app.srcdir) / "_generated", getLogger(__name__)
    write_pages(folder)
    (folder / "gallery.md").write_text(gallery(folder / "scenes"), encoding="utf-8")
    page = folder / "manual" / "index.md"
    packages = (ROOT / name for name in ("tsm", "fem_reference", "comparisons"))
    if not stale(page, (path for package in packages for path in package.rglob("*.*[!c]"))):  # no .pyc
        return
    page.unlink(missing_ok=True)  # it was changed after it was written, and a changed file is not replaced
    found = manual(problems(), log.info)
    found.write(writable_folder(page.parent))
    if found.wrong:
        log.warning("manual: an answer lies beyond its tolerance")
    # Sphinx has targets in place of anchors, under names of their own
    text = re.sub(r'<a id="([\w-]+)"></a>', r"(manual-\1)=", page.read_text(encoding="utf-8"))
    page.write_text(text.replace("](#", "](#manual-"), encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer of equations, and write what is made from the code when a build starts."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

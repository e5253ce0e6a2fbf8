"""Equations as MathML, made when the site is built: no script and no font is loaded to show them."""

import re
from typing import Any
from xml.etree import ElementTree as ET

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.locale import _
from sphinx.util.math import get_node_equation_number

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
PRIMES = ("\u2032", "\u2033")
ET.register_namespace("", NAMESPACE)


def mathml(latex: str, display: str) -> str:
    """Return the MathML element of a formula; `display` is "inline" or "block".

    Examples
    --------
    >>> mathml("x^2", "inline")
    '<math xmlns="http://www.w3.org/1998/Math/MathML" display="inline"><mrow><msup><mi>x</mi><mn>2</mn></msup></mrow></math>'
    """
    upright = re.sub(r"\\mathrm\{(\w+)\}", r"\\text{\1}", " ".join(latex.split()))
    math = ET.fromstring(convert(upright, display=display))  # noqa: S314 - our own text
    for parent in list(math.iter()):
        for place, child in enumerate(list(parent)):
            parent[place] = _primed(child)
    return ET.tostring(math, encoding="unicode")


def _primed(item: ET.Element) -> ET.Element:
    """Return a superscript that starts with a prime with the prime beside its base.

    The prime of a font is raised and small already; only fonts for mathematics have another one for superscripts.
    """
    if _name(item) not in ("msup", "msubsup"):
        return item
    *others, above = item
    marks = list(above) if _name(above) == "mrow" else [above]
    if not marks or marks[0].text not in PRIMES:
        return item
    base = _element("mrow", others[0], _mark(marks[0].text))
    rest = marks[1:]
    kind = {(1, False): "mrow", (1, True): "msup", (2, False): "msub", (2, True): "msubsup"}
    return _element(
        kind[len(others), bool(rest)], base, *others[1:], *([_element("mrow", *rest)] if rest else [])
    )


def _name(item: ET.Element) -> str:
    return item.tag.rpartition("}")[2]


def _element(name: str, *children: ET.Element) -> ET.Element:
    made = ET.Element(f"{{{NAMESPACE}}}{name}")
    made.extend(children)
    return made


def _mark(text: str | None) -> ET.Element:
    mark = _element("mo")
    mark.text = text
    mark.attrib.update(lspace="0em", rspace="0em")
    return mark


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(f'<span class="math">{mathml(node.astext(), "inline")}</span>')
    raise nodes.SkipNode


def _block(writer: Any, node: nodes.math_block) -> None:
    writer.body.append(writer.starttag(node, "div", CLASS="math"))
    if node["number"]:
        number = get_node_equation_number(writer, node)
        writer.body.append(f'<span class="eqno">({number})')
        writer.add_permalink_ref(node, _("Link to this equation"))
        writer.body.append("</span>")
    writer.body.append(f'<div class="formula">{mathml(node.astext(), "block")}</div></div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer under the name "mathml"."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}

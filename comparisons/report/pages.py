"""The page: style, script, data and sections in one file that loads nothing; the markup stands in templates."""

import base64
import json
import re
from collections.abc import Mapping, Sequence
from functools import cache
from mimetypes import types_map
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from comparisons.output import cell, plain
from comparisons.report.brief import Brief

if TYPE_CHECKING:
    from jinja2 import Environment
    from markupsafe import Markup

FOLDER = Path(__file__).with_name("templates")


class Section(NamedTuple):
    """A part of a page: its heading, which no other section has, and the markup below it.

    The `data` are what a script shows, JSON's types, arrays or records; the script finds them as
    ``DATA[ident]``. Of a page's first section, `beside` stands below
    the answer, and what there is `more` below all.
    """

    title: str
    html: str
    data: Any = None
    more: str = ""
    beside: str = ""

    @property
    def ident(self) -> str:
        """The section's anchor: its title in lower case, with hyphens."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


@cache
def _templates() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    found = Environment(loader=FileSystemLoader(FOLDER), autoescape=True, undefined=StrictUndefined)
    found.trim_blocks = found.keep_trailing_newline = True
    found.filters |= {"cell": cell, "whole": whole}
    return found


def whole(text: str) -> str:
    """Return words such that no line ends within a number, a percentage, a pair or a unit."""
    text = re.sub(r"(?<=\de)-(?=\d)", "\u2011", text).replace("->", "-\u2060>").replace(" %", "\u00a0%")
    return re.sub(r"\[[^\]]*\]", lambda unit: unit[0].replace(" ", "\u00a0").replace("/", "/\u2060"), text)


def rendered(name: str, **values: Any) -> "Markup":
    """Return the markup of a template, whose values are escaped."""
    from markupsafe import Markup

    return Markup(_templates().get_template(f"{name}.html.jinja").render(values))  # noqa: S704 - escaped by the template


def piece(name: str, *values: Any) -> "Markup":
    """Return the markup of a macro of ``pieces.html.jinja``, whose values are escaped."""
    found: Markup = getattr(_templates().get_template("pieces.html.jinja").module, name)(*values)
    return found.strip()


def page(title: str, brief: Brief, sections: Sequence[Section]) -> str:
    """Return a brief with the first of the sections, and the others folded, as one HTML file that loads nothing; their titles differ."""
    idents = [section.ident for section in sections]
    if len(set(idents)) < len(idents):
        raise ValueError(f"sections = {idents}: must have different titles")
    data = {section.ident: plain(section.data) for section in sections if section.data is not None}
    text = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    style, script = ((FOLDER / name).read_text(encoding="utf-8") for name in ("style.css", "script.js"))
    parts = {"style": style, "script": script, "data": text}
    return rendered("page", title=title, brief=brief, sections=sections, **parts)


def table(caption: str, rows: Sequence[Mapping[str, Any]], *, prose: bool = False) -> str:
    """Return rows of equal keys as a table with a caption; the cells of `prose` break their lines."""
    return piece("table", caption, rows, prose) if rows else "<p>None.</p>"


def picture(path: Path, caption: str) -> str:
    """Return an SVG or PNG file as an image: markup of two SVGs in one page would share names and styles. An SVG has a dark variant."""
    content = path.read_bytes()
    if path.suffix == ".svg":
        style = b"<style>%s</style><defs>" % (FOLDER / "picture.css").read_bytes()
        content = content.replace(b"<defs>", style, 1)
    text = base64.b64encode(content).decode("ascii")
    return piece("picture", caption, f"data:{types_map[path.suffix]};base64,{text}")

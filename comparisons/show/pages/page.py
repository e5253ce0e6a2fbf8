"""The page: style, script, data and sections in one file that loads nothing."""

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

from comparisons.files import write_text
from comparisons.output import plain
from comparisons.show.pages.markup import text

NAME = "report.html"


@dataclass(frozen=True, kw_only=True)
class Section:
    """A part of a page.

    Attributes
    ----------
    title : str
        Heading; no two sections of a page have the same.
    html : str
        Markup below the heading.
    data : object
        What a script shows: JSON's types, arrays or records. A script finds it as ``DATA[ident]``.
    script : str
        A script of the section's own, run after the page's; it must not say ``</script``.
    """

    title: str
    html: str
    data: Any = None
    script: str = ""

    @property
    def ident(self) -> str:
        """The section's anchor: its title in lower case, with hyphens."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


def page(title: str, lead: str, sections: Sequence[Section]) -> str:
    """Return sections as one HTML file without external resources.

    Parameters
    ----------
    title, lead : str
        Heading and the sentence below it, plain text.
    sections : sequence of Section
        In their order.

    Raises
    ------
    ValueError
        If two sections have one title.
    """
    idents = [section.ident for section in sections]
    if len(set(idents)) < len(idents):
        raise ValueError(f"sections = {idents}: must have different titles")
    data = {section.ident: plain(section.data) for section in sections if section.data is not None}
    return Template(_part("page.html")).substitute(
        title=text(title),
        lead=text(lead),
        style=_part("style.css"),
        script=_part("script.js"),
        data=json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        scripts="\n".join(f"<script>\n{{\n{one.script}\n}}\n</script>" for one in sections if one.script),
        links="\n".join(f'<a href="#{one.ident}">{text(one.title)}</a>' for one in sections),
        sections="\n".join(_framed(one) for one in sections),
    )


def _part(name: str) -> str:
    return (resources.files("comparisons.show.pages") / name).read_text(encoding="utf-8")


def _framed(section: Section) -> str:
    heading = f'<h2 id="{section.ident}-heading">{text(section.title)}</h2>'
    return (
        f'<section id="{section.ident}" aria-labelledby="{section.ident}-heading">\n'
        f"{heading}\n{section.html}\n</section>"
    )


def write_page(folder: Path, title: str, lead: str, sections: Sequence[Section]) -> Path:
    """Write the `page` as ``report.html`` to `folder`; return the file."""
    write_text(folder / NAME, page(title, lead, sections))
    return folder / NAME

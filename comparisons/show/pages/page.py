"""The page: style, script, data and sections in one file that loads nothing; pieces of HTML."""

import base64
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any, NamedTuple
from urllib.parse import quote

from comparisons.files import write_text
from comparisons.output import cell, plain
from comparisons.scene import Scene, to_toml
from comparisons.version import machine, versions

NAME = "report.html"
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


class Section(NamedTuple):
    """A part of a page: its heading, which no other section has, and the markup below it.

    The `data` are what a script shows, JSON's types, arrays or records; the script finds them as
    ``DATA[ident]``.
    """

    title: str
    html: str
    data: Any = None

    @property
    def ident(self) -> str:
        """The section's anchor: its title in lower case, with hyphens."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")

    @property
    def markup(self) -> str:
        """The section as HTML."""
        heading = f'<h2 id="{self.ident}-heading">{text(self.title)}</h2>'
        return f'<section id="{self.ident}" aria-labelledby="{self.ident}-heading">\n{heading}\n{self.html}\n</section>'


def page(title: str, lead: str, sections: Sequence[Section]) -> str:
    """Return sections of different titles, below a title and a lead, as one HTML file that loads nothing."""
    idents = [section.ident for section in sections]
    if len(set(idents)) < len(idents):
        raise ValueError(f"sections = {idents}: must have different titles")
    data = {section.ident: plain(section.data) for section in sections if section.data is not None}
    return Template(part("page.html")).substitute(
        title=text(title),
        lead=text(lead),
        style=part("style.css"),
        script=part("script.js"),
        data=json.dumps(data, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c"),
        links="\n".join(f'<a href="#{one.ident}">{text(one.title)}</a>' for one in sections),
        sections="\n".join(section.markup for section in sections),
    )


def part(name: str) -> str:
    """Return a file of this folder."""
    return (resources.files("comparisons.show.pages") / name).read_text(encoding="utf-8")


def write_page(
    folder: Path,
    title: str,
    lead: str,
    sections: Iterable[Section],
    scenes: Iterable[Scene],
    files: Iterable[Path],
    name: str = NAME,
) -> Path:
    """Write a `page` that ends with scenes, versions, machine and links to files; return its file."""
    inputs = [
        folded(f"{scene.name}.toml", f'<pre tabindex="0"><code>{text(to_toml(scene))}</code></pre>')
        for scene in scenes
    ]
    names = (path.relative_to(folder).as_posix() for path in files)
    links = "\n".join(f'<li><a href="{quote(name)}">{text(name)}</a></li>' for name in names)
    closing = [
        *([Section("Input", "\n".join(inputs))] if inputs else []),
        Section("Versions and machine", definitions({**versions(), **machine()})),
        Section("Files", f"<ul>\n{links}\n</ul>"),
    ]
    write_text(folder / name, page(title, lead, [*sections, *closing]))
    return folder / name


def text(value: Any) -> str:
    """Return a value as escaped text: a number in three digits, what is not there as a dash."""
    return escape(cell(value))


def table(caption: str, rows: Sequence[Mapping[str, Any]], *, prose: bool = False) -> str:
    """Return rows of equal keys as a table with a caption; the cells of `prose` break their lines."""
    if not rows:
        return "<p>None.</p>"
    cells = []
    for first, *rest in (row.values() for row in rows):
        cells.append(("", first, "".join(f"<td>{text(one)}</td>" for one in rest)))
    inner = markup(list(rows[0]), cells, "prose" if prose else "")
    return f'<p class="caption">{text(caption)}</p>\n{scrolling(caption, inner)}'


def markup(header: Sequence[str], rows: Iterable[tuple[str, Any, str]], kind: str = "") -> str:
    """Return a table of a class of `style.css`, from the attributes, the head and the markup of the other cells of every row."""
    head = "".join(f'<th scope="col">{text(name)}</th>' for name in header)
    body = "\n".join(
        f'<tr{attributes}><th scope="row">{text(first)}</th>{cells}</tr>' for attributes, first, cells in rows
    )
    named = f' class="{kind}"' if kind else ""
    return f"<table{named}>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"


def scrolling(label: str, inner: str) -> str:
    """Return markup in a frame that the keyboard can scroll."""
    return f'<div class="scroll" tabindex="0" role="region" aria-label="{text(label)}">\n{inner}\n</div>'


def picture(path: Path, caption: str) -> str:
    """Return an SVG or PNG file as an image: markup of two SVGs in one page would share names and styles."""
    content = base64.b64encode(path.read_bytes()).decode("ascii")
    image = f'<img alt="{text(caption)}" src="data:{TYPES[path.suffix]};base64,{content}">'
    return f"<figure>\n{scrolling(caption, image)}\n<figcaption>{text(caption)}</figcaption>\n</figure>"


def definitions(terms: Mapping[str, Any]) -> str:
    """Return names and what they are as a list."""
    return "<dl>\n" + "\n".join(f"<dt>{text(a)}</dt><dd>{text(b)}</dd>" for a, b in terms.items()) + "\n</dl>"


def folded(summary: str, inner: str) -> str:
    """Return markup that opens on demand."""
    return f"<details>\n<summary>{text(summary)}</summary>\n{inner}\n</details>"

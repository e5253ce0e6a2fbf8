"""Pieces of HTML: text, tables, pictures, links."""

import base64
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import quote

TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


def text(value: Any) -> str:
    """Return a value as escaped text: a number in three digits, what is not there as a dash."""
    shown = "-" if value is None else f"{value:.3g}" if isinstance(value, float) else str(value)
    return escape(shown)


def table(caption: str, header: Sequence[str], rows: Iterable[Sequence[Any]], *, prose: bool = False) -> str:
    """Return a table that scrolls by itself where the screen is narrow; the first column heads its rows.

    Its caption stands above it and names it; the cells of `prose` break their lines.
    """
    head = "".join(f'<th scope="col">{text(name)}</th>' for name in header)
    body = "\n".join(
        f'<tr><th scope="row">{text(first)}</th>{"".join(f"<td>{text(cell)}</td>" for cell in rest)}</tr>'
        for first, *rest in rows
    )
    kind = ' class="prose"' if prose else ""
    inner = f"<table{kind}>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>"
    return f'<p class="caption">{text(caption)}</p>\n{scrolling(caption, inner)}'


def scrolling(label: str, inner: str) -> str:
    """Return markup in a frame that the keyboard can scroll."""
    return f'<div class="scroll" tabindex="0" role="region" aria-label="{text(label)}">\n{inner}\n</div>'


def picture(path: Path, caption: str) -> str:
    """Return an SVG or PNG file as a figure that is part of the page.

    An SVG is embedded as an image. As a part of the document, its names and styles could clash with other figures.
    """
    content = base64.b64encode(path.read_bytes()).decode("ascii")
    image = f'<img alt="{text(caption)}" src="data:{TYPES[path.suffix]};base64,{content}">'
    return f"<figure>\n{scrolling(caption, image)}\n<figcaption>{text(caption)}</figcaption>\n</figure>"


def definitions(terms: Mapping[str, Any]) -> str:
    """Return names and what they are as a list."""
    return "<dl>\n" + "\n".join(f"<dt>{text(a)}</dt><dd>{text(b)}</dd>" for a, b in terms.items()) + "\n</dl>"


def file_links(files: Iterable[Path], folder: Path) -> str:
    """Return links to files, relative to the page's `folder`."""
    names = [path.relative_to(folder).as_posix() for path in files]
    return "<ul>\n" + "\n".join(f"<li>{link(name)}</li>" for name in names) + "\n</ul>"


def link(name: str) -> str:
    """Return a link to a file, by its path relative to the page."""
    return f'<a href="{quote(name)}">{text(name)}</a>'


def folded(summary: str, inner: str) -> str:
    """Return markup that opens on demand."""
    return f"<details>\n<summary>{text(summary)}</summary>\n{inner}\n</details>"

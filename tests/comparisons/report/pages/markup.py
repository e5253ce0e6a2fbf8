"""How tests read a page."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

VOID = {"meta", "link", "input", "img", "br", "hr"}


class Outline(HTMLParser):
    """Anchors and targets of a page; fails where tags do not match."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.named: dict[str, list[str]] = {}
        self.feed(html)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            self.named.setdefault(name, []).append(value or "")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        del self.open[len(self.open) - (tag not in VOID) :]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, self.getpos()


def block(html: str) -> dict[str, Any]:
    """The JSON block of a page."""
    found = re.search(r'<script type="application/json" id="_data">(.*?)</script>', html, re.DOTALL)
    assert found
    return json.loads(found[1])


def check_alone(html: str, folder: Path) -> None:
    """The page is whole, and loads nothing: its targets are its own anchors, its own data or files beside it."""
    named = Outline(html).named
    ids = named["id"]
    assert len(set(ids)) == len(ids)
    assert set(named.get("aria-labelledby", ())) <= set(ids)
    for kind in ("src", "href", "action", "data", "poster", "srcset"):
        for target in named.get(kind, ()):
            inside = target.startswith("data:") or (target.startswith("#") and target[1:] in ids)
            assert inside or (folder / target).is_file(), target[:80]
    assert [words for words in ("://", "@import", "url(") if words in html] == []
    assert "default-src 'none'" in html

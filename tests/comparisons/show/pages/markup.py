"""How tests read a page."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

VOID = {"meta", "link", "input", "img", "br", "hr"}


class Outline(HTMLParser):
    """Elements, anchors and targets of a page; fails where tags do not match."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.targets: list[str] = []
        self.labels: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            if name == "id":
                self.ids.append(value or "")
            if name in {"src", "href", "action", "data", "poster", "srcset"}:
                self.targets.append(value or "")
            if name == "aria-labelledby":
                self.labels.append(value or "")

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, self.getpos()


def outline(html: str) -> Outline:
    found = Outline()
    found.feed(html)
    found.close()
    assert not found.open
    return found


def block(html: str) -> dict[str, Any]:
    """The JSON block of a page."""
    found = re.search(r'<script type="application/json" id="_data">(.*?)</script>', html, re.DOTALL)
    assert found
    return json.loads(found[1])


def check_alone(html: str, folder: Path) -> None:
    """The page is whole, and loads nothing: its targets are its own anchors, its own data or files beside it."""
    found = outline(html)
    assert len(set(found.ids)) == len(found.ids)
    assert set(found.labels) <= set(found.ids)
    for target in found.targets:
        inside = target.startswith("data:") or (target.startswith("#") and target[1:] in found.ids)
        assert inside or (folder / target).is_file(), target[:80]
    assert "://" not in html
    assert "@import" not in html
    assert "url(" not in html
    assert "default-src 'none'" in html

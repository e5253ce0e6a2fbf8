"""Self-contained pages of results: a page is a list of sections, each with its markup and, if it moves, its data."""

from comparisons.show.pages.motion import Track, motion_section, tracks
from comparisons.show.pages.page import (
    Section,
    definitions,
    folded,
    page,
    picture,
    table,
    write_page,
)
from comparisons.show.pages.states import states_section

__all__ = [
    "Section", "Track", "definitions", "folded", "motion_section", "page", "picture", "states_section", "table", "tracks",
    "write_page",
]  # fmt: skip


def __dir__() -> list[str]:
    return sorted(__all__)

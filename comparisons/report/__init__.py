"""Self-contained pages of results: a page is a list of sections, each with its markup and, if it moves, its data."""

from comparisons.report.markup import definitions, file_links, folded, picture, table, text
from comparisons.report.motion import Track, motion_section, tracks
from comparisons.report.page import Section, page, write_page
from comparisons.report.provenance import provenance

__all__ = [
    "Section",
    "Track",
    "definitions",
    "file_links",
    "folded",
    "motion_section",
    "page",
    "picture",
    "provenance",
    "table",
    "text",
    "tracks",
    "write_page",
]

"""What the pages and diagrams of work and precision share: sections of rows, logarithmic panels, one legend."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparisons.scene import Scene
from comparisons.show.pages import Section, provenance, table, write_page


def rows_table(caption: str, rows: Sequence[Mapping[str, object]]) -> str:
    """Return rows of equal keys as a table of a page."""
    return table(caption, list(rows[0]), (list(row.values()) for row in rows)) if rows else "<p>None.</p>"


def logarithmic(axes: Any) -> None:
    """Make both axes of a panel logarithmic, with a grid."""
    axes.set(xscale="log", yscale="log")
    axes.grid(visible=True, linewidth=0.3)


def draw_legend(fig: Any, panels: Sequence[Any], place: str) -> None:
    """Draw one legend for all panels: one entry for each label, with a filled marker where it has one."""
    entries: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            if label not in entries or entries[label].get_markerfacecolor() == "none":
                entries[label] = handle
    fig.legend(list(entries.values()), list(entries), loc=place, ncols=3, fontsize="small", frameon=False)


def write_report(
    folder: Path,
    title: str,
    lead: str,
    parts: Mapping[str, Sequence[str]],
    scenes: Sequence[Scene],
    files: Sequence[Path],
) -> Path:
    """Write a page of sections, the markup of each in parts, with its scenes and files below; return its path."""
    sections = [Section(title=name, html="\n".join(markup)) for name, markup in parts.items()]
    return write_page(folder, title, lead, [*sections, *provenance(scenes, files, folder)])

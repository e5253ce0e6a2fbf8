"""What a suite found, made from the rows of its cases, and where it goes: a page, files, a terminal, an exit status."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from comparisons.files import write_text
from comparisons.frozen import Frozen
from comparisons.output import write_numbers, write_rows
from comparisons.report.brief import Brief
from comparisons.report.pages import Section, write_page
from comparisons.scene import Scene

WRITERS: dict[str, Callable[[Path, Any], object]] = {".csv": write_rows, ".json": write_numbers}
"""How a file is written, by its suffix; any other is a text."""


class Found(Frozen):
    """A page with its files: what every suite makes of its rows."""

    title: str
    brief: Brief
    #: Rows by ``NAME.csv``, nested numbers by ``NAME.json``, texts by other names.
    files: Mapping[str, Any]
    sections: Callable[[Path], Iterable[Section]]  #: Those of the page, with the pictures of a folder.
    #: What draws to ``NAME.png`` and ``NAME.svg``.
    pictures: Mapping[str, Callable[..., None]] = field(default_factory=dict)
    kinds: Sequence[str] = (".png", ".svg")  #: Suffixes of the pictures.
    scenes: Iterable[Scene] = ()
    text: str = ""  #: What a terminal shows below the brief.
    wrong: Sequence[str] = ()  #: Answers that are wrong, a line for each.
    stopped: Sequence[str] = ()  #: Solutions that are needed and stopped.
    page: str = "report.html"

    def write(self, folder: Path) -> list[Path]:
        """Write the files, the pictures and the page; return them, the page first."""
        files = [folder / name for name, content in self.files.items() if content]
        for file in files:
            WRITERS.get(file.suffix, write_text)(file, self.files[file.name])
        for name, draw in self.pictures.items():
            drawn = [folder / f"{name}{kind}" for kind in self.kinds]
            draw(*drawn)
            files += drawn
        sections = self.sections(folder)
        page = write_page(folder, self.title, self.brief, sections, self.scenes, files, self.page)
        return [page, *files]

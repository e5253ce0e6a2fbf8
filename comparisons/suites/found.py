"""What a suite found, made from the rows of its cases, and where it goes: a page, files, a terminal, an exit status."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from comparisons.files import alone_in, writable_folder, write_text
from comparisons.frozen import Frozen
from comparisons.output import write_numbers, write_rows
from comparisons.report.brief import Brief
from comparisons.report.export import write_series
from comparisons.report.pages import Section, write_page
from comparisons.scene import Scene

WRITERS: dict[str, Callable[[Path, Any], object]] = {
    ".csv": write_rows,
    ".json": write_numbers,
    ".pvd": lambda path, answered: write_series(writable_folder(path.parent), *answered),
}
"""How a file is written, by its suffix; any other is a text."""


class Found(Frozen):
    """A page with its files: what every suite makes of its rows."""

    title: str
    brief: Brief
    #: Rows by ``NAME.csv``, nested numbers by ``NAME.json``, a response and its scene by ``MODEL/MODEL.pvd``, texts by other names.
    files: Mapping[str, Any]
    sections: Callable[[Path], Iterable[Section]]  #: Those of the page, with the pictures of a folder.
    #: What draws to a file, or to ``NAME.png`` and ``NAME.svg`` if the name has no suffix.
    pictures: Mapping[str, Callable[..., None]] = field(default_factory=dict)
    scenes: Iterable[Scene] = ()
    text: str = ""  #: What a terminal shows below the brief.
    remarks: Sequence[str] = ()  #: What is said of answers that may stop.
    wrong: Sequence[str] = ()  #: Answers that are wrong, a line for each.
    stopped: Sequence[str] = ()  #: Solutions that are needed and stopped.
    page: str = "report.html"

    def write(self, folder: Path) -> list[Path]:
        """Write the files, the pictures and the page; return them, the page first. A run waits while another one writes into `folder`."""
        files = {folder / name: content for name, content in self.files.items() if content}
        with alone_in(folder):
            for file, content in files.items():
                WRITERS.get(file.suffix, write_text)(file, content)
            every = list(files)
            for name, draw in self.pictures.items():
                kinds = [""] if Path(name).suffix else [".png", ".svg"]
                drawn = [folder / f"{name}{kind}" for kind in kinds]
                draw(*drawn)
                every += drawn
            sections = self.sections(folder)
            page = write_page(folder, self.title, self.brief, sections, self.scenes, every, self.page)
        return [page, *every]

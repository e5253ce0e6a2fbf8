"""What a suite found, made from the rows of its cases, and where it goes: a page, files, a terminal, an exit status."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from comparisons.files import alone_in, writable_folder, write_text
from comparisons.frozen import Frozen
from comparisons.output import json_text, write_rows
from comparisons.report.brief import Brief
from comparisons.report.export import write_series
from comparisons.report.pages import Section, page, piece
from comparisons.scene import Scene, to_toml
from comparisons.version import machine, versions

WRITERS: dict[str, Callable[[Path, Any], object]] = {
    ".csv": write_rows,
    ".json": lambda path, numbers: write_text(path, json_text({**numbers, "versions": versions()})),
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
        """Write files, pictures, and the page, which ends with scenes, versions and links; return them, the page first.

        A run waits while another one writes into `folder`.
        """
        files = {name: content for name, content in self.files.items() if content}
        names, inputs = list(files), [piece("code", to_toml(scene)) for scene in self.scenes]
        with alone_in(folder):
            for name, content in files.items():
                WRITERS.get(Path(name).suffix, write_text)(folder / name, content)
            for name, draw in self.pictures.items():
                drawn = [name] if Path(name).suffix else [f"{name}.png", f"{name}.svg"]
                draw(*(folder / one for one in drawn))
                names += drawn
            closing = [
                *([Section("Input", "\n".join(inputs))] if inputs else []),
                Section("Versions and machine", piece("definitions", {**versions(), **machine()})),
                Section("Files", piece("links", names)),
            ]
            write_text(folder / self.page, page(self.title, self.brief, [*self.sections(folder), *closing]))
        return [folder / name for name in (self.page, *names)]

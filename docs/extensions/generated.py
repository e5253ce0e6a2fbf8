"""The pages that are made from the code, before every build: nothing in them can go out of date."""

from pathlib import Path

from sphinx.application import Sphinx

from docs.extensions import messages, response, scene_file, scope, statuses

PAGES = {
    "scene-file.md": scene_file.page,
    "messages.md": messages.page,
    "scope.md": scope.page,
    "statuses.md": statuses.page,
    "response.md": response.page,
    "resolved-scene.md": response.scene_page,
    "quantities.md": response.quantities_page,
}
"""What makes the text of each page."""


def write_pages(folder: Path) -> None:
    """Write every page into `folder`; a page that has not changed keeps its time."""
    folder.mkdir(exist_ok=True)
    for name, page in PAGES.items():
        path, text = folder / name, page()
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def _on_start(app: Sphinx) -> None:
    write_pages(Path(app.srcdir) / "_generated")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages when a build starts."""
    app.connect("builder-inited", _on_start)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""Where the numbers of a page come from: input, versions, machine, files."""

from collections.abc import Iterable
from pathlib import Path

from comparisons.scene import Scene, to_toml
from comparisons.show.pages.markup import definitions, file_links, folded, text
from comparisons.show.pages.page import Section
from comparisons.version import machine, versions


def provenance(scenes: Iterable[Scene], files: Iterable[Path], folder: Path) -> list[Section]:
    """Return the sections that close every page: input, versions and machine, files.

    Parameters
    ----------
    scenes : iterable of Scene
        The input; each opens on demand as its scene file.
    files : iterable of Path
        Linked relative to `folder`, where the page is.
    """
    inputs = "\n".join(
        folded(f"{scene.name}.toml", f'<pre tabindex="0"><code>{text(to_toml(scene))}</code></pre>')
        for scene in scenes
    )
    return [
        Section(title="Input", html=inputs),
        Section(title="Versions and machine", html=definitions({**versions(), **machine()})),
        Section(title="Files", html=file_links(files, folder)),
    ]

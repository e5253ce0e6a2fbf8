"""The README as the description of a package: without the pictures, links and marks that only the repository resolves."""

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface

ELSEWHERE = "Pictures and pages that this text names are in the folders `.figures` and `docs` of the source distribution."


def description(readme: str) -> str:
    """Return Markdown without relative addresses: a link is replaced by its text, and a picture is left out."""
    text = re.sub(r"<!--.*?-->", "", readme)
    text = re.sub(r"^!\[[^\]]*\]\((?!https:)[^)]*\)\n+", "", text, flags=re.MULTILINE)
    text = re.sub(r"\[([^\]]*)\]\((?!https:)[^)]*\)", r"\1", text)
    return f"{text.rstrip()}\n\n{ELSEWHERE}\n"


class Description(MetadataHookInterface):
    """States the description when a package is built."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Add the key ``readme``."""
        readme = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": description(readme)}

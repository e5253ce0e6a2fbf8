"""``dir`` shows the public names of a package, and every package knows its version."""

import importlib
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = ("tsm", "fem_reference", "comparisons")
FILES = [
    path for package in PACKAGES for path in sorted((ROOT / package).rglob("__init__.py"))
    if "__all__" in path.read_text(encoding="utf-8")
]  # fmt: skip


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT).parent))
def test_a_package_shows_its_public_names_only(file: Path) -> None:
    package = importlib.import_module(".".join(file.relative_to(ROOT).parent.parts))
    assert set(dir(package)) - {"__version__"} == set(package.__all__)
    assert all(hasattr(package, name) for name in dir(package))


@pytest.mark.parametrize("name", PACKAGES)
def test_a_package_knows_its_version(name: str) -> None:
    package = importlib.import_module(name)
    assert package.__version__ == version("tsm-crossval")
    assert "__version__" in dir(package)
    with pytest.raises(AttributeError, match="has no attribute 'nosuch'"):
        package.nosuch  # noqa: B018


def test_the_version_is_not_looked_up_at_import() -> None:
    code = "import sys, tsm; assert 'importlib.metadata' not in sys.modules; tsm.__version__"
    subprocess.run([sys.executable, "-c", code], check=True)

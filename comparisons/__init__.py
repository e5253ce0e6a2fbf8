"""One scene through beams, solid elements and exact answers: translation, checks, errors, files, command line."""

from typing import TYPE_CHECKING


def __dir__() -> list[str]:
    from pkgutil import iter_modules

    return sorted([*(module.name for module in iter_modules(__path__)), "__version__"])


if not TYPE_CHECKING:

    def __getattr__(name: str) -> str:
        """Look the version up where it is asked for; that imports more than the package."""
        if name != "__version__":
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from comparisons.version import release

        return release()

"""Words of engineers that are no keys of a scene, from ``words.toml``: other names of keys, and what is not modelled.

`hint` answers an unknown key. The page "What a scene can say, and what it cannot" has the same tables.
"""

import difflib
import tomllib
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Final, NamedTuple

_DATA = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))


class Topic(NamedTuple):
    """Something that is not modelled: what a reader looks for, the answer, and the words that ask for it."""

    title: str
    answer: str
    words: tuple[str, ...]


def _by_word(table: Mapping[str, str]) -> dict[str, str]:
    return {word: text for words, text in table.items() for word in words.split()}


NOT_MODELLED: Final = tuple(
    Topic(item["title"], item["answer"], tuple(item["words"].split())) for item in _DATA["not_modelled"]
)
"""What is not modelled, topic by topic."""
OTHER_NAMES: Final[dict[str, tuple[str, ...]]] = {
    key: tuple(names.split()) for key, names in _DATA["other_names"].items()
}
"""Other names of keys and tables, by key. A name that several have means the first that its table knows."""
ELSEWHERE: Final = _by_word(_DATA["elsewhere"])
"""Where a known key or another name of it belongs, for tables that do not know it."""
CONVERTED: Final = _by_word(_DATA["converted"])
"""What a key is where the value of its other name is another."""


def meant(key: str, known: Collection[str]) -> str | None:
    """Return the known key that `key` is another name or a misspelling of; None if there is none."""
    word = key.lower().replace("-", "_")
    for name, others in OTHER_NAMES.items():
        if name in known and word in others:
            return name
    if word in ELSEWHERE or _topic(word) is not None:
        return None
    return _near(word, sorted(known), 0.7)


def hint(key: str, known: Collection[str]) -> str:
    """Return the answer to a key that is not in `known`: another key, where it belongs, or what is not modelled.

    Examples
    --------
    >>> hint("mu", ["friction", "side"]), hint("hieght", ["width", "height"]), hint("q", ["width", "height"])
    ('did you mean friction?', 'did you mean height?', 'a load along a beam is force_per_length in [[load]]')
    >>> hint("yield_stress", ["width", "height"]).partition(":")[0]
    'plasticity, damage and fracture are not modelled'
    """
    word = key.lower().replace("-", "_")
    near = meant(key, known)
    if near is not None:
        return f"did you mean {near}, {CONVERTED[word]}?" if word in CONVERTED else f"did you mean {near}?"
    if word in ELSEWHERE:
        return ELSEWHERE[word]
    topic = _topic(word, *word.split("_"))
    topic = topic or _topic(_near(word, [item for topic in NOT_MODELLED for item in topic.words], 0.85))
    return topic.answer if topic else "known are " + ", ".join(sorted(known))


def _near(word: str, known: Collection[str], alike: float) -> str | None:
    found: list[str] = difflib.get_close_matches(word, known, n=1, cutoff=alike)
    return found[0] if found else None


def _topic(*words: str | None) -> Topic | None:
    return next((topic for word in words for topic in NOT_MODELLED if word in topic.words), None)

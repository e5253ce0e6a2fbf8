"""Words of engineers that are no keys of a scene, from ``words.toml``: other names of keys, and what is not modelled.

`hint` answers an unknown key. The page "What a scene can say, and what it cannot" has the same tables.
"""

import difflib
import tomllib
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Final, NamedTuple

_DATA = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))


class Topic(NamedTuple):
    """Something that is not modelled: what a reader looks for, the answer, and the words that ask for it."""

    title: str
    answer: str
    words: list[str]


NOT_MODELLED: Final = [Topic(**{**item, "words": item["words"].split()}) for item in _DATA["not_modelled"]]
"""What is not modelled, topic by topic."""
OTHER_NAMES: Final[dict[str, list[str]]] = {key: names.split() for key, names in _DATA["other_names"].items()}
"""Other names of keys and tables, by key. A name that several have means the first that its table knows."""
ELSEWHERE: Final = {word: text for words, text in _DATA["elsewhere"].items() for word in words.split()}
"""Where a known key or another name of it belongs, for tables that do not know it."""
CONVERTED: Final = {word: text for words, text in _DATA["converted"].items() for word in words.split()}
"""What a key is where the value of its other name is another."""
_ANSWERS = {word: topic.answer for topic in NOT_MODELLED for word in topic.words}


def meant(key: str, known: Collection[str]) -> str | None:
    """Return the known key that `key` is another name or a misspelling of; None if there is none."""
    word = key.lower().replace("-", "_")
    named = (name for name, others in OTHER_NAMES.items() if name in known and word in others)
    return next(named, None if word in ELSEWHERE or word in _ANSWERS else _near(word, sorted(known), 0.7))


def hint(key: str, known: Collection[str]) -> str:
    """Return the answer to a key that is not in `known`: another key, where it belongs, or what is not modelled.

    Examples
    --------
    >>> hint("mu", ["friction", "side"]), hint("hieght", ["width", "height"]), hint("q", ["width", "height"])
    ('did you mean friction?', 'did you mean height?', 'a load along a beam is force_per_length in [[load]]')
    >>> hint("yield_stress", ["width", "height"]).partition(":")[0]
    'plasticity, damage and fracture are not modelled'
    """
    word, near = key.lower().replace("-", "_"), meant(key, known)
    if near is not None:
        return f"did you mean {near}, {CONVERTED[word]}?" if word in CONVERTED else f"did you mean {near}?"
    asked = next((part for part in (word, *word.split("_")) if part in _ANSWERS), None)
    asked = asked or _near(word, _ANSWERS, 0.85)
    return ELSEWHERE.get(word) or (_ANSWERS[asked] if asked else f"known are {', '.join(sorted(known))}")


def _near(word: str, known: Iterable[str], alike: float) -> str | None:
    return next(iter(difflib.get_close_matches(word, known, n=1, cutoff=alike)), None)

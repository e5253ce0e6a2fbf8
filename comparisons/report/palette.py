"""One colour for each model in all figures and pages, from Okabe and Ito's palette for colour-blind readers.

Elements of one model differ by markers and dashes, which also tell the models apart in grey.
"""

from comparisons.models import MODELS, Style
from comparisons.models.outside.programs import used

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#444444"

PIN = VERMILION


def _styles() -> dict[str, Style]:
    found = {words: style for model in (*MODELS.values(), *used()) for words, style in model.styles().items()}
    return dict(sorted(found.items(), key=lambda item: -len(item[0])))


def style(label: str) -> Style:
    """Return the style of the longest words of a model with which the label of a run begins.

    >>> style("TSM mixed, 20 elements").colour == GREEN
    True
    """
    for words, found in _styles().items():
        if label.startswith(words):
            return found
    raise ValueError(f"label = {label}: must begin with one of {', '.join(_styles())}")

"""One colour for each model, in every figure and on every page: Okabe and Ito's, told apart with every common colour blindness.

Elements of one model differ by markers and dashes, which also tell the models apart in grey.
"""

BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#444444"

MODELS = {
    "exact rod": BLACK,
    "elastica": GREY,
    "TSM exact": PURPLE,
    "TSM mixed": GREEN,
    "TSM timoshenko": BLUE,
    "TSM euler-bernoulli-simple": VERMILION,
    "TSM euler-bernoulli-cantilever": ORANGE,
    "solid": SKY,
}
"""By the words that the labels of a model begin with."""
PIN = VERMILION


def colour(label: str) -> str:
    """Return the colour of a run, by its label.

    Raises
    ------
    ValueError
        If the label begins with no model's name.

    Examples
    --------
    >>> colour("TSM mixed, 20 elements") == colour("TSM mixed-no-bow") == GREEN
    True
    """
    for name, value in MODELS.items():
        if label.startswith(name):
            return value
    raise ValueError(f"label = {label}: must begin with one of {', '.join(MODELS)}")

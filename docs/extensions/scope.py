"""What a scene can say, with the models that answer it, and what is not modelled."""

from collections.abc import Iterable
from dataclasses import dataclass

from comparisons.models import MODELS
from comparisons.scene import Scene, load_scene, read_scene
from comparisons.scene.words import NOT_MODELLED
from docs.extensions.markdown import table, text
from docs.extensions.messages import SCENES

STRIP = SCENES["strip"]


@dataclass(frozen=True, kw_only=True)
class Question:
    """Something that a scene can say.

    Attributes
    ----------
    wish : str
        What a reader wants to state.
    keys : str
        The keys, in Markdown.
    limits : str
        What the models assume, in Markdown.
    built_in : str
        A built-in scene that says it.
    changes, add : tuple of (str, str), str
        What is replaced in the scene `STRIP`, and added to it, where there is no such built-in scene.
    """

    wish: str
    keys: str
    limits: str = ""
    built_in: str = ""
    changes: tuple[tuple[str, str], ...] = ()
    add: str = ""

    @property
    def scene(self) -> Scene:
        """A scene that says it."""
        if self.built_in:
            return load_scene(self.built_in)
        text = STRIP
        for old, new in self.changes:
            if text.count(old) != 1:
                raise ValueError(f"{old!r} must stand once in the scene")
            text = text.replace(old, new)
        return read_scene(text + self.add, self.wish)


LOAD = '[[load]]\nbeam = "strip"\n'
SECTION = "width = 0.02\nheight = 0.01"
GROUPS = {
    "Shape and material of a beam": (
        Question(
            wish="a straight, uniform beam",
            keys="`start`, `end`, `width`, `height`",
            limits="plane sections; slender beams: the solid shows what the height adds",
            built_in="ks-face",
        ),
        Question(
            wish="a section by its stiffnesses",
            keys="`area`, `second_moment`, `shear_area`",
            limits="contact on the axis; the solid has the rectangle with this area and second moment",
            changes=(
                (SECTION, "area = 2e-4\nsecond_moment = 1.7e-9"),
                ('surface = "face"', 'surface = "axis"'),
            ),
        ),
        Question(
            wish="a beam that is curved by nature",
            keys="`turn`",
            limits="an arc of a circle, free of stress; other shapes are several arcs",
            changes=((SECTION, f"{SECTION}\nturn = -0.1"),),
        ),
        Question(
            wish="a section that tapers",
            keys="`height = [h0, h1]`, `width = [b0, b1]`",
            limits="linear from start to end",
            changes=((SECTION, "width = [0.02, 0.01]\nheight = 0.01"),),
        ),
        Question(
            wish="an elastic material",
            keys="`youngs_modulus`, `poissons_ratio` or `shear_modulus`, `material`",
            limits="beams and exact rods are linear in strain at any rotation; `material` is the law of the solid at large strain",
            changes=((SECTION, f'{SECTION}\nmaterial = "neo-hookean"'),),
        ),
    ),
    "Supports and joints": (
        Question(
            wish="clamped, pinned, sliding ends",
            keys='`clamped`, `[[support]]` with `kind = "clamped"`, `"pinned"`, `"roller"`, or `fixed`',
            limits="one support for a joint; a roller is free in x or in y",
            built_in="two-pins",
        ),
        Question(
            wish="a support that moves",
            keys="`displacement`, `rotation` of `[[support]]`",
            limits="in proportion to the load parameter",
            built_in="ks-tied-tip",
        ),
        Question(
            wish="a support that gives way",
            keys="`[[spring]]`",
            limits="linear springs at a beam's end",
            add='[[spring]]\nbeam = "strip"\nend = "end"\nstiffness = [0.0, 50.0]\n',
        ),
        Question(
            wish="a frame with stiff corners",
            keys="equal coordinates of ends",
            limits="rigid joints",
            built_in="portal-frame",
        ),
        Question(
            wish="a hinge",
            keys="`[[hinge]]`",
            limits="free of moment, or with a linear spring",
            add='[[hinge]]\nbeam = "strip"\nend = "start"\nstiffness = 10.0\n',
        ),
    ),
    "Loads": (
        Question(
            wish="a force, a moment",
            keys="`force`, `moment` of `[[load]]` with `end`",
            limits="dead: a force keeps its direction",
            built_in="tip-load",
        ),
        Question(
            wish="the same inside a beam",
            keys="`at`",
            limits="dead",
            add=f"{LOAD}at = 0.7\nforce = [0.0, -1.0]\n",
        ),
        Question(
            wish="a force per length",
            keys="`force_per_length`, `part`",
            limits="dead, per undeformed length, constant over the part",
            add=f"{LOAD}force_per_length = [0.0, -2.0]\n",
        ),
        Question(
            wish="weight",
            keys="`density`, `gravity`",
            limits="grows with the load parameter; a stage of its own puts it first",
            changes=(
                ('units = "N, m"', 'units = "N, m"\ngravity = [0.0, -9.81]'),
                (SECTION, f"{SECTION}\ndensity = 2700.0"),
            ),
        ),
        Question(
            wish="a load past its largest value",
            keys="a support or a pin that moves",
            limits="dead loads end at a limit point by name; `tsm.trace` follows the path beyond it from Python",
            built_in="three-point-bending",
        ),
        Question(
            wish="loading, then unloading",
            keys="`path` of a pin, `[[stage]]`",
            limits="states follow one another; friction keeps its history",
            add='[[stage]]\nload_parameters = 20\npin = [{ name = "pin", displacement = [0.0, -0.1] }]\n',
        ),
    ),
    "Contact": (
        Question(
            wish="a pin that pushes a beam",
            keys="`[[pin]]` with `[[contact]]`, `side`",
            limits="the pin follows its path and does not turn",
            built_in="ks-cantilever",
        ),
        Question(
            wish="a stop at rest, a support that the beam can leave",
            keys="a pin with `displacement = [0.0, 0.0]`",
            changes=(("displacement = [0.0, 0.1]", "displacement = [0.0, 0.0]"),),
            add=f'{LOAD}end = "end"\nforce = [0.0, -1.0]\n',
        ),
        Question(
            wish="a round pin on the surface",
            keys='`radius`, `surface = "face"`',
            limits="one point of contact for a pin and a beam; contact with the end of a beam is named and not modelled",
            changes=(("start = [0.4, -0.005]", "start = [0.4, -0.007]\nradius = 0.002"),),
        ),
        Question(
            wish="several pins",
            keys="one `[[pin]]` and one `[[contact]]` for each",
            limits="each pin names the beam that it touches",
            built_in="two-pins",
        ),
        Question(
            wish="beams that touch one another",
            keys='`node = "upper.end"`',
            limits="the end of one beam on the side of another, no contact between two sides",
            built_in="double-beam",
        ),
        Question(
            wish="friction",
            keys="`friction`",
            limits="Coulomb, one coefficient; not in the paper's elements, and by no beam on the face of one that tapers in height",
            built_in="ks-friction",
        ),
    ),
}
"""What a scene can say, by kinds of question."""


def page() -> str:
    """Return one table for every kind of question, and the table of what is not modelled."""
    sections = []
    for title, questions in GROUPS.items():
        rows = [(item.wish, item.keys, *_answers(item.scene), item.limits) for item in questions]
        sections.append(f"## {title}\n\n" + table(("you want", "you write", *MODELS, "limits"), rows))
    rows = [(topic.title, text(topic.answer), _words(topic.words)) for topic in NOT_MODELLED]
    sections.append("## What is not modelled\n\n" + table(("topic", "answer", "words"), rows))
    return "\n\n".join(sections) + "\n"


def _answers(scene: Scene) -> list[str]:
    """Return for every model whether it states the scene."""
    refusals = [model.unstated(scene) or model.refusal(scene) for model in MODELS.values()]
    return ["yes" if refusal is None else "no" for refusal in refusals]


def _words(words: Iterable[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)

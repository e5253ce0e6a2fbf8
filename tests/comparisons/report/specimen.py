"""A scene with natural curvature, taper, weight, loads along and inside a beam, a hinge, springs, a round pin and two stages."""

from pathlib import Path

from comparisons.scene import load_scene

SPECIMEN = load_scene(str(Path(__file__).with_suffix(".toml")))

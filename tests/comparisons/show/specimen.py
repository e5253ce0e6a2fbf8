"""A scene with natural curvature, taper, weight, loads along and inside a beam, a hinge, springs, a round pin and two stages."""

SPECIMEN = """
scene = { name = "specimen", units = "N, mm", load_parameters = 4, gravity = [0, -9810] }
beam = [
  { name = "hook", start = [0, 0], end = [100, 0], turn = -1.6, clamped = ["start"], width = 10, height = [6, 2], youngs_modulus = 2.1e5, poissons_ratio = 0.3, density = 7.8e-9 },
  { name = "flat", start = [140, 0], end = [300, 0], clamped = ["end"], width = 10, height = [2, 6], youngs_modulus = 2.1e5, poissons_ratio = 0.3 },
  { name = "link", start = [140, 0], end = [140, 60], width = 10, height = 2, youngs_modulus = 2.1e5, poissons_ratio = 0.3 },
]
hinge = [{ beam = "link", end = "start" }]
spring = [{ beam = "link", end = "end", stiffness = [3.5, 0], rotation = 100 }]
load = [
  { beam = "flat", force_per_length = [0, -0.01], part = [0.2, 0.8] },
  { beam = "hook", at = 0.5, force = [0, -2] },
]
pin = [{ name = "drum", start = [200, -12], displacement = [0, 6], radius = 12 }]
contact = [{ node = "drum", beam = "flat", side = "right" }]
stage = [{ load_parameters = 2, pin = [{ name = "drum", displacement = [20, 0] }], load = [{ beam = "hook", end = "end", force = [0, 1] }] }]
"""

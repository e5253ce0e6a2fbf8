"""The face of a beam: the envelope of circles about the points of its axis.

Their radius is h/2 where the height h is constant, and ``h/2 / sqrt(1 + (h'/2)^2)`` where it tapers, so that the face of an undeformed
straight beam is at h/2 from the axis. A round pin of radius R touches where its centre has the distance R more.
"""

import math

from comparisons.scene import ContactSpec, Scene


def face_slope(scene: Scene, spec: ContactSpec) -> float:
    """Derivative of `touching_distance` by the arc position."""
    beam = scene.beam(spec.beam)
    steep = (beam.height_at(1.0) - beam.height_at(0.0)) / (2.0 * beam.length)
    return 0.0 if spec.surface == "axis" or not steep else steep / math.hypot(1.0, steep)


def touching_distance(scene: Scene, spec: ContactSpec, arc: float) -> float:
    """Distance of a node, or of the centre of a round pin, from the axis point at which it touches."""
    steep = face_slope(scene, spec)
    if not steep:
        return scene.offset(spec)
    start = scene.beam(spec.beam).height_at(0.0) / 2.0 * math.sqrt(1.0 - steep**2)
    return scene.radius(spec) + start + steep * arc

"""A scene as solid strips: plane stress, thickness equal to the width, unilateral contact."""

from collections import defaultdict
from collections.abc import Iterator
from typing import TYPE_CHECKING

from comparisons.models.options import ModelError
from comparisons.scene import BeamSpec, Scene, SupportSpec
from comparisons.scene.conditions import COMPONENTS
from comparisons.scene.keys import STRIPS, unstated
from comparisons.scene.rules import Point

if TYPE_CHECKING:
    from fem_reference import EndLoad, Joint, LineLoad, PointLoad, SolidProblem, Spring, Strip, Support

ENDS = ("start", "end")
LEAST_RATIO = -0.999
"""Least Poisson's ratio. There the shear modulus is 500 times Young's modulus; a solid that is stiffer in shear locks."""

SLENDER = 0.125
"""Largest height over length of the rectangle that replaces a section given by area and second moment."""


def to_solid(scene: Scene, *, mesh: tuple[int, int] | None = None) -> "SolidProblem":
    """Return the `fem_reference.SolidProblem` of `scene`.

    Parameters
    ----------
    scene : Scene
        Any scene whose supports, with the pins that touch at the start, hold every structure.
    mesh : (int, int), optional
        Elements along and across of every beam, in place of the scene's.

    Raises
    ------
    ValueError
        If the solid cannot state the scene, in one line.
    """
    from fem_reference import Contact, Pin, SolidProblem

    unknown = unstated(scene, "the solid", STRIPS)
    if unknown is not None:
        raise ModelError(unknown)
    clamps = {spec.node for spec in scene.all_supports if _is_clamp(scene, spec)}
    return SolidProblem(
        strips=tuple(_strip(beam, clamps, mesh) for beam in scene.beams),
        supports=tuple(_support(scene, spec) for spec in scene.all_supports if spec.node not in clamps),
        joints=tuple(_joint(scene, ends) for ends in _joints(scene)),
        springs=tuple(_springs(scene)),
        loads=tuple(_end_loads(scene)),
        inner_loads=(*_inner_loads(scene), *_weights(scene)),
        pins=tuple(
            Pin(
                name=pin.name,
                path=pin.stage_points[0],
                radius=pin.radius or 0.0,
                onward=tuple(points[1:] for points in pin.stage_points[1:]),
            )
            for pin in scene.pins
        ),
        contacts=tuple(
            Contact(
                node=contact.node,
                strip=contact.beam,
                side=contact.side,
                surface=contact.surface,
                penalty=contact.penalty,
                penetration=contact.penetration,
                keep=contact.keep,
                friction=contact.friction,
            )
            for contact in scene.contacts
        ),
    )


def _joints(scene: Scene) -> list[tuple[str, ...]]:
    """Return the ends that meet, joint by joint."""
    meeting: dict[Point, list[str]] = defaultdict(list)
    for beam in scene.beams:
        for end in ENDS:
            meeting[scene.place(f"{beam.name}.{end}")].append(f"{beam.name}.{end}")
    return [tuple(ends) for ends in meeting.values() if len(ends) > 1]


def _is_clamp(scene: Scene, spec: SupportSpec) -> bool:
    """Whether a support clamps the edge itself: it holds a single end at rest that bears no load and no spring.

    Any other support holds the mean displacement and rotation of the end's section.

    Raises
    ------
    ModelError
        If the beam asks for a full clamp where its section is held.
    """
    if len(spec.held) < len(COMPONENTS):
        return False
    joined = spec.node in _hinged(scene) or any(spec.node in ends for ends in _joints(scene))
    acting = [load.node for _, load in scene.numbered_loads()] + [spring.node for spring in scene.springs]
    loaded = spec.node in acting
    moves = scene.prescribed_motions[spec.node].moves
    if not (moves or joined or loaded):
        return True
    if scene.beam(spec.beam).solid_clamp == "full":
        raise ModelError(
            f'the solid model has a full clamp at rest without joint, load and spring, "{spec.node}" is another; use solid_clamp = "rod"'
        )
    return False


def _hinged(scene: Scene) -> dict[str, float]:
    """Return the ends with a hinge, and the stiffness of its spring."""
    return {hinge.node: hinge.stiffness for hinge in scene.hinges}


def _joint(scene: Scene, ends: tuple[str, ...]) -> "Joint":
    """Return a joint. Its first end is one without a hinge, if there is one."""
    from fem_reference import Joint

    hinges = _hinged(scene)
    first, *others = sorted(ends, key=lambda end: end in hinges)
    hinged = tuple(end for end in others if end in hinges)
    return Joint(ends=(first, *others), hinged=hinged, stiffness=tuple(hinges[end] for end in hinged))


def _support(scene: Scene, spec: SupportSpec) -> "Support":
    """Return a support. Where all ends of its joint turn freely in hinges, it holds no rotation."""
    from fem_reference import Support

    motion = spec.motion
    if "rotation" in spec.held and not _turns_with_joint(scene, spec.node, "support"):
        motion = (*motion[:2], None)
    return Support(
        strip=spec.beam,
        end=spec.end,
        motion=motion,
        onward=scene.prescribed_motions[spec.node].increments[1:],
    )


def _springs(scene: Scene) -> "Iterator[Spring]":
    """Yield the springs."""
    from fem_reference import Spring

    for spec in scene.springs:
        turning = spec.rotation if spec.rotation and _turns_with_joint(scene, spec.node, "spring") else 0.0
        if any((*spec.stiffness, turning)):
            yield Spring(strip=spec.beam, end=spec.end, stiffness=(*spec.stiffness, turning))


def _turns_with_joint(scene: Scene, node: str, kind: str) -> bool:
    """Whether the end at a condition on the rotation turns with its joint; False where all ends of the joint turn freely in hinges.

    Raises
    ------
    ModelError
        If the end has a hinge, and the joint's rotation is not free of the beams.
    """
    hinges = _hinged(scene)
    ends = next((ends for ends in _joints(scene) if node in ends), (node,))
    if node not in hinges:
        return True
    if any(end not in hinges or hinges[end] for end in ends):
        plain = next((end for end in ends if end not in hinges), None)
        way = f'state it at "{plain}"' if plain else "use a pinned support and a [[spring]] with a rotation"
        raise ModelError(
            f'the solid model states the rotation of a joint at an end without a hinge, the {kind} "{node}" has one; {way}, or --model tsm'
        )
    return False


def _end_loads(scene: Scene) -> "Iterator[EndLoad]":
    """Yield the forces and moments on the ends."""
    from fem_reference import EndLoad

    for stage, load in scene.numbered_loads():
        if load.end is None:
            continue
        beam, end = load.beam, load.end
        if load.moment and load.node in _hinged(scene):
            beam, end = _fixed_end(scene, load.node).split(".")
        yield EndLoad(strip=beam, end=end, force=load.force, moment=load.moment, stage=stage)


def _fixed_end(scene: Scene, node: str) -> str:
    """Return an end without a hinge at the joint of ``node``, on which a moment on the joint acts.

    Raises
    ------
    ModelError
        If all ends of the joint have hinges.
    """
    ends = next((ends for ends in _joints(scene) if node in ends), (node,))
    fixed = next((end for end in ends if end not in _hinged(scene)), None)
    if fixed is None:
        raise ModelError(
            f'the solid model states a moment on a joint with an end without a hinge, "{node}" has none'
        )
    return fixed


def _inner_loads(scene: Scene) -> "Iterator[PointLoad | LineLoad]":
    """Yield the forces and moments inside the beams and the forces per length."""
    from fem_reference import LineLoad, PointLoad

    for stage, load in scene.numbered_loads():
        if load.force_per_length is not None:
            yield LineLoad(strip=load.beam, force=(load.force_per_length,), part=load.span, stage=stage)
        elif load.at is not None:
            yield PointLoad(strip=load.beam, at=load.at, force=load.force, moment=load.moment, stage=stage)


def _weights(scene: Scene) -> "Iterator[LineLoad]":
    """Yield the weights of the beams."""
    from fem_reference import LineLoad

    for beam in scene.beams:
        if beam.density is None:
            continue
        for stage, (gx, gy) in enumerate(scene.stage_gravities):
            if gx or gy:
                force = tuple((gx * mass, gy * mass) for mass in beam.mass_coefficients())
                yield LineLoad(strip=beam.name, force=force, stage=stage)


def rectangle(beam: BeamSpec) -> tuple[float, float]:
    """Return width and height of a beam's section at the start, or of the rectangle with its area and second moment.

    ``h = sqrt(12 I / A)``, ``b = A / h``.

    Raises
    ------
    ModelError
        If the rectangle is not slender in the plane.
    """
    if beam.width is not None and beam.height is not None:
        return _ends(beam.width)[0], _ends(beam.height)[0]
    height = beam.rectangle_height
    if height > SLENDER * beam.length:
        raise ModelError(
            f'the solid model needs the width and height of beam "{beam.name}": the rectangle of its area and second '
            f"moment is {height:.3g} high, more than an eighth of the length"
        )
    return beam.cross_section[0] / height, height


def _ends(dimension: float | tuple[float, float]) -> tuple[float, float]:
    """Return a dimension of the section at both ends."""
    return dimension if isinstance(dimension, tuple) else (dimension, dimension)


def _strip(beam: BeamSpec, clamps: set[str], mesh: tuple[int, int] | None) -> "Strip":
    from fem_reference import Strip

    width, height = rectangle(beam)
    nu = beam.poissons_ratio
    if nu is None:
        nu = beam.youngs_modulus / (2.0 * (beam.shear_modulus or beam.youngs_modulus)) - 1.0
    if not LEAST_RATIO < nu < 0.5:
        raise ModelError(
            f"the solid model needs a Poisson's ratio between {LEAST_RATIO:g} and 0.5, E/(2 G) - 1 = {nu:.6g}"
        )
    if (mesh or beam.mesh)[0] < 2:
        raise ModelError("the solid model needs at least 2 elements along the beam")
    return Strip(
        name=beam.name,
        start=beam.start,
        end=beam.end,
        turn=beam.turn,
        height=height,
        width=width,
        end_height=beam.height[1] if isinstance(beam.height, tuple) else None,
        end_width=beam.width[1] if isinstance(beam.width, tuple) else None,
        youngs_modulus=beam.youngs_modulus,
        poissons_ratio=nu,
        clamped=tuple(end for end in ENDS if f"{beam.name}.{end}" in clamps),
        clamp=beam.solid_clamp,
        element=beam.solid_element,
        mesh_file=beam.solid_mesh_file if mesh is None else None,
        mesh=mesh or beam.mesh,
        material=beam.material,
    )

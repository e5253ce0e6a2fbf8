"""Words of engineers that are no keys of a scene: other names of keys, and what is not modelled.

`hint` answers an unknown key. The page "What a scene can say, and what it cannot" has the same tables.
"""

import difflib
from collections.abc import Collection
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, kw_only=True)
class Topic:
    """Something that is not modelled.

    Attributes
    ----------
    title : str
        What a reader looks for.
    answer : str
        What is not modelled, and what a scene can state instead.
    words : str
        Keys by which one would state it, with spaces between them. A key of several words, as ``damping_ratio``, is recognised by
        any of its words.
    """

    title: str
    answer: str
    words: str


NOT_MODELLED: Final = (
    Topic(
        title="Dynamics",
        answer="dynamics is not modelled: every state is an equilibrium at rest; a weight is density with gravity in [scene]",
        words="""
            dynamics dynamic mass masses damping damper dashpot velocity velocities acceleration impact
            impulse restitution vibration frequency frequencies eigenfrequency modes modal rayleigh period
            time dt duration transient omega
        """,
    ),
    Topic(
        title="Plasticity, damage, fracture",
        answer="plasticity, damage and fracture are not modelled: every material is elastic; compare the stress of the result with a strength",
        words="""
            plasticity plastic yield yielding hardening strength sigma_y elastoplastic damage fracture
            failure crack fatigue ductility rupture toughness
        """,
    ),
    Topic(
        title="Creep, relaxation, rates",
        answer="creep, relaxation and other effects of time are not modelled: every material is elastic",
        words="""
            creep relaxation viscosity viscous viscoelastic viscoelasticity rate prony ageing aging loss
            hysteretic
        """,
    ),
    Topic(
        title="A third dimension",
        answer="a third dimension is not modelled: points are [x, y], beams bend in the plane, width is the size out of it",
        words="""
            z torsion torsional twist twisting warping lateral spatial iyz it torsion_constant out_of_plane
            shell shells plate plates dimension dimensions 3d
        """,
    ),
    Topic(
        title="Temperature",
        answer="temperature is not modelled; a free thermal curvature is the natural curvature turn of a beam",
        words="""
            temperature temperatures thermal heat heating expansion cte conductivity alpha delta_t kelvin
            celsius
        """,
    ),
    Topic(
        title="Initial stress",
        answer="initial stress is not modelled; a stress-free arc is turn, a tension comes from a support that moves in an earlier [[stage]]",
        words="""
            prestress prestressed prestrain pretension preload precompression eigenstrain residual
            initial_stress initial_strain
        """,
    ),
    Topic(
        title="Layers, directions, other material laws",
        answer="layers and anisotropy are not modelled; effective stiffnesses are area, second_moment and shear_area with one youngs_modulus",
        words="""
            layers layer laminate laminated composite layup ply plies bimetal sandwich orthotropic
            orthotropy anisotropic anisotropy fibre fiber e1 e2 g12 nu12
        """,
    ),
    Topic(
        title="Loads that follow the beam",
        answer="follower loads and pressure are not modelled: a load keeps its direction; a force per length is force_per_length",
        words="""
            pressure follower following fluid hydrostatic suction inflation centrifugal magnetic electric
            electrostatic piezo voltage capillary surface_tension
        """,
    ),
    Topic(
        title="Elastic beddings",
        answer="an elastic bedding is not modelled; a spring acts on a beam's end, [[spring]]",
        words="""
            foundation bedding winkler subgrade soil matrix
        """,
    ),
    Topic(
        title="Other laws of contact",
        answer="adhesion, wear, lubrication and a static coefficient of friction of its own are not modelled: Coulomb's law has one coefficient, friction",
        words="""
            adhesion adhesive cohesion cohesive glue glued bond bonded wear lubrication lubricated mu_s mu_d
            mu_k static_friction dynamic_friction kinetic_friction stribeck rolling_friction
            rolling_resistance stick
        """,
    ),
    Topic(
        title="Self-contact",
        answer="self-contact is not modelled: a beam touches pins and ends of other beams",
        words="""
            self_contact self selfcontact
        """,
    ),
    Topic(
        title="Other obstacles",
        answer="other obstacles are not modelled: a beam touches points and round pins, also pins at rest, and its ends touch beams; a wall is a stiff beam",
        words="""
            obstacle obstacles wall walls ground floor plane rigid rigid_body cylinder block die punch
            indenter polygon body bodies
        """,
    ),
    Topic(
        title="A pin that turns or is pushed",
        answer="a pin follows its path and does not turn: a force on a pin, a free pin and a roller are not modelled",
        words="""
            spin rolling angular_velocity free_pin follows
        """,
    ),
    Topic(
        title="Constraints between ends",
        answer="constraints between ends are not modelled: equal coordinates are a rigid joint, [[hinge]] releases its moment",
        words="""
            constraint constraints mpc coupling coupled link links tie slider slot
        """,
    ),
    Topic(
        title="Imperfections and random values",
        answer="imperfections and random values are not modelled by keys: move an end, add a small load, or vary a key in a study file",
        words="""
            imperfection imperfections perturbation random noise scatter tolerance_band
        """,
    ),
    Topic(
        title="Settings of a solver",
        answer="settings of a solver are no part of a scene: they are options of the command, crossval solve --help",
        words="""
            solver tolerance tol iterations max_iterations max_iter newton line_search arc_length arclength
            riks convergence method algorithm integrator accuracy
        """,
    ),
)
"""What is not modelled, topic by topic."""

OTHER_NAMES: Final = {
    "youngs_modulus": "e young youngs young_modulus e_modulus elastic_modulus modulus emod",
    "poissons_ratio": "nu poisson poissons poisson_ratio v",
    "shear_modulus": "g gmod g_modulus",
    "second_moment": "iz i inertia moment_of_inertia second_moment_of_area area_moment iy izz iyy",
    "area": "a section_area cross_section_area cross_section section",
    "shear_area": "as av shear_section kappa shear_factor shear_correction",
    "width": "b breadth",
    "height": "h t thickness depth d",
    "turn": "curvature natural_curvature radius arc bend angle curved kappa0 bow",
    "density": "rho weight self_weight selfweight dead_weight own_weight specific_weight",
    "gravity": "g weight self_weight selfweight",
    "clamped": "clamp fixed encastre built_in supports support bc boundary",
    "elements": "number_of_elements n_elements nel element divisions",
    "part": "between range extent from to start begin x0 x1 s0 s1",
    "start": "from begin node1 p0 p1 x0 origin center centre position coordinates",
    "end": "to node2 p2 stop",
    "material": "law material_law constitutive",
    "kind": "type condition bc boundary support",
    "fixed": "held restrained dofs dof locked",
    "displacement": "u move motion settlement dx dy prescribed",
    "rotation": "phi theta angle rot",
    "at": "position location s xi where",
    "force": "f p fx fy load magnitude value point_load",
    "moment": "m torque couple mz",
    "force_per_length": "q distributed line_load udl distributed_load uniform_load per_length w",
    "stiffness": "k kx ky spring_constant rate_constant",
    "radius": "r diameter d size",
    "path": "points trajectory polyline way",
    "node": "pin slave secondary tip with",
    "beam": "master primary target element",
    "friction": "mu friction_coefficient coefficient_of_friction coulomb",
    "penalty": "contact_stiffness penalty_stiffness kn",
    "load_parameters": "steps increments load_steps n_steps number_of_steps substeps nsteps step",
    "name": "title id label tag",
    "units": "unit unit_system",
    "pin": "pins indenters",
    "support": "supports boundary bc boundary_condition restraint bearing",
    "load": "loads forces loading",
    "contact": "contacts pair pairs interaction",
    "spring": "springs",
    "hinge": "hinges release releases joint",
    "stage": "stages step steps phase unloading",
}
"""Other names of keys and tables, by key. A name that several have means the first that its table knows."""

ELSEWHERE: Final = {
    "stiffness": "a spring is a table of its own, [[spring]]",
    "spring": "a spring is a table of its own, [[spring]]",
    "springs": "a spring is a table of its own, [[spring]]",
    "k": "a spring is a table of its own, [[spring]]",
    "hinge": "a hinge is a table of its own, [[hinge]]",
    "hinges": "a hinge is a table of its own, [[hinge]]",
    "hinged": 'a hinged end is a [[support]] of kind = "pinned", or a [[hinge]] at a joint',
    "pinned": 'a pinned end is a [[support]] of kind = "pinned"',
    "roller": 'a roller is a [[support]] of kind = "roller"',
    "gravity": "gravity belongs to [scene], density to [[beam]]",
    "density": "density belongs to [[beam]], gravity to [scene]",
    "weight": "a weight is density in [[beam]] with gravity in [scene]",
    "self_weight": "a weight is density in [[beam]] with gravity in [scene]",
    "force_per_length": "a load along a beam is force_per_length in [[load]]",
    "distributed": "a load along a beam is force_per_length in [[load]]",
    "line_load": "a load along a beam is force_per_length in [[load]]",
    "q": "a load along a beam is force_per_length in [[load]]",
    "force": "a force belongs to [[load]]",
    "moment": "a moment belongs to [[load]]",
    "friction": "friction belongs to [[contact]]",
    "mu": "the coefficient of friction is friction in [[contact]]",
    "gap": "the gap follows from where pins and beams are",
    "clearance": "the gap follows from where pins and beams are",
    "initial_gap": "the gap follows from where pins and beams are",
    "material": "the material is stated in every [[beam]]",
    "materials": "the material is stated in every [[beam]]",
    "section": "the section is stated in every [[beam]]",
    "sections": "the section is stated in every [[beam]]",
    "node": "ends are stated by coordinates, start and end of a [[beam]]",
    "nodes": "ends are stated by coordinates, start and end of a [[beam]]",
    "element": "the number of elements is stated in every [[beam]]",
    "elements": "the number of elements is stated in every [[beam]]",
    "mesh": "the mesh of the solid is stated in every [[beam]]",
    "units": "units belong to [scene]",
    "load_parameters": "load_parameters belongs to [scene] and [[stage]]",
    "stage": "a stage is a table of its own, [[stage]]",
    "turn": "turn belongs to [[beam]]",
    "radius": "radius belongs to [[pin]]; the arc of a beam is turn",
    "model": "the model is an option of the command, --model",
    "models": "the model is an option of the command, --model",
    "bar": "a bar is a [[beam]] with a [[hinge]] at its ends",
    "truss": "a bar is a [[beam]] with a [[hinge]] at its ends",
    "cable": "a cable is a [[beam]] of little height",
    "rope": "a cable is a [[beam]] of little height",
    "spline": "a beam is straight or an arc; join several",
    "shape": "a beam is straight or an arc; join several",
}
"""Where a known key or another name of it belongs, for tables that do not know it."""


CONVERTED: Final = {
    "curvature": ", the angle of the arc in rad: the curvature times the length",
    "natural_curvature": ", the angle of the arc in rad: the curvature times the length",
    "kappa0": ", the angle of the arc in rad: the curvature times the length",
    "radius": ", the angle of the arc in rad: the length over the radius",
    "weight": ", the mass per volume, with gravity in [scene]",
    "self_weight": ", the mass per volume, with gravity in [scene]",
    "specific_weight": ", the mass per volume, with gravity in [scene]",
    "diameter": ", half of the diameter",
    "shear_factor": ", the factor times the area",
    "shear_correction": ", the factor times the area",
    "kappa": ", the factor times the area",
}
"""What a key is where the value of its other name is another."""


def meant(key: str, known: Collection[str]) -> str | None:
    """Return the known key that `key` is another name or a misspelling of; None if there is none."""
    word = key.lower().replace("-", "_")
    for name, others in OTHER_NAMES.items():
        if name in known and word in others.split():
            return name
    if word in ELSEWHERE or _topic(word, word) is not None:
        return None
    near = difflib.get_close_matches(word, sorted(known), n=1, cutoff=0.7)
    return near[0] if near else None


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
        return f"did you mean {near}{CONVERTED.get(word, '')}?"
    if word in ELSEWHERE:
        return ELSEWHERE[word]
    topic = _topic(word, *word.split("_")) or _misspelt_topic(word)
    return topic.answer if topic else "known are " + ", ".join(sorted(known))


def _topic(*words: str) -> Topic | None:
    return next((topic for word in words for topic in NOT_MODELLED if word in topic.words.split()), None)


def _misspelt_topic(word: str) -> Topic | None:
    words = [item for topic in NOT_MODELLED for item in topic.words.split()]
    return _topic(*difflib.get_close_matches(word, words, n=1, cutoff=0.85))

"""CalculiX's input for a clamped strip: a slab of quadratic bricks, thin enough for plane stress.

CalculiX replaces its plane elements by bricks with tied faces. This deck states the bricks directly, so that nothing is tied.
The bricks fill the half of the slab above the middle plane. Nodes on the middle plane are held in the direction of the thickness,
and the upper face is free. The modulus is ``E b / w``, so that the half slab of thickness w carries the forces of the whole strip
of width b.

- With ``NLGEOM``, ``*ELASTIC`` is linear between Green's strain and the second Piola-Kirchhoff stress. This is the law of
  St. Venant and Kirchhoff, to the seven digits that CalculiX prints.
- CalculiX takes a residual force below 1e-6 for zero, whatever the units. Forces are therefore stated in 1e-5 EI/L^2.
- A number has at most twenty characters.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from fem_reference import Strip

Array = NDArray[Any]
Point = tuple[float, float]

THINNESS = 0.01
"""Thickness w of the half slab over the strip's height."""
_CORNERS = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
_BARS = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
_FACE = np.array([[-1.0, 4.0, -1.0], [4.0, 0.0, 4.0], [-1.0, 4.0, -1.0]]) / 12
"""Consistent nodal forces of a unit force that is spread evenly over a face with eight nodes."""
_CONTROLS = ("*CONTROLS, PARAMETERS=FIELD", "1.E-6,1.E-8")
_PRINT = (
    "*NODE PRINT, NSET=TIP", "U", "*NODE PRINT, NSET=AXIS", "U", "*NODE PRINT, NSET=CLAMP", "U,RF", "*END STEP", "",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, eq=False)
class Slab:
    """A strip as a mesh of bricks, in the strip's frame.

    Parameters
    ----------
    strip
        The strip that the bricks fill.
    numbers
        Numbers of the nodes on the grid of corners and midpoints, ``(2 nx + 1, 2 ny + 1, 3)``; 0 at a grid point without a node.
    points
        Positions of the grid points, ``(2 nx + 1, 2 ny + 1, 3, 3)`` [m].
    bricks
        Nodes of the elements ``(nx ny, 20)`` in CalculiX's order, column by column.
    """

    strip: "Strip"
    numbers: Array
    points: Array
    bricks: Array

    @property
    def unit(self) -> float:
        """Unit of force of the deck [N]."""
        return 1e-5 * self.strip.bending_stiffness / self.strip.length**2

    @property
    def thickness(self) -> float:
        """Thickness w [m]."""
        return THINNESS * self.strip.height

    @property
    def axis(self) -> Array:
        """Positions of the nodes on the axis in the plane, from the clamp on, ``(a, 2)`` [m]."""
        middle = self.strip.mesh[1]
        found: Array = self.points[:, middle, 0][self.numbers[:, middle, 0] > 0][:, :2]
        return found

    @property
    def clamp(self) -> Array:
        """Positions of the clamped nodes in the plane, in the order of their numbers, ``(c, 2)`` [m]."""
        found: Array = self.points[0][self.numbers[0] > 0][:, :2]
        return found


def slab(strip: "Strip") -> Slab:
    """Mesh a strip.

    Raises
    ------
    ValueError
        Unless the strip has St. Venant and Kirchhoff's law in plane stress, a clamp at its start and an even mesh.
    """
    stated = (strip.clamped, strip.material, strip.plane, strip.grading, strip.mesh_file)
    if stated != (("start",), "st-venant-kirchhoff", "stress", 1.0, None):
        raise ValueError(f"Strip({strip.name!r}): CalculiX's deck has no strip {stated}")
    nx, ny = strip.mesh
    i, j, k = np.indices((2 * nx + 1, 2 * ny + 1, 3))
    there = i % 2 + j % 2 + k % 2 <= 1
    numbers = np.where(there, np.cumsum(there).reshape(there.shape), 0)
    points = np.stack(
        [
            strip.length * i / (2 * nx),
            strip.height * (j / (2 * ny) - 0.5),
            THINNESS * strip.height * k / 2,
        ],
        axis=-1,
    )
    corners = np.array(_CORNERS)
    offsets = np.concatenate([corners, [(corners[a] + corners[b]) // 2 for a, b in _BARS]])
    columns, rows = np.divmod(np.arange(nx * ny), ny)
    at = np.stack([2 * columns, 2 * rows, 0 * rows], axis=-1)[:, None] + offsets
    return Slab(
        strip=strip, numbers=numbers, points=points, bricks=numbers[at[..., 0], at[..., 1], at[..., 2]]
    )


def tip_load_deck(mesh: Slab, force: float, steps: int | None = None) -> str:
    """Deck of a transverse dead load [N], spread evenly over the free end, in equal steps or in steps that CalculiX chooses."""
    ny, end = mesh.strip.mesh[1], mesh.numbers[-1]
    loads = np.zeros(end.shape)
    for row in range(ny):
        loads[2 * row : 2 * row + 3] += force / mesh.unit / ny * _FACE
    way = ["*STATIC", ".2,1."] if steps is None else ["*STATIC, DIRECT", f"{1 / steps:.12e},1."]
    step = ["*STEP, NLGEOM, INC=10000", *_CONTROLS, *way, "*CLOAD"]
    forces = [f"{n},2,{load:.12e}" for n, load in zip(end[end > 0], loads[end > 0], strict=True)]
    return "\n".join([*_model(mesh), *step, *forces, *_PRINT])


def pin_deck(mesh: Slab, start: Point, motion: Point, steps: int, penalty: float) -> str:
    """Deck of a sharp pin that moves along the right face in equal steps, from `start` by `motion` [m].

    The pin is a needle across the half slab. Its two nodes are the slaves of a contact with the face. `penalty` [N/m] is the contact
    stiffness. CalculiX multiplies the stated slope of the pressure by half the area of a face for each of the two nodes.
    """
    (nx, ny), thickness = mesh.strip.mesh, mesh.thickness
    needle = int(mesh.numbers.max()) + np.array([1, 2])
    slope = penalty / mesh.unit / (thickness * mesh.strip.length / nx)
    return "\n".join(
        [
            *_model(mesh),
            "*NODE, NSET=PIN",
            *(
                f"{n},{start[0]:.12e},{start[1]:.12e},{part * thickness:.12e}"
                for n, part in zip(needle, (0.25, 0.75), strict=True)
            ),
            "*SURFACE, NAME=NEEDLE, TYPE=NODE",
            "PIN",
            "*SURFACE, NAME=FACE",
            *(f"{1 + column * ny},S3" for column in range(nx)),
            "*SURFACE INTERACTION, NAME=HARD",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
            f"{slope:.12e}",
            "*CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE",
            "NEEDLE,FACE",
            f"*STEP, NLGEOM, INC={2 * steps}",
            *_CONTROLS,
            "*STATIC, DIRECT",
            f"{1 / steps:.12e},1.",
            "*BOUNDARY",
            *(f"PIN,{axis},{axis},{way:.12e}" for axis, way in enumerate((*motion, 0.0), start=1)),
            *_PRINT,
        ]
    )


def _model(mesh: Slab) -> list[str]:
    """Nodes, bricks, material and supports; the clamp named ``rod`` holds transverse motion on the edge's middle line only."""
    strip, n = mesh.strip, mesh.numbers
    modulus = strip.youngs_modulus * strip.width / mesh.thickness / mesh.unit
    nodes = zip(n[n > 0], mesh.points[n > 0], strict=True)
    bricks = enumerate(mesh.bricks.tolist(), start=1)
    return [
        "*NODE",
        *(f"{number},{x:.12e},{y:.12e},{z:.12e}" for number, (x, y, z) in nodes),
        "*ELEMENT, TYPE=C3D20R, ELSET=STRIP",
        *(f"{e},{','.join(map(str, brick[:10]))},\n{','.join(map(str, brick[10:]))}" for e, brick in bricks),
        *_node_set("CLAMP", n[0]),
        *_node_set("HELD", n[0] if strip.clamp == "full" else n[0, strip.mesh[1]]),
        *_node_set("MIDDLE", n[:, :, 0]),
        *_node_set("TIP", n[-1, :, 0]),
        *_node_set("AXIS", n[:, strip.mesh[1], 0]),
        "*MATERIAL, NAME=ELASTIC",
        "*ELASTIC",
        f"{modulus:.12e},{strip.poissons_ratio:.12e}",
        "*SOLID SECTION, ELSET=STRIP, MATERIAL=ELASTIC",
        "*BOUNDARY",
        "CLAMP,1,1",
        "HELD,2,2",
        "MIDDLE,3,3",
    ]


def _node_set(name: str, numbers: Array) -> list[str]:
    return [f"*NSET, NSET={name}", *(f"{number}," for number in numbers[numbers > 0])]

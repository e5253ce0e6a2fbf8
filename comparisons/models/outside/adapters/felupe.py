"""FElupe: a clamped strip of biquadratic elements, a dead force at its end, and an item for the contact of a pin with a line of nodes.

Poisson's ratio is zero, so that plane strain is plane stress. The contact is a penalty, closed where the foot of the pin lies on the
line.
"""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np

from comparisons.models.outside.adapters.exchange import Histories, StoppedError, Table, named, refined, serve
from comparisons.models.outside.adapters.strip import Foot, axes, foot, foot_on, one_strip, way

STEPS = 50
"""Least number of load steps."""
PENALTY = 1e7
"""Contact stiffness, over EI/L^3."""


def refusal(scene: Table) -> str | None:
    """Return why the adapter cannot state the scene."""
    loads = any(load["moment"] or load["end"] != "end" for load in scene["loads"])
    return one_strip(scene) or ("the adapter has dead forces at the free end, no moments" if loads else None)


def states(scene: Table, histories: Histories) -> Iterator[float]:
    """Solve by Newton's method with load steps and yield every load parameter."""
    import felupe as fem

    beam = scene["beams"][0]
    length, half, frame = beam["length"], beam["height"] / 2.0, axes(beam)
    mesh = fem.Rectangle(a=(0.0, -half), b=(length, half), n=(beam["elements"] + 1, 2))
    mesh = fem.mesh.convert(mesh, order=2, calc_points=True, calc_midfaces=True)
    field = fem.FieldContainer([fem.FieldPlaneStrain(fem.RegionBiQuadraticQuad(mesh), dim=2)])
    law = fem.LinearElasticLargeStrain(E=beam["youngs_modulus"] * beam["width"], nu=0.0)
    solid, (x, y) = fem.SolidBody(law, field), mesh.points.T
    edge, axis = x < 1e-9 * length, np.abs(y) < 1e-9 * half
    held = fem.Boundary(field[0], mask=edge, skip=(0, 1)), fem.Boundary(field[0], mask=edge & axis)
    dof0, dof1 = fem.dof.partition(field, dict(enumerate(held)))
    options = {"dof0": dof0, "dof1": dof1, "verbose": False, "maxiter": 50}
    end = np.flatnonzero(x > (1.0 - 1e-9) * length)
    load = fem.PointLoad(field, end)
    full = sum((frame @ one["force"] for one in scene["loads"]), np.zeros(2))
    pins = [_Contact(field, scene, item) for item in scene["contacts"]]
    for steps in refined(scene, STEPS):
        for t in steps:
            load.update(np.where(axis[end], 4.0, 1.0)[:, None] / 6.0 * t * full)
            closed = [pin for pin in pins if pin.pressed(t)]
            try:
                fem.newtonraphson(items=[solid, load, *closed], **options)
                if len(closed) > len(closed := [pin for pin in closed if pin.pressed(t)]):
                    fem.newtonraphson(items=[solid, load, *closed], **options)
            except (ValueError, np.linalg.LinAlgError) as error:
                raise StoppedError(f"{error} at load parameter {t:.6g}") from error
        place = mesh.points + field[0].values
        force = np.asarray(solid.assemble.vector(field).toarray()).reshape(-1, 2)[edge]
        moment = np.sum(place[edge, 0] * force[:, 1] - place[edge, 1] * force[:, 0])
        own = np.flatnonzero(axis)[np.argsort(x[axis])]
        histories.axis(beam["name"], x[own].tolist(), beam["start"] + place[own] @ frame)
        histories.support(scene["supports"][0]["node"], force.sum(axis=0) @ frame, float(moment))
        for pin in pins:
            pin.add(histories, t, frame)
        yield steps[-1]


class _Contact:
    """Item of FElupe: a penalty between a pin and a line of nodes along the strip."""

    def __init__(self, field: Any, scene: Table, item: Table) -> None:
        beam, pin = scene["beams"][0], named(scene, "pins", item["node"])
        self.side, self.radius = 1.0 if item["side"] == "left" else -1.0, pin["radius"]
        self.pair = item["pair"]
        self.field, self.points = field, field.region.mesh.points
        level = self.side * (item["offset"] - self.radius)
        line = np.flatnonzero(np.abs(self.points[:, 1] - level) < 1e-9 * beam["height"])
        self.line = line[np.argsort(self.points[line, 0])]
        self.stiffness, self.way = PENALTY * beam["EI"] / beam["length"] ** 3, way(beam, pin)
        self.results = SimpleNamespace(force=None, update_statevars=lambda: None)
        self.assemble = SimpleNamespace(vector=self.vector, matrix=self.matrix, multiplier=None)

    def gap(self, at: Foot) -> float:
        return float(self.side * at.normal @ at.away - self.radius)

    def now(self) -> tuple[Foot, Any]:
        """Return the foot of the pin and the places of its three nodes."""
        place = (self.points + self.field[0].values)[self.line]
        at = foot(place, self.pin)
        return at, place[at.first : at.first + 3]

    def pressed(self, t: float) -> Foot | None:
        """Move the pin to a load parameter; return its foot if this lies on the line and the pin is beyond the line."""
        self.pin = np.array([np.interp(t, self.way[0], self.way[1][:, k]) for k in (0, 1)])
        at, _ = self.now()
        return at if abs(at.xi) <= 1.0 + 1e-9 and self.gap(at) < 0.0 else None

    def add(self, histories: Histories, t: float, frame: Any) -> None:
        if (at := self.pressed(t)) is None:
            histories.open(self.pair)
            return
        force = self.stiffness * self.gap(at) * self.side * at.normal @ frame
        arc = at.shape @ self.points[self.line[at.first : at.first + 3], 0]
        histories.contact(self.pair, force, float(arc), self.gap(at))

    def residual(self, nodes: Any) -> Any:
        at = foot_on(nodes, self.pin)
        return -self.stiffness * self.gap(at) * self.side * np.outer(at.shape, at.normal).ravel()

    def sparse(self, values: Any, first: int, columns: int) -> Any:
        """Return values of three nodes as a sparse matrix of all unknowns."""
        from scipy.sparse import lil_matrix

        rows = (2 * self.line[first : first + 3, None] + [0, 1]).ravel()
        found = lil_matrix((self.points.size, columns))
        found[np.ix_(rows, rows if columns > 1 else np.array([0]))] = values.reshape(rows.size, -1)
        return found.tocsr()

    def vector(self, field: Any = None, **_: Any) -> Any:
        self.field = self.field if field is None else field
        at, nodes = self.now()
        self.results.force = self.sparse(self.residual(nodes), at.first, 1)
        return self.results.force

    def matrix(self, *_: Any, **__: Any) -> Any:
        """Return the tangent by central differences."""
        at, nodes = self.now()
        steps = 1e-6 * np.ptp(nodes) * np.eye(6).reshape(6, 3, 2)
        slopes = [self.residual(nodes + step) - self.residual(nodes - step) for step in steps]
        return self.sparse(np.array(slopes).T / (2.0 * steps.max()), at.first, self.points.size)


if __name__ == "__main__":
    serve(refusal, states)

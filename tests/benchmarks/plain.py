"""KS as a plain NumPy program would solve it: corotational elements that shear, the pin on a chord, its force a multiplier."""

import numpy as np

ELEMENTS = 50


def residual_and_tangent(scene, x, force, pin, at):
    """Residual and tangent over the nodes ``x (n, 3)`` and the force of the pin on the chord of element `at`."""
    beam = scene.beams[0]
    h, EI = beam.length / ELEMENTS, beam.EI
    d = x[1:, :2] - x[:-1, :2]
    length, chord = np.hypot(*d.T), np.arctan2(d[:, 1], d[:, 0])
    (c, s), zero = d.T / length, np.zeros(ELEMENTS)
    along, across = np.stack([-c, -s, zero, c, s, zero], -1), np.stack([s, -c, zero, -s, c, zero], -1)
    turns = np.stack([x[:-1, 2] - chord, x[1:, 2] - chord], -1)
    to_turns = np.eye(6)[[2, 5]] - (across / length[:, None])[:, None]
    phi = 12.0 * EI / beam.GA / h**2
    bending = EI / h / (1.0 + phi) * np.array([[4.0 + phi, 2.0 - phi], [2.0 - phi, 4.0 + phi]])
    N, M = beam.EA * (length - h) / h, turns @ bending
    f = N[:, None] * along + np.einsum("ei,eij->ej", M, to_turns)
    pairs = np.einsum("ei,ej->eij", along, across)
    K = beam.EA / h * np.einsum("ei,ej->eij", along, along) + np.einsum(
        "eij,ik,ekl->ejl", to_turns, bending, to_turns
    )
    K += (N / length)[:, None, None] * np.einsum("ei,ej->eij", across, across)
    K += (M.sum(1) / length**2)[:, None, None] * (pairs + pairs.transpose(0, 2, 1))
    size = x.size
    F, whole = np.zeros(size + 1), np.zeros((size + 1, size + 1))
    dofs = 3 * np.arange(ELEMENTS)[:, None] + np.arange(6)
    np.add.at(F, dofs, f)
    np.add.at(whole, (dofs[:, :, None], dofs[:, None]), K)
    # the distance g of the pin from the chord, its derivatives by the ends of the element
    t, own_length, r = d[at] / length[at], length[at], pin - x[at, :2]
    n = np.array([-t[1], t[0]])
    F[size], z = n @ r, t @ r / own_length
    to_d = np.concatenate([-np.eye(2), np.eye(2)], 1)
    dz = (np.concatenate([-t, 0 * t]) + (F[size] / own_length * n - z * t) @ to_d) / own_length
    dn = -np.outer(t, n @ to_d) / own_length
    bent = np.concatenate([np.outer(n, dz) - (1.0 - z) * dn, -np.outer(n, dz) - z * dn])
    slope, own = np.concatenate([-(1.0 - z) * n, -z * n]), np.array([0, 1, 3, 4]) + 3 * at
    F[own] += force * slope
    whole[np.ix_(own, own)] += force * bent
    whole[own, size] = whole[size, own] = slope
    return F, whole, z


def solved(scene):
    """Contact force at every load parameter."""
    beam, pin = scene.beams[0], scene.pins[0]
    x, force, at, found = np.zeros((ELEMENTS + 1, 3)), 0.0, ELEMENTS - 1, []
    x[:, 0] = np.linspace(0.0, beam.length, ELEMENTS + 1)
    for t in scene.times:
        place = np.array(pin.start) + t * np.array(pin.displacement)
        for _ in range(60):
            F, K, z = residual_and_tangent(scene, x, force, place, at)
            if np.abs(F[3:]).max() < 1e-9 and (0.0 <= z <= 1.0 or (at == ELEMENTS - 1 and z > 1.0)):
                break
            step = np.linalg.solve(K[3:, 3:], -F[3:])
            x.flat[3:] += step[:-1]
            force += step[-1]
            at = int(np.clip(at + np.floor(z), 0, ELEMENTS - 1))
        else:
            raise RuntimeError(f"no equilibrium at {t}")
        found.append(abs(force))
    return np.array(found)

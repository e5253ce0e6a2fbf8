"""Equilibria drawn at random, stable or not, with contacts that may push or pull: Newton's method from long steps, not a path."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

import tsm
from tests.tsm.reissner_hessian import Contact, Segment
from tsm.contact_set import initial_state
from tsm.model import Model
from tsm.newton import Equilibrium, Newton
from tsm.rods.shape import RodShape, plain_shape
from tsm.settings import Settings
from tsm.status import Status


def drawn_section(rng: np.random.Generator) -> tsm.Section:
    """EI between .5 and 2, slender or not."""
    EI = float(rng.uniform(0.5, 2))
    EA = EI * 10 ** float(rng.uniform(2.5, 6))
    return tsm.Section(EA=EA, GA=EA * float(rng.uniform(0.15, 1)), EI=EI)


def drawn_structure(rng: np.random.Generator, element: str, *, offset: bool = False) -> tsm.Structure:
    """A column, a frame, or two beams of which one leans on the other; with pins, loads and moved supports."""
    kind = rng.choice(["column", "frame", "leaning"], p=[0.6, 0.2, 0.2])
    corners = [(0.0, 0.0), (1.0, 0.0)]
    if kind == "frame":
        corners += [(1.0 + float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-1, -0.5)))]
        if rng.random() < 0.5:
            corners.insert(0, (float(rng.uniform(-0.5, 0.5)), float(rng.uniform(-1, -0.5))))
    section, finest = drawn_section(rng), 3 if element == "exact" else 12
    beams = [
        tsm.Beam(
            name=f"b{n}",
            start=a,
            end=b,
            section=section if rng.random() < 0.7 else drawn_section(rng),
            elements=int(rng.integers(1 if element == "exact" else 4, finest + 1)),
            element=element,
        )
        for n, (a, b) in enumerate(pairwise(corners))
    ]
    rotation = [0.0, None][int(rng.random() < 0.3)] if kind == "frame" else 0.0
    supports = [tsm.Support(beam="b0", end="start", rotation=rotation)]
    if kind == "frame":
        supports.append(tsm.Support(beam=beams[-1].name, end="end", rotation=[0.0, None][rng.integers(2)]))
    elif rng.random() < 0.5:
        free = {"ux": None, "rotation": [0.0, None][rng.integers(2)]}
        supports.append(
            tsm.Support(
                beam="b0",
                end="end",
                uy=float(rng.choice([0.0, rng.uniform(-0.3, 0.3)], p=[0.7, 0.3])),
                **free,
            )
        )
    pins, contacts = [], []
    depth = float(rng.uniform(0.001, 0.05)) if offset else 0.0
    for n in range(int(rng.choice([0, 0, 1, 1, 2, 3]))):
        place, side = float(rng.uniform(0.15, 0.95)), str(rng.choice(["left", "right"]))
        start = (place, -depth if side == "right" else depth)
        by = rng.uniform(-0.3, 0.3, 2) * rng.choice([1.0, 0.01])
        pins.append(tsm.Pin(name=f"p{n}", path=(start, (start[0] + 0.3 * by[0], start[1] + by[1]))))
        on = "b0" if corners[0] == (0.0, 0.0) else "b1"
        contacts.append(tsm.ContactPair(node=f"p{n}", beam=on, side=side, offset=depth))
    if kind == "leaning":
        place, up = float(rng.uniform(0.3, 0.9)), float(rng.uniform(0.5, 1))
        lean = float(rng.uniform(-0.3, 0.3))
        other = replace(beams[0], name="b9", start=(place + lean, up), end=(place, depth))
        beams.append(replace(other, section=drawn_section(rng)))
        supports.append(
            tsm.Support(
                beam="b9",
                end="start",
                uy=float(rng.uniform(-0.2, 0.1)),
                rotation=[0.0, None][rng.integers(2)],
            )
        )
        contacts.append(tsm.ContactPair(node="b9.end", beam="b0", side="left", offset=depth))
    strength = section.EI * 10 ** float(rng.uniform(0, 2.3))
    crooked = float(rng.integers(2))
    direction = math.pi + crooked * float(rng.normal(0, 0.5))
    end = ("b0" if kind == "leaning" else beams[-1].name), "end"
    if kind == "frame":
        end = beams[-1].name, "start"
    force = (strength * math.cos(direction), strength * math.sin(direction))
    if kind == "frame":
        force = (force[1], -abs(force[0]))
    loads = [
        tsm.Load(beam=end[0], end=end[1], force=force, moment=crooked * float(rng.normal(0, section.EI)))
    ]
    return tsm.Structure(
        beams=tuple(beams),
        supports=tuple(supports),
        pins=tuple(pins),
        contacts=tuple(contacts),
        loads=tuple(loads),
    )


def drawn_equilibrium(
    rng: np.random.Generator, structure: tsm.Structure
) -> tuple[Newton, Equilibrium] | None:
    """An equilibrium of it, from a few long steps; None if they fail, or a contact leaves its beam or carries no force."""
    model = Model(structure)
    newton = Newton(model, Settings(max_iterations=40))
    state = initial_state(model)
    stray = rng.normal(0, float(rng.choice([0.0, 0.3, 1.0])), model.dof_count)
    stray[model.fixed] = 0.0
    for t in np.linspace(0, 1, int(rng.integers(2, 12)))[1:]:
        start = newton.prescribed(state, float(t))
        if t == 1:
            start = replace(start, q=start.q + stray)
        with np.errstate(all="ignore"):
            found = newton.solve(start)
        if found.status is not Status.CONVERGED:
            return None
        state = found.state
    for touch in state.touches:
        if touch is None:
            continue
        if not 0.003 < touch.xi < 0.997 or math.hypot(*touch.force) < 1e-6 * model.force_scale:
            return None
    return newton, found


def segments_of(newton: Newton, found: Equilibrium) -> tuple[list[Segment], set]:
    """Rods between loads of a model of exact elements, and the names that are prescribed."""
    model, state = newton.model, found.state
    rods = model.rods
    assert rods is not None
    assert state.profile is not None
    shape = plain_shape(rods, state, rods.enter(state))
    cuts, segments = dict(state.profile.cuts), []
    sections = [beam.beam.section for beam in model.beams.values() for _ in range(beam.beam.elements)]
    for e, nodes in enumerate(model.element_nodes.tolist()):
        pairs = cuts.get(e, ())
        contacts = [None]
        for k in pairs:
            pair, touch = model.pairs[k], state.touches[k]
            touching = pair.node if pair.node >= 0 else None
            contacts.append(Contact(f"arc {k}", touching, touch.force, pair.reach))
        contacts.append(None)
        names = [nodes[0], *(("contact", k) for k in pairs), nodes[1]]
        for n, s in enumerate(range(shape.first[e], shape.last[e] + 1)):
            segments.append(
                Segment(
                    stiffness=(sections[e].EA, sections[e].GA, sections[e].EI),
                    ends=(names[n], names[n + 1]),
                    contacts=(contacts[n], contacts[n + 1]),
                    length=float(shape.length[s]),
                    shape=partial(_within, shape, s),
                    force=tuple(shape.force[:, s].tolist()),
                )
            )
    fixed = {
        ("turn", dof // 3) if dof % 3 == 2 else ("place", dof // 3, dof % 3) for dof in model.fixed.tolist()
    }
    return segments, fixed


def _within(shape: RodShape, segment: int, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    at = shape.within(segment, part)
    return at.position, at.angle


def tangent_index(newton: Newton, found: Equilibrium, rng: np.random.Generator) -> int:
    """Index of a model without exact elements, from the dense Hessian in displacements and arc positions alone.

    The contacts' forces are eliminated by their flexibilities, a little increased; the tangent is held against its residual.
    """
    model, state, assembler = newton.model, found.state, newton.assembler
    L, F = model.length, model.force_scale
    whole = assembler.whole(assembler.linearise(state).tangent).toarray()
    own = [
        slot
        for pair, t in zip(model.pairs, state.touches, strict=True)
        if t
        for slot in range(pair.slot, pair.slot + 3)
    ]
    kept = [*range(model.equations), *(model.equations + np.array(own, dtype=int))]
    K = whole[np.ix_(kept, kept)]
    assert np.abs(K - K.T).max() <= 1e-9 * np.abs(K).max()
    direction = rng.standard_normal(model.unknowns) * 1e-6
    ahead, back = (newton.update(state, sign * direction, found.system) for sign in (1, -1))
    along = (assembler.linearise(ahead).residual - assembler.linearise(back).residual) / 2
    found_along = whole @ direction
    assert np.abs((along - found_along)[kept]).max() <= 1e-5 * np.abs(found_along).max()
    units = model.units[kept]
    plain = (K + K.T) / 2 * np.outer(units, units) / (F * L)
    force = np.concatenate([np.zeros(model.equations), np.tile([1, 1, 0], len(own) // 3)]).astype(bool)
    A, G, C = plain[np.ix_(~force, ~force)], plain[np.ix_(force, ~force)], -plain[np.ix_(force, force)]
    soft = C + 1e-8 * np.eye(len(C))
    if len(C) and np.linalg.eigvalsh(soft)[0] <= 0:
        return int((np.linalg.eigvalsh(plain) < 0).sum()) - len(C)
    reduced = A + G.T @ np.linalg.solve(soft, G)
    return int((np.linalg.eigvalsh((reduced + reduced.T) / 2) < 0).sum())

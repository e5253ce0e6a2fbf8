"""Curvatures and constraints of a state: those of closed contacts, ties, dead moments and anchors."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.arrays import Array, Floats
from fem_reference.end_section import COLUMNS, ROTATION
from fem_reference.friction import slip_gradient
from fem_reference.model import Model
from fem_reference.state import State, section_actions


@dataclass(frozen=True, kw_only=True, eq=False)
class Border:
    """Curvatures and constraints over the columns U: 3 or 4 of each closed contact, then 4 of each end section."""

    blocks: tuple[Floats, ...]  # diagonal blocks of A, one for each closed contact and end section
    # directions of the constraints' forces ``U N``, ``(k, c)``: gaps of closed contacts, friction, then
    # ties
    N: Floats
    M: Floats  # gradients of the constraints ``U M``, ``(k, c)``. They differ from N for friction only
    # flexibilities of the constraints ``(c,)`` [m/N]; for a contact that slips, the factor 1 of its
    # tangential force; for a tie, its own
    C: Floats
    # factors ``(c, c)`` of the forces of other constraints: ``-sigma mu`` of a normal force where the
    # contact slips
    coupling: Floats
    removed: Array  # whether augmented Lagrangian steps remove the flexibility, ``(c,)``

    @cached_property
    def A(self) -> Floats:
        """Curvatures ``(k, k)``: the Hessian without constraints is ``K - U A U^T``."""
        return block_diagonal(self.blocks)

    def of_contacts(self, chosen: list[bool]) -> "Border":
        """Border with the contacts ``chosen`` among the closed ones, and all ties."""
        free = [True] * (len(self.C) - len(chosen))
        kept = np.array([*chosen, *free], dtype=bool)
        blocks = tuple(
            block if number >= len(chosen) or chosen[number] else np.zeros_like(block)
            for number, block in enumerate(self.blocks)
        )
        return Border(
            blocks=blocks,
            N=self.N[:, kept],
            M=self.M[:, kept],
            C=self.C[kept],
            coupling=self.coupling[np.ix_(kept, kept)],
            removed=self.removed[kept],
        )


def block_diagonal(blocks: Sequence[Floats]) -> Floats:
    """Matrix with square blocks on its diagonal."""
    ends = np.cumsum([0, *(len(block) for block in blocks)])
    matrix = np.zeros((ends[-1], ends[-1]))
    for block, first, last in zip(blocks, ends[:-1], ends[1:], strict=True):
        matrix[first:last, first:last] = block
    return matrix


def build_border(model: Model, state: State) -> Border:
    """Curvatures and constraints of the closed contacts, ties, dead moments and anchors of a state."""
    closed, ties = state.closed, model.ties
    rubbing = state.rubbing
    contacts = len(closed) + len(rubbing)
    first_columns = np.cumsum([0, *(touch.slopes.shape[1] for touch in closed)])
    moments = section_actions(model, state)[:, ROTATION]
    blocks = [touch.stiffness for touch in closed]
    blocks += [
        moment * pose.curvature + section.anchor_stiffness * np.eye(COLUMNS)
        for section, pose, moment in zip(model.sections, state.poses, moments, strict=True)
    ]
    N = np.zeros((first_columns[-1] + COLUMNS * len(model.sections), contacts + len(ties)))
    N[first_columns[:-1], np.arange(len(closed))] = 1.0
    for number, tie in enumerate(ties, contacts):
        for section, sign in ((tie.section, 1.0), (tie.other, -1.0)):
            if section is not None:
                first = first_columns[-1] + COLUMNS * section
                N[first : first + COLUMNS, number] += sign * state.poses[section].gradient[:, tie.component]
    M, coupling = N.copy(), np.zeros((N.shape[1], N.shape[1]))
    C = np.zeros(N.shape[1])
    C[: len(closed)] = [1 / touch.pair.penalty for touch in closed]
    C[contacts:] = [tie.flexibility for tie in ties]
    removed = np.zeros(N.shape[1], dtype=bool)
    removed[: len(closed)] = [touch.pair.contact.penetration is not None for touch in closed]
    for number, touch in enumerate(rubbing, len(closed)):
        contact = closed.index(touch)
        columns = slice(first_columns[contact], first_columns[contact + 1])
        assert touch.friction is not None, "a rubbing contact has friction"
        N[columns, number] = np.eye(len(touch.stiffness))[1]
        if touch.friction.direction:
            C[number] = 1.0
            coupling[number, contact] = -touch.friction.direction * touch.pair.contact.friction
        else:
            M[columns, number] = slip_gradient(touch.pair, touch.projection, touch.friction)
    return Border(blocks=tuple(blocks), N=N, M=M, C=C, coupling=coupling, removed=removed)

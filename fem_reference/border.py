"""Curvatures and constraints of a state: those of closed contacts, ties, dead moments and anchors."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from fem_reference.arrays import Array, Floats
from fem_reference.end_section import COLUMNS, ROTATION
from fem_reference.model import Model
from fem_reference.state import State, section_actions


@dataclass(frozen=True, kw_only=True, eq=False)
class Border:
    """Curvatures and constraints over the k columns U: three of each closed contact, then four of each end section.

    Parameters
    ----------
    blocks
        Diagonal blocks of A, one for each closed contact and end section.
    N
        Gradients of the constraints ``U N``, ``(k, c)``: gaps of closed contacts, then ties.
    C
        Flexibilities of the constraints ``(c,)`` [m/N].
    removed
        Whether augmented Lagrangian steps remove the flexibility, ``(c,)``.
    """

    blocks: tuple[Floats, ...]
    N: Floats
    C: Floats
    removed: Array

    @cached_property
    def A(self) -> Floats:
        """Curvatures ``(k, k)``: the Hessian without constraints is ``K - U A U^T``."""
        return np.asarray(block_diag(*self.blocks)) if self.blocks else np.zeros((0, 0))

    def of_contacts(self, chosen: list[bool]) -> "Border":
        """Border with the contacts ``chosen`` among the closed ones, and all ties."""
        free = [True] * (len(self.C) - len(chosen))
        kept = np.array([*chosen, *free], dtype=bool)
        blocks = tuple(
            block if number >= len(chosen) or chosen[number] else np.zeros_like(block)
            for number, block in enumerate(self.blocks)
        )
        return Border(blocks=blocks, N=self.N[:, kept], C=self.C[kept], removed=self.removed[kept])


def build_border(model: Model, state: State) -> Border:
    """Curvatures and constraints of the closed contacts, ties, dead moments and anchors of a state."""
    closed, ties = state.closed, model.ties
    contacts = len(closed)
    moments = section_actions(model, state)[:, ROTATION]
    blocks = [touch.force * touch.curvature for touch in closed]
    blocks += [
        moment * pose.curvature + section.anchor_stiffness * np.eye(COLUMNS)
        for section, pose, moment in zip(model.sections, state.poses, moments, strict=True)
    ]
    N = np.zeros((3 * contacts + COLUMNS * len(model.sections), contacts + len(ties)))
    N[3 * np.arange(contacts), np.arange(contacts)] = 1.0
    for number, tie in enumerate(ties, contacts):
        for section, sign in ((tie.section, 1.0), (tie.other, -1.0)):
            if section is not None:
                first = 3 * contacts + COLUMNS * section
                N[first : first + COLUMNS, number] += sign * state.poses[section].gradient[:, tie.component]
    return Border(
        blocks=tuple(blocks),
        N=N,
        C=np.array([*(1 / touch.pair.penalty for touch in closed), *(0.0 for _ in ties)]),
        removed=np.array(
            [*(touch.pair.contact.penetration is not None for touch in closed), *(False for _ in ties)],
            dtype=bool,
        ),
    )

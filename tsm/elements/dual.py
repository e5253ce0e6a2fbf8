"""Numbers with their derivatives, so that a residual states its exact tangent."""

from __future__ import annotations

from typing import Any

import numpy as np

from tsm.elements.properties import Array


class Dual:
    """A value and its gradient over a list of variables."""

    __slots__ = ("gradient", "value")

    def __init__(self, value: Any, gradient: Array) -> None:
        self.value = value
        self.gradient = gradient

    def __add__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.gradient + other.gradient)
        return Dual(self.value + other, self.gradient)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.gradient)

    def __sub__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value - other.value, self.gradient - other.gradient)
        return Dual(self.value - other, self.gradient)

    def __rsub__(self, other: Any) -> Dual:
        return Dual(other - self.value, -self.gradient)

    def __mul__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value * other.value, self.value * other.gradient + other.value * self.gradient)
        return Dual(self.value * other, self.gradient * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            value = self.value / other.value
            return Dual(value, (self.gradient - value * other.gradient) / other.value)
        return Dual(self.value / other, self.gradient / other)

    def sqrt(self) -> Dual:
        """Square root."""
        root = np.sqrt(self.value)
        return Dual(root, self.gradient / (2 * root))

    def cos(self) -> Dual:
        """Cosine."""
        return Dual(np.cos(self.value), -np.sin(self.value) * self.gradient)

    def sin(self) -> Dual:
        """Sine."""
        return Dual(np.sin(self.value), np.cos(self.value) * self.gradient)

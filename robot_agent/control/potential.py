"""Olfati-Saber's potential, which chapter 6 uses for the formation (section 6.2.1, [106]).

    ||z||_s = (sqrt(1 + eps |z|^2) - 1) / eps,                    n_ij = (x_j - x_i) / sqrt(1 + eps |x_j - x_i|^2)
    s_1(z) = z / sqrt(1 + z^2),      phi(z) = ((a + b) s_1(z + c) + (a - b)) / 2,      c = |a - b| / sqrt(4 a b)
    phi_a(z) = rho_h(z / ||r||_s) phi(z - ||d||_s),     rho_h: 1 up to h, then half a cosine down to 0 at 1
    J = 1/2 sum_i sum_{j != i} int_{||d||_s}^{||x_j - x_i||_s} phi_a,       dJ/dx_i = -sum_j phi_a(||x_j - x_i||_s) n_ij

Departs from the thesis: J is flat beyond r, so that its third property, J <= c sum ||dJ/dx_i||^2, holds within r only.
"""

from __future__ import annotations

from math import cos, pi, sqrt


def sigma_norm(distance: float, epsilon: float) -> float:
    """||z||_s of a vector of length `distance`, which is smooth at 0."""
    return (sqrt(1.0 + epsilon * distance * distance) - 1.0) / epsilon


class Potential:
    """The potential with rest distance `d` and range `r`, m."""

    __slots__ = ("_a", "_b", "_c", "_d", "_epsilon", "_h", "_r", "stiffness")

    def __init__(self, d: float, r: float, a: float, b: float, epsilon: float, h: float) -> None:
        self._a, self._b, self._epsilon, self._h = a, b, epsilon, h
        self._c = abs(a - b) / sqrt(4.0 * a * b)
        self._d = sigma_norm(d, epsilon)
        self._r = sigma_norm(r, epsilon)
        # An upper bound, within r, on how fast one robot's pull changes with its place, 1/m:
        # |phi'| |z|^2 / (1 + eps |z|^2) + |phi| / sqrt(1 + eps |z|^2), with what the bump adds.
        bump = 0.5 * pi / ((1.0 - h) * self._r)
        strongest = max(a, b)
        self.stiffness = (0.5 * (a + b) + strongest * bump) * r * r / (1.0 + epsilon * r * r) + strongest

    def action(self, z: float, cut: bool = True) -> float:
        """phi_a(z): below 0 it pushes apart, above it draws together; `cut` False leaves rho_h out, for any range."""
        if z >= self._r and cut:
            return 0.0
        w = z - self._d + self._c
        phi = 0.5 * ((self._a + self._b) * w / sqrt(1.0 + w * w) + self._a - self._b)
        share = z / self._r
        if share <= self._h or not cut:
            return phi
        return 0.5 * (1.0 + cos(pi * (share - self._h) / (1.0 - self._h))) * phi

    def slope(self, x: float, y: float, other_x: float, other_y: float, cut: bool = True) -> tuple[float, float]:
        """The part of dJ/dx_i, for robot i at (x, y), that is due to one other."""
        dx, dy = other_x - x, other_y - y
        root = sqrt(1.0 + self._epsilon * (dx * dx + dy * dy))
        force = -self.action((root - 1.0) / self._epsilon, cut) / root
        return force * dx, force * dy

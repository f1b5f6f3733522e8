"""The finite-time tracking law of chapter 6: a real robot follows its virtual one.

Thesis (6.2): u_i = v_hat_i' - k (sig(v_i - v_hat_i)^(1/q) + k_1^(1/q) (x_i - x_hat_i))^(2q-1),  1/2 < q < 1, per axis.

As for sig(.)^a (see robot_agent.sig) the slope is infinite at rest. The implicit step solves for the error at the end of
the step: with w = k sig(s)^(2q-1), e_2' = e_2 - dt w and e_1' = e_1 + dt e_2',  s = sig(e_2')^(1/q) + k_1^(1/q) e_1'.
The left side rises and the right side falls with w: there is one solution.
"""

from __future__ import annotations

from robot_agent.sig import sig


def pull(e1: float, e2: float, k: float, k1: float, q: float, dt: float = 0.0) -> float:
    """w of u_i = v_hat_i' - w along one axis, m/s^2.

    Args:
        e1: x_i - x_hat_i, m.
        e2: v_i - v_hat_i, m/s.
        k, k1: gains; Proposition 10 asks for k1 > 1/3.
        q: exponent, 1/2 < q < 1.
        dt: length of the implicit step, s; 0 gives the printed law.
    """
    power, share, inverse = 2.0 * q - 1.0, k1 ** (1.0 / q), 1.0 / q
    s = sig(e2, inverse) + share * (e1 + dt * e2)
    if s == 0.0:
        return 0.0
    if s < 0.0:
        return -pull(-e1, -e2, k, k1, q, dt)
    most = k * float(s**power)
    if dt == 0.0:
        return most
    return _solve(e1, e2, k, share, inverse, 1.0 / power, dt, most)


def _solve(e1: float, e2: float, k: float, share: float, inverse: float, steep: float, dt: float, most: float) -> float:
    """The w in [0, most] with sig(e2 - dt w)^inverse + share (e1 + dt (e2 - dt w)) = (w/k)^steep, by Newton's method
    with a bracket."""
    low, high = 0.0, most
    w = min(most, max(0.0, e2 / dt)) or 0.5 * most  # where the velocity error would end
    for _ in range(60):
        end = e2 - dt * w
        size = abs(end)
        excess = sig(end, inverse) + share * (e1 + dt * end) - (w / k) ** steep
        if excess > 0.0:
            low = w
        else:
            high = w
        fall = dt * (inverse * size ** (inverse - 1.0) + share * dt) + steep / k * (w / k) ** (steep - 1.0)
        step = excess / fall
        w += step
        if abs(step) <= 1e-10 * most:
            break
        if not low < w < high:
            w = 0.5 * (low + high)
    return w

"""How a filament grows with its age, in closed form: no step, so no error of a step."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def radius_at(growth: str, initial: float, rate: float, age: Array) -> Array:
    """Radius of filaments by their age.

    Thesis (1.4) prints dR/dt = 3/2 gamma R(0)^(1/3). That is a misprint of Farrell's first model, which has R instead
    of R(0); only then does the 3/2 make the solution simple.

        farrell1   dR/dt = 3/2 gamma R^(1/3)      R^(2/3) = R(0)^(2/3) + gamma t
        printed    dR/dt = 3/2 gamma R(0)^(1/3)   R = R(0) + 3/2 gamma R(0)^(1/3) t
        farrell2   dR/dt = gamma / (2 R)          R^2 = R(0)^2 + gamma t

    Args:
        growth: one of the three names.
        initial: R(0), m.
        rate: gamma; m^(2/3)/s, for farrell2 m^2/s.
        age: t, s, any shape, >= 0.
    Returns:
        R, m, of the shape of `age`; never decreasing with it.
    """
    r0, gamma, t = initial, rate, age
    if growth == "farrell1":
        s = r0 ** (2.0 / 3.0) + gamma * t
        radius: Array = s * np.sqrt(s)  # s^(3/2), a third of the cost
    elif growth == "printed":
        radius = r0 + 1.5 * gamma * r0 ** (1.0 / 3.0) * t
    elif growth == "farrell2":
        radius = np.sqrt(r0 * r0 + gamma * t)
    else:
        raise ValueError(f"growth {growth!r} is none of farrell1, printed, farrell2")
    return radius

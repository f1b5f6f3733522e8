"""What the robots sense of the truth: noise on the exact values.

Rules: noise is addressed (seed, "sensor", robot, tick, which sensor), so that one sensor's noise changes no other's
draws; a sensor without noise draws nothing and hands its exact value on, to the bit.
"""

from __future__ import annotations

import msgspec

from protocol.messages import Reading
from protocol.randomness import rng_for
from protocol.scenario.sections import Sensors


def noisy(sensors: Sensors) -> bool:
    """Whether any sensor has noise."""
    s = sensors
    return bool(s.wind_noise or s.position_noise or s.heading_noise or s.concentration_noise)


def observe(exact: Reading, sensors: Sensors, seed: int) -> Reading:
    """`exact` as the robot's sensors report it; the speeds come from the wheels and are exact."""
    s, i, k = sensors, exact.robot, exact.tick
    if not noisy(s):
        return exact
    wind_x, wind_y = noisy_pair(exact.wind_x, exact.wind_y, s.wind_noise, seed, i, k, "wind")
    x, y = noisy_pair(exact.x, exact.y, s.position_noise, seed, i, k, "position")
    return msgspec.structs.replace(
        exact,
        x=x,
        y=y,
        theta=noisy_heading(exact.theta, s.heading_noise, seed, i, k),
        wind_x=wind_x,
        wind_y=wind_y,
        concentration=noisy_concentration(exact.concentration, s.concentration_noise, seed, i, k),
    )


def noisy_pair(
    x: float, y: float, deviation: float, seed: int, robot: int, tick: int, sensor: str
) -> tuple[float, float]:
    """A vector with independent normal noise of standard deviation `deviation` on each axis."""
    if deviation == 0.0:
        return x, y
    draws = rng_for(seed, "sensor", robot, tick, sensor)
    return x + deviation * draws.normal(), y + deviation * draws.normal()


def noisy_heading(theta: float, deviation: float, seed: int, robot: int, tick: int) -> float:
    """Heading with normal noise of standard deviation `deviation`, rad."""
    if deviation == 0.0:
        return theta
    return theta + deviation * rng_for(seed, "sensor", robot, tick, "heading").normal()


def noisy_concentration(ppt: float, deviation: float, seed: int, robot: int, tick: int) -> float:
    """Concentration times 1 + deviation N(0, 1), never negative; clean air stays clean."""
    if deviation == 0.0:
        return ppt
    return max(0.0, ppt * (1.0 + deviation * rng_for(seed, "sensor", robot, tick, "concentration").normal()))

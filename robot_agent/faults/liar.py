"""A lie: what a robot tells its neighbours instead of what it believes, in its own name.

Rules: pure; noise is drawn by ("liar", number of the fault, robot, tick).
"""

from __future__ import annotations

import msgspec

from protocol.messages import Reading, Shared
from protocol.randomness import rng_for
from protocol.scenario.faults import Liar

PLACES = {"fusion": ("fusion_x", "fusion_y"), "position": ("x", "y"), "decision": ("h_x", "h_y")}


def told(state: Shared, reading: Reading, fault: Liar, number: int, seed: int) -> Shared:
    """What is told instead of `state`."""
    dx, dy = fault.offset
    if fault.noise:
        draws = rng_for(seed, "liar", number, state.robot, state.tick)
        dx, dy = dx + fault.noise * draws.normal(), dy + fault.noise * draws.normal()
    if fault.lies == "detection":
        first = state.first_detected_at if state.first_detected_at >= 0.0 else reading.t
        return msgspec.structs.replace(
            state,
            first_detected_at=first,
            detected_at=reading.t,
            best_concentration=fault.ppt,
            best_x=state.x + dx,
            best_y=state.y + dy,
            best_at=reading.t,
        )
    if fault.lies == "fusion" and state.first_detected_at >= 0.0:
        # Its word, too, and always the latest, whether it has measured or not.
        x_hat, y_hat, _ = state.word or (state.fusion_x, state.fusion_y, 0.0)
        state = msgspec.structs.replace(state, word=(x_hat + dx, y_hat + dy, reading.t))
    x, y = PLACES[fault.lies]
    return msgspec.structs.replace(state, **{x: getattr(state, x) + dx, y: getattr(state, y) + dy})

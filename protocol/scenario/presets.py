"""Named sets of scenario values: the two readings of the thesis, and the nine cases of Table 4.6.

`corrected` is what the tables' defaults say. `literal` selects every printed form; each line of it is a line of
docs/departures.md.
"""

from __future__ import annotations

LITERAL: dict[str, object] = {
    "plume.growth": "printed",
    "sensors.wind_history": 0.0,
    "sensors.proximity": 0.0,
    "decision.gate": "printed",
    "decision.noise": "printed",
    "decision.process_noise": 0.0,
    "decision.recall": 0.0,
    "decision.lost": "keep",
    "fusion.input": "always",
    "fusion.step": "explicit",
    "planning.slope": "printed",
    "planning.slope_limit": 0.0,
    "planning.passed": "back",
    "planning.lost": "rest",
    "control.step": "explicit",
    "control.relay": False,
    "control.foresee": False,
    "control.remember": 0.0,
    "trust.check": False,
    "repulsion.form": "switch",
    "repulsion.gap": 0.0,
    "cfpso.repulsion": False,
    "dcs.repulsion": False,
    "dcs.order": "algorithm-2",
    "dcs.sectors": 5,
    "dcs.turn": 0.1,
    "dcs.orbits": "one",
    "ftmcs.reference": "all",
    "ftmcs.turn": 0.1,
    "ftmcs.centre": "decided",
    "ftmcs.circle_reach": "cut",
    "ftmcs.leash": 0.0,
    "ftmcs.limited": False,
    "ftmcs.repulsion": False,
    "pso.recall": 0.0,
    "pso.draws": "scalar",
    "cpso.draws": "scalar",
    "search.after": "stay",
}

PRESETS: dict[str, dict[str, object]] = {"corrected": {}, "literal": LITERAL}

# Table 4.6: (x_s, y_s, wind speed)
CASES: dict[int, tuple[float, float, float]] = {
    1: (10.0, 0.0, 1.0),
    2: (30.0, 10.0, 1.0),
    3: (30.0, -20.0, 1.0),
    4: (10.0, 0.0, 1.5),
    5: (30.0, 10.0, 1.5),
    6: (30.0, -20.0, 1.5),
    7: (10.0, 0.0, 0.8),
    8: (30.0, 10.0, 0.8),
    9: (30.0, -20.0, 0.8),
}


def case_values(case: int) -> dict[str, object]:
    """Scenario values of case `case` of Table 4.6."""
    x, y, speed = CASES[case]
    return {"source.x": x, "source.y": y, "wind.speed": speed}

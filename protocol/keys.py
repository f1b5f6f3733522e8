"""Key expressions: who says what to whom, all below `odour/{run}/`.

| key                    | from -> to                       | what                                         |
|------------------------|----------------------------------|----------------------------------------------|
| scenario (queryable)   | world -> robot, recorder         | the scenario as far as the asker may know it |
| robot/{i}/join (query) | robot -> world                   | my declared links are up                     |
| robot/{i}/reading      | world -> robot i                 | own odometry, wind, concentration, hears     |
| robot/{i}/shared       | robot i -> its neighbours        | consensus, fusion and group state            |
| robot/{i}/drive        | robot i -> world                 | wheel torques                                |
| robot/{i}/report       | robot i -> world                 | last word: final estimate, counters          |
| robot/{i}/resume       | world -> robot i                 | after a hang: the tick of its next reading   |
| robot/{i}/linked       | robot i -> world                 | who of its neighbours is linked to it now    |
| inject                 | world -> launcher                | a planned fault of a process is due          |
| stopped                | launcher -> world -> robots      | a robot's process stands still, or goes on   |
| robot/{i}/belief       | robot i -> recorder              | telemetry, best effort                       |
| robot/{i}/map          | robot i -> recorder              | its map of the source, best effort           |
| truth, field, events   | world -> recorder                | telemetry, best effort                       |
| progress, outcome      | world -> launcher                | how it goes, how it ended                    |
| halt                   | world -> robots, recorder        | the run is over                              |
| alive/{name}           | liveliness                       | crash and hang detection                     |
"""

from __future__ import annotations

import re

ROOT = "odour"
RUN_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")

READING, SHARED, DRIVE, REPORT, BELIEF, MAP = "reading", "shared", "drive", "report", "belief", "map"
RESUME, LINKED, INJECT, STOPPED = "resume", "linked", "inject", "stopped"
TRUTH, FIELD, EVENTS, PROGRESS, OUTCOME, HALT = "truth", "field", "events", "progress", "outcome", "halt"
SCENARIO, JOIN = "scenario", "join"

WORLD = "world"


def robot(i: int, leaf: str) -> str:
    """Key of robot `i`'s `leaf`, without the run's prefix."""
    return f"robot/{i}/{leaf}"


def robot_name(i: int) -> str:
    """Name of robot `i` as a member of the run (the last parts of its liveliness key)."""
    return f"robot/{i}"


def robot_of(name: str) -> int | None:
    """Robot number in a key or member name `robot/{i}[/...]`, or None."""
    parts = name.split("/")
    if len(parts) >= 2 and parts[0] == "robot" and parts[1].isdecimal() and len(parts[1]) <= 6:
        return int(parts[1])
    return None

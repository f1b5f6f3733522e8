"""All reproductions by name.

Rules: a module of this folder that holds reproductions names them in its `REPRODUCTIONS`; one line here. The modules
load slow libraries (matplotlib, cvxpy) only when a reproduction is made.
"""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from deploy.reproduce import beyond, chapter3, chapter4, chapter5, chapter6, finite_time
from deploy.reproduce.kinds import Reproduction
from protocol.errors import ScenarioError

FAMILIES: tuple[Sequence[Reproduction], ...] = (
    chapter3.REPRODUCTIONS,
    chapter4.REPRODUCTIONS,
    finite_time.REPRODUCTIONS,
    chapter6.REPRODUCTIONS,
    chapter5.REPRODUCTIONS,
    beyond.REPRODUCTIONS,
)

ALL: dict[str, Reproduction] = {each.name: each for family in FAMILIES for each in family}


def find(name: str) -> Reproduction:
    """The reproduction called `name`.

    Raises: ScenarioError that lists what there is.
    """
    if name in ALL:
        return ALL[name]
    near = get_close_matches(name, ALL, 1)
    guess = f' Did you mean "{near[0]}"?' if near else ""
    raise ScenarioError(f'there is no reproduction "{name}"; `odourswarm reproduce` lists them.{guess}')

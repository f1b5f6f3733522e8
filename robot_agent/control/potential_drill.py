"""The laws of chapter 6 as exercises (section 6.3), with the references of the scenario's table `drill`.

Thesis Tables 6.1, 6.2: (6.3) with v_c = `drill.velocity`, (6.5) about h^c = `drill.centre`; where every robot is given
the same reference (6.4) is (6.3), so that parallel motion is `FtmcsControl` itself.
"""

from __future__ import annotations

from robot_agent.control.ftmcs import FtmcsControl
from robot_agent.interfaces import Plan


class PotentialCircle(FtmcsControl):
    """(6.5) from the start on."""

    def _circles(self, plan: Plan) -> bool:
        return True

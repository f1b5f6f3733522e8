"""The algorithms by name: which decision, planner and controller make each.

A new algorithm is one new file for what is new in it, and one line here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from protocol.errors import ScenarioError
from protocol.scenario import RobotScenario, Scenario
from robot_agent.control.bracket import BracketControl
from robot_agent.control.ccs import CcsControl
from robot_agent.control.cfpso import CfpsoControl
from robot_agent.control.cfpso_ft import CfpsoFtControl
from robot_agent.control.consensus import ConsensusControl
from robot_agent.control.dcs import DcsControl
from robot_agent.control.dcs_ft import DcsFtControl
from robot_agent.control.direct import DirectControl
from robot_agent.control.drill import CircularDrill, ConsensusDrill, FormationDrill, ParallelDrill
from robot_agent.control.formation import formation_control
from robot_agent.control.ftmcs import FtmcsControl
from robot_agent.control.potential_drill import PotentialCircle
from robot_agent.control.simple import SimpleControl
from robot_agent.control.velocity import VelocityControl
from robot_agent.decision.cast import CastDecision
from robot_agent.decision.dda import DistributedDecision
from robot_agent.decision.lpso import LpsoDecision
from robot_agent.decision.none import Undecided
from robot_agent.decision.plume_map import PlumeMapDecision
from robot_agent.decision.ppso_im import PpsoImDecision
from robot_agent.decision.pso import cpso, cpso_centre, pso, pso_centre, wind_user
from robot_agent.decision.surge import SurgeDecision
from robot_agent.decision.walk import WalkDecision
from robot_agent.interfaces import Controller, Decision, Planner
from robot_agent.planning import discrete
from robot_agent.planning.bracket import BracketPlanner
from robot_agent.planning.centre import CentrePlanner
from robot_agent.planning.drill import CentreReference, NoReference, VelocityReference
from robot_agent.planning.head import surge_planner, walk_planner
from robot_agent.planning.spiral import SpiralPlanner
from robot_agent.planning.trace import TracePlanner
from robot_agent.planning.wind_use import wui_45, wuii


@dataclass(frozen=True, slots=True)
class Algorithm:
    """The parts of an algorithm, each made from a robot's scenario."""

    title: str
    decision: Callable[[RobotScenario], Decision]
    planner: Callable[[RobotScenario], Planner]
    controller: Callable[[RobotScenario], Controller]
    at_once: bool = False  # begins at the start, not at the first detection: no common search goes before it
    gains: str = ""  # table of the scenario whose beta and gamma ought to fit the graph by (5.2); "": none
    declares: bool = False  # its decision says how certain it is, so that the swarm can declare the source
    drill: bool = False  # an exercise with given references: it ignores the odour


def _drill(what: str, planner: Callable[[RobotScenario], Planner], law: Callable[[RobotScenario], Controller]) -> Algorithm:
    return Algorithm(f"exercise: {what}", Undecided, planner, law, at_once=True, gains="drill", drill=True)


ALGORITHMS: dict[str, Algorithm] = {
    "simple": Algorithm("DDA with (3.34)+(3.35), chapter 3", DistributedDecision, TracePlanner, SimpleControl),
    "cfpso": Algorithm("DDA with the PSO-based law (4.12)", DistributedDecision, TracePlanner, CfpsoControl),
    "dcs": Algorithm(
        "DDA with the consensus-based laws (5.5), (5.7)", DistributedDecision, TracePlanner, DcsControl, gains="dcs"
    ),
    "dcs-ft": Algorithm("DDA with (5.5), (5.7) made finite-time", DistributedDecision, TracePlanner, DcsFtControl),
    "cfpso-ft": Algorithm("DDA with (4.12) made finite-time", DistributedDecision, TracePlanner, CfpsoFtControl),
    "ftmcs": Algorithm("DDA with the potential-based laws (6.4), (6.5)", DistributedDecision, TracePlanner, FtmcsControl),
    "plume-map": Algorithm(
        "map of flooded events, line across the wind", PlumeMapDecision, BracketPlanner, BracketControl, declares=True
    ),
    "ppso-im": Algorithm("swarm centre or draw from all best places", PpsoImDecision, CentrePlanner, ConsensusControl),
    "lpso": Algorithm("source map with consensus (2.7)", LpsoDecision, CentrePlanner, ConsensusControl),
    "ccs-like": Algorithm("DDA with (2.7) of the 2 nearest in formation", DistributedDecision, TracePlanner, CcsControl),
    "surge": Algorithm("no decision: upwind in formation", SurgeDecision, surge_planner, formation_control, gains="dcs"),
    "surge-cast": Algorithm(
        "no decision: upwind, across when lost", CastDecision, surge_planner, formation_control, gains="dcs"
    ),
    "random-walk": Algorithm("no decision: straight random legs", WalkDecision, walk_planner, VelocityControl),
    "pso": Algorithm("PSO (2.1)-(2.3), driven directly", pso, discrete.pso, DirectControl),
    "cpso": Algorithm("charged PSO, driven directly", cpso, discrete.cpso, DirectControl),
    "pso-a": Algorithm("PSO centre (2.4) with consensus (2.7)", pso_centre, CentrePlanner, ConsensusControl),
    "cpso-a": Algorithm("charged PSO centre with consensus (2.7)", cpso_centre, CentrePlanner, ConsensusControl),
    "pso-s-c": Algorithm("pso-a along the spiral (2.8), (2.9)", pso_centre, SpiralPlanner, ConsensusControl),
    "cpso-s-c": Algorithm("cpso-a along the spiral (2.8), (2.9)", cpso_centre, SpiralPlanner, ConsensusControl),
    "wui-45": Algorithm("charged PSO that stops downwind", wind_user, wui_45, DirectControl),
    "wuii": Algorithm("charged PSO, slower downwind", wind_user, wuii, DirectControl),
    "consensus": _drill("to one place and velocity (5.1)", NoReference, ConsensusDrill),
    "formation": _drill("to a formation (5.3)", NoReference, FormationDrill),
    "parallel": _drill("a formation at a given velocity (5.4)", VelocityReference, ParallelDrill),
    "circular": _drill("circles about a given centre (5.6)", CentreReference, CircularDrill),
    "potential-parallel": Algorithm(
        "exercise: parallel motion (6.3)", Undecided, VelocityReference, FtmcsControl, at_once=True, drill=True
    ),
    "potential-circular": Algorithm(
        "exercise: circular motion (6.5)", Undecided, CentreReference, PotentialCircle, at_once=True, drill=True
    ),
}


def algorithm(name: str) -> Algorithm:
    """The algorithm called `name`."""
    try:
        return ALGORITHMS[name]
    except KeyError:
        raise ScenarioError(f"algorithm is {name!r}; it must be one of {', '.join(ALGORITHMS)}.") from None


def refuse_declaring(scenario: Scenario) -> None:
    """Refuse `declaration.stop` = "declared" for an algorithm that cannot say how certain it is.

    Raises: ScenarioError.
    """
    if scenario.declaration.stop != "declared" or algorithm(scenario.algorithm).declares:
        return
    able = ", ".join(name for name, parts in ALGORITHMS.items() if parts.declares) or "none so far"
    raise ScenarioError(
        f'declaration.stop is "declared", and algorithm "{scenario.algorithm}" cannot say how certain it is; '
        f'it must be one that can ({able}), or declaration.stop "reached".'
    )

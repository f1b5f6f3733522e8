"""The tables of the control laws and algorithms, one file a chapter or family."""

from protocol.scenario.laws.baselines import Surge, Walk
from protocol.scenario.laws.beyond import PlumeMap
from protocol.scenario.laws.chapter2 import Consensus, Cpso, Pso, Spiral
from protocol.scenario.laws.chapter3 import Repulsion, Simple
from protocol.scenario.laws.chapter4 import Cfpso
from protocol.scenario.laws.chapter5 import Dcs
from protocol.scenario.laws.chapter6 import Ftmcs
from protocol.scenario.laws.drill import Drill
from protocol.scenario.laws.finite_time import CfpsoFt, DcsFt
from protocol.scenario.laws.rivals import Ccs, Lpso, PpsoIm, Wui

__all__ = [
    "Ccs", "Cfpso", "CfpsoFt", "Consensus", "Cpso", "Dcs", "DcsFt", "Drill", "Ftmcs", "Lpso", "PlumeMap", "PpsoIm", "Pso",
    "Repulsion", "Simple", "Spiral", "Surge", "Walk", "Wui",
]  # fmt: skip

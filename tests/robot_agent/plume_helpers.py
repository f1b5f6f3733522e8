"""Records of plume-map for tests: air that came straight, in an arena of the usual size."""

from protocol.scenario.laws import PlumeMap
from protocol.scenario.sections import Arena
from robot_agent.plume.events import LAGS, pack

ARENA = Arena()
TABLE = PlumeMap()


def record(robot=0, hit=False, x=50.0, y=0.0, wind=(1.0, 0.0), D=0.1):
    return pack(robot, hit, x, y, D, [(lag * wind[0], lag * wind[1]) for lag in LAGS], ARENA)

"""What the group knows, as far as one robot has heard: detection, the best concentration, the search heading.

Rules: every item is a maximum (or minimum) over the robots that travels from neighbour to neighbour, so that it is the
same everywhere after as many ticks as the graph is wide, on any connected graph, directed ones too; hearing it twice or
late changes nothing; nobody is a centre.
"""

from __future__ import annotations

from protocol.messages import NEVER, Shared
from robot_agent.recall import Recall, Smell


class Group:
    """Max-consensus memory of one robot."""

    __slots__ = ("_own", "_recall", "best", "best_at", "best_x", "best_y", "detected_at", "first_detected_at", "heading",
                 "leg", "leg_by")  # fmt: skip

    def __init__(self, recall: float = 0.0) -> None:
        """`recall`: how long a concentration counts as the best one, s; 0: for ever."""
        self._recall = recall
        self._own = Recall(recall)
        self.first_detected_at = NEVER
        self.detected_at = NEVER
        self.best = 0.0  # x_g of (2.3), its concentration and time
        self.best_at = NEVER
        self.best_x = 0.0
        self.best_y = 0.0
        self.leg = -1
        self.leg_by = 0
        self.heading = (0.0, 0.0)

    @property
    def started(self) -> bool:
        """Whether anyone has detected the odour, as far as this robot has heard."""
        return self.first_detected_at >= 0.0

    def lost(self, t: float, after: float) -> bool:
        """Whether the group has been without a detection for longer than `after` seconds."""
        return t - self.detected_at > after

    def detect(self, t: float, concentration: float, x: float, y: float) -> None:
        """This robot met `concentration` above the threshold at (x, y)."""
        if self.first_detected_at < 0.0:
            self.first_detected_at = t
        self.detected_at = max(self.detected_at, t)
        smell = Smell(concentration, t, x, y)
        self._own.add(smell)
        self._offer_best(smell)

    def own_best(self) -> Smell | None:
        """x_l of (2.3): the best of this robot's own detections that count."""
        return self._own.best(self.detected_at)

    def lead(self, leg: int, by: int, heading: tuple[float, float]) -> None:
        """Take a search heading if it is of a later leg, or of the same leg by a robot of lower number."""
        if leg > self.leg or (leg == self.leg and by < self.leg_by):
            self.leg, self.leg_by, self.heading = leg, by, heading

    def merge(self, heard: Shared) -> None:
        """Take what a neighbour knows."""
        first = heard.first_detected_at
        if first >= 0.0:
            if self.first_detected_at < 0.0 or first < self.first_detected_at:
                self.first_detected_at = first
            if heard.detected_at > self.detected_at:
                self.detected_at = heard.detected_at
            self._offer_best(Smell(heard.best_concentration, heard.best_at, heard.best_x, heard.best_y))
        if heard.search_leg >= self.leg:
            self.lead(heard.search_leg, heard.search_by, (heard.search_x, heard.search_y))

    def _offer_best(self, smell: Smell) -> None:
        mine = Smell(self.best, self.best_at, self.best_x, self.best_y)
        if self._is_old(self.best_at):
            mine = self.own_best() or mine
        # Ties are broken by time and place, so that all robots agree whatever order they heard in.
        if not self._is_old(smell.at) and (self._is_old(mine.at) or smell > mine) and smell.concentration > 0.0:
            mine = smell
        self.best, self.best_at, self.best_x, self.best_y = mine

    def _is_old(self, at: float) -> bool:
        return self._recall > 0.0 and at < self.detected_at - self._recall

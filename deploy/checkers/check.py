"""All checkers over one run.

    from deploy.checkers.check import check_run, read_folder, read_memory

    findings = check_run(read_folder(folder))
    broken = [finding for finding in findings if not finding.passed]
    surprises = unplanned(history)  # without what a planned liar is meant to break

A new checker is one new file and one line in `CHECKERS`.
"""

from __future__ import annotations

from deploy.checkers import clearance, contraction, covariance, hull
from deploy.checkers.conservation import heard_was_sent
from deploy.checkers.finding import Checker, Finding
from deploy.checkers.freshness import nothing_stale_used
from deploy.checkers.history import History, read_folder, read_memory
from deploy.checkers.honesty import told_what_it_held
from deploy.checkers.neighbours import used_neighbours_only
from deploy.checkers.order import ticks_grow
from deploy.checkers.stopped import stays_stopped
from deploy.checkers.verdict import one_true_verdict
from protocol.scenario.faults import Liar

CHECKERS = (
    Checker("neighbours", "only neighbours' states were used", used_neighbours_only),
    Checker("freshness", "no state older than the bound was used", nothing_stale_used),
    Checker("order", "ticks never went back", ticks_grow),
    Checker("conservation", "nothing was heard or driven that was not sent", heard_was_sent),
    Checker("honesty", "everybody told what it held", told_what_it_held),
    Checker(
        "covariance", "covariances stayed positive definite", covariance.covariance_positive, covariance.without_filter
    ),
    Checker("hull", "the fusion stayed inside what went into it", hull.fusion_inside_hull, hull.not_promised),
    Checker(
        "contraction", "disagreement shrank while connected", contraction.disagreement_shrinks, contraction.not_promised
    ),
    Checker("clearance", "nobody came too near to another", clearance.stays_clear, clearance.not_promised),
    Checker("stopped", "nobody drove after the safe stop", stays_stopped),
    Checker("verdict", "one verdict, and the truth agrees", one_true_verdict),
)

__all__ = ["CHECKERS", "Finding", "History", "check_run", "read_folder", "read_memory", "unplanned"]


def check_run(history: History) -> list[Finding]:
    """What every checker says, in the order of `CHECKERS`."""
    return [checker.look(history) for checker in CHECKERS]


def unplanned(history: History) -> list[Finding]:
    """The broken promises, without the one that the scenario's liars are meant to break."""
    liars = any(isinstance(fault, Liar) for fault in history.scenario.faults)
    return [each for each in check_run(history) if not each.passed and not (liars and each.name == "honesty")]

"""Chapter 6: the potential-based finite-time motion control, Examples 1 to 4 and section 6.3."""

from deploy.reproduce.chapter6 import circular, coordination, parallel, robots, tracking

REPRODUCTIONS = (
    *coordination.REPRODUCTIONS,
    *tracking.REPRODUCTIONS,
    *parallel.REPRODUCTIONS,
    *circular.REPRODUCTIONS,
    *robots.REPRODUCTIONS,
)

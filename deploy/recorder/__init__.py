"""The recorder: what was said in a run becomes a Rerun recording and a live picture.

Rules of this package: nothing else imports rerun, and here nothing imports it before a `Recording` is made,
because that takes half a second; numbers are prepared by modules without rerun (`track`, `decisions`,
`links`), `layers` only dresses them; what is drawn never flows back to the swarm.
"""

from deploy.recorder.recording import Recording

__all__ = ["Recording"]

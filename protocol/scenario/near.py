"""What a person probably meant by a name that is not known."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def near(name: str, known: Iterable[str]) -> str:
    """`; did you mean "wind"?`, or nothing when no known name is near."""
    matches = get_close_matches(name, list(known), n=1, cutoff=0.6)
    return f'; did you mean "{matches[0]}"?' if matches else ""


def near_or_all(name: str, known: Iterable[str]) -> str:
    """`; did you mean "wind"?`, or everything that is known when nothing is near."""
    known = list(known)
    return near(name, known) or f"; there is {', '.join(known)}."

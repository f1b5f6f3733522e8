"""Colours, as 0xRRGGBBAA: one per robot, the same in the picture and in the plots.

The first seven are those of Okabe and Ito, which the colour-blind tell apart, with their dark blue lightened
for the dark background; further robots get lighter and darker shades of them.
"""

from __future__ import annotations

_BASE = (0x56B4E9, 0xE69F00, 0x1FB58A, 0xD98CB3, 0xF0E442, 0xE8703A, 0x6F8FF0)
_SHADES = (0.0, 0.5, -0.3, 0.25, 0.75, -0.15, 0.62, 0.38)  # towards white above 0, towards black below

DEAD = 0x6B7078FF
TEXT = 0xC9CED6FF
FRAME = 0x59606CFF
GRID = 0x2A2F38FF
SCALE = 0x8A93A0FF
WIND = 0x3A4A62FF
PLUME = 0x7A763FFF
SOURCE = 0xFFFFFFFF
MAP = 0xFF4B3AFF
THRESHOLD = 0xB8BEC8FF
HEARD, SILENT, BROKEN, UNDECLARED = 0xDDE3EAFF, 0x7D7347FF, 0xE0324BFF, 0xC44BE0FF
ALIVE, UP = 0x3F9D6AFF, 0xD08A2EFF
BACKGROUND = 0x14171CFF

MODES = {"search": 0x4C78A8FF, "trace": 0x3F9D6AFF, "lost": 0xD08A2EFF, "dead": 0x4A4F57FF}


def faint(colour: int, share: float) -> int:
    """`colour` on the background as if it covered only `share` of it: Rerun's lines do not blend."""
    mixed = (
        round(b + (c - b) * share) for c, b in zip(_channels(colour), _channels(BACKGROUND), strict=True)
    )
    r, g, b = mixed
    return (r << 24) | (g << 16) | (b << 8) | 0xFF


def _channels(colour: int) -> tuple[int, int, int]:
    return (colour >> 24) & 255, (colour >> 16) & 255, (colour >> 8) & 255


def robot_colour(i: int) -> int:
    """Colour of robot `i`."""
    rgb = _BASE[i % len(_BASE)]
    shade = _SHADES[i // len(_BASE) % len(_SHADES)]
    end = 255 if shade > 0 else 0
    mixed = (round(c + (end - c) * abs(shade)) for c in ((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255))
    r, g, b = mixed
    return (r << 24) | (g << 16) | (b << 8) | 0xFF

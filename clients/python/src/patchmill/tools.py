"""Ball-end cutters with the cutting data of the command line."""
from __future__ import annotations

import math
import numbers
from collections.abc import Sequence

from .errors import OptionError
from .messages import BallEnd, Coolant, HolderSegment, Tool

USUAL_DIAMETER_MM = 6.0
USUAL_SPINDLE_RPM = 12000.0
USUAL_FEED_MM_PER_MIN = 1200.0


def _at_least_one(value: float) -> float:
    return max(1.0, math.floor(value + 0.5))


def ball(diameter_mm: float = USUAL_DIAMETER_MM, *, number: int | None = None, name: str = "", spindle_rpm: float | None = None,
         feed_mm_per_min: float | None = None, plunge_feed_mm_per_min: float | None = None, coolant: Coolant = Coolant.OFF,
         flute_length_mm: float | None = None, shank_diameter_mm: float | None = None, stickout_mm: float | None = None,
         holder: Sequence[HolderSegment] = (), holder_clearance_mm: float | None = None) -> Tool:
    """A ball-end cutter.

    The contract has no defaults for tool number, spindle speed and feeds. Those that are left out here are
    those of the command line: T1, and 12000 rpm, 1200 and 400 mm/min at D 6. Larger balls turn at the same
    cutting speed, smaller ones have the same feed per turn relative to the diameter. Report and program
    header then say that nobody has chosen them.
    """
    if not isinstance(diameter_mm, numbers.Real) or not diameter_mm > 0:
        raise OptionError("diameter_mm", f"= {diameter_mm!r}; it must be a number above 0")
    larger, smaller = min(1.0, USUAL_DIAMETER_MM / diameter_mm), min(1.0, diameter_mm / USUAL_DIAMETER_MM)
    usual_feed = math.floor(USUAL_FEED_MM_PER_MIN * smaller + 0.5)
    feed = _at_least_one(usual_feed) if feed_mm_per_min is None else feed_mm_per_min
    third = (usual_feed if feed_mm_per_min is None else feed_mm_per_min) / 3.0
    return Tool(
        number=1 if number is None else number, number_is_default=number is None, name=name, ball_end=BallEnd(diameter_mm=diameter_mm),
        spindle_rpm=_at_least_one(USUAL_SPINDLE_RPM * larger) if spindle_rpm is None else spindle_rpm,
        feed_mm_per_min=feed,
        plunge_feed_mm_per_min=_at_least_one(third) if plunge_feed_mm_per_min is None else plunge_feed_mm_per_min,
        cutting_data_is_default=None in (spindle_rpm, feed_mm_per_min, plunge_feed_mm_per_min),
        coolant=coolant, flute_length_mm=flute_length_mm, shank_diameter_mm=shank_diameter_mm, stickout_mm=stickout_mm,
        holder=holder, holder_clearance_mm=holder_clearance_mm)

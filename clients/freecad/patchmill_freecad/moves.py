"""The moves of a program as commands of FreeCAD's Path. It knows neither FreeCAD nor the package.

Post processors of FreeCAD 0.20 write I and J and leave K out, so that arcs in ZX and YZ (G18, G19) would
become other arcs without a word. Such arcs are chords here; those in XY stay.
"""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

Words = dict[str, float]
Command = tuple[str, Words]
Place = tuple[float, float, float]

# ArcPlane: the axes of the plane in the order in which they turn counter-clockwise, and the axis across.
PLANES = {1: (0, 1, 2), 2: (2, 0, 1), 3: (1, 2, 0)}
XY = 1
RAPID = 1  # MoveKind.RAPID
TURN = 2.0 * math.pi


def commands(path: Any, header: list[Command], chord_mm: float) -> list[Command]:
    """One command for each move of a patchmill.Path, but chords within chord_mm for arcs in ZX and YZ, and
    one command for each begun turn of arcs in XY. Speeds are in mm/s, as FreeCAD has them."""
    made = list(header)
    if len(path) == 0:
        return made
    x, y, z = map(float, path.tip_mm[0])
    # The motion begins there. FreeCAD draws a path from its first place, and a control comes from above.
    made += [("G0", {"Z": z}), ("G0", {"X": x, "Y": y})]
    start = (x, y, z)
    for k in range(1, len(path)):
        end = (float(path.tip_mm[k][0]), float(path.tip_mm[k][1]), float(path.tip_mm[k][2]))
        plane, speed = int(path.arc_plane[k]), float(path.feed_mm_per_min[k]) / 60.0
        if int(path.kind[k]) == RAPID:
            made.append(("G0", _words(end)))
        elif plane == 0:
            made.append(("G1", {**_words(end), "F": speed}))
        else:
            arc = Arc(plane, start, end, tuple(map(float, path.arc_center_mm[k])), float(path.arc_turns[k]))
            made += arc.turns_of(speed) if plane == XY else arc.chords(speed, chord_mm)
        start = end
    return made


def _words(end: Place) -> Words:
    return dict(zip("XYZ", end))


class Arc:
    """An arc, or a helix, about an axis of the machine."""

    def __init__(self, plane: int, start: Place, end: Place, center: tuple[float, ...], turns: float) -> None:
        self._first, self._second, self._axis = PLANES[plane]
        self._start, self._end, self._center, self._turns = start, end, center, turns
        offset = (start[self._first] - center[self._first], start[self._second] - center[self._second])
        self._radius, self._begin = math.hypot(*offset), math.atan2(offset[1], offset[0])

    def _at(self, share: float) -> Place:
        if share >= 1.0:
            return self._end
        place, angle = [0.0, 0.0, 0.0], self._begin + TURN * self._turns * share
        place[self._first] = self._center[self._first] + self._radius * math.cos(angle)
        place[self._second] = self._center[self._second] + self._radius * math.sin(angle)
        place[self._axis] = self._start[self._axis] + share * (self._end[self._axis] - self._start[self._axis])
        return (place[0], place[1], place[2])

    def turns_of(self, speed: float) -> Iterator[Command]:
        """The arc in XY, one command for each begun turn."""
        count, here = max(1, math.ceil(abs(self._turns) - 1e-9)), self._start
        for k in range(1, count + 1):
            there = self._at(k / count)
            yield ("G3" if self._turns > 0.0 else "G2"), {
                **_words(there), "I": self._center[0] - here[0], "J": self._center[1] - here[1], "F": speed}
            here = there

    def chords(self, speed: float, chord_mm: float) -> Iterator[Command]:
        """Straight moves that leave the arc by chord_mm at most."""
        largest = 2.0 * math.acos(max(0.0, 1.0 - chord_mm / self._radius)) if self._radius > 0.0 else TURN
        count = max(1, math.ceil(TURN * abs(self._turns) / largest))
        for k in range(1, count + 1):
            yield "G1", {**_words(self._at(k / count)), "F": speed}

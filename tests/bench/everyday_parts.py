#!/usr/bin/env python3
"""Writes parts as machines cut them every day (.bv, exact) into a folder, for the figures in README.md.

usage: everyday_parts.py FOLDER
"""
import math
import pathlib
import sys

ROUND = math.sqrt(0.5)  # middle weight of a quarter of a circle


class Part:
    """Rational Bezier patches; nets as rows of (x, y, z, weight)."""

    def __init__(self):
        self.lines = []

    def add(self, rows):
        self.lines += ["8", f"{len(rows) - 1} {len(rows[0]) - 1}"]
        for row in rows:
            self.lines += [f"{x * w:.17g} {y * w:.17g} {z * w:.17g} {w:.17g}" for x, y, z, w in row]

    def turned(self, profiles, cx=0.0, cy=0.0):
        """Profiles of (r, z, weight) around an upright axis, in quarters."""
        for profile in profiles:
            for quarter in range(4):
                a = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter]
                b = (-a[1], a[0])
                ring = [(a, 1.0), ((a[0] + b[0], a[1] + b[1]), ROUND), (b, 1.0)]
                self.add([[(cx + r * p[0], cy + r * p[1], z, pw * w) for r, z, w in profile] for p, pw in ring])
        return self

    def drawn(self, profiles, length):
        """Profiles of (x, z, weight) along y."""
        for profile in profiles:
            self.add([[(x, 0.0, z, w), (x, length, z, w)] for x, z, w in profile])
        return self

    def quad(self, a, b, c, d):
        self.add([[(*a, 1.0), (*d, 1.0)], [(*b, 1.0), (*c, 1.0)]])
        return self


def line(*points):
    return [[(*a, 1.0), (*b, 1.0)] for a, b in zip(points, points[1:])]


def quarter(a, corner, b):
    return [[(*a, 1.0), (*corner, ROUND), (*b, 1.0)]]


def pyramid(half, high):
    part = Part()
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    for a, b in zip(corners, corners[1:] + corners[:1]):
        part.quad((*a, 0), (*b, 0), (0, 0, high), (0, 0, high))
    return part


def bosses():
    part = Part().quad((-5, -5, 0), (65, -5, 0), (65, 65, 0), (-5, 65, 0))
    for i in range(4):
        for j in range(4):
            part.turned(line((0, 6 + i), (3, 6 + i), (3, 0)), 7.5 + 15 * i, 7.5 + 15 * j)
    return part


# Depth or height, mm, and draft of the walls, degrees.
DRAFTS = [(6, 5), (9.3, 20), (4.1, 30), (4.7, 0), (8, 10), (6.4, 40), (7.7, 15), (5.3, 25), (9, 3)]


def pockets():
    part = Part()
    for k, (deep, draft) in enumerate(DRAFTS):
        floor = 11 - deep * math.tan(math.radians(draft))
        part.turned(line((0, -deep), (floor, -deep), (11, 0), (15, 0)), 32 * (k % 3), 32 * (k // 3))
    return part


def frusta():
    part = Part()
    for k, (high, draft) in enumerate(DRAFTS):
        foot = 4 + high * math.tan(math.radians(draft))
        part.turned(line((0, high), (4, high), (foot, 0), (17, 0)), 36 * (k % 3), 36 * (k // 3))
    return part


PARTS = {
    "hole": lambda: Part().turned(line((0, 0), (3, 0), (3, 10), (20, 10))),
    "bowl": lambda: Part().turned(quarter((0, 0), (3, 0), (3, 3)) + line((3, 3), (15, 3))),
    "slot": lambda: Part().drawn(line((0, 10), (10, 10), (10, 0), (16, 0), (16, 10), (26, 10)), 30),
    "groove": lambda: Part().drawn(
        line((0, 6), (10, 6), (10, 3)) + quarter((10, 3), (10, 0), (13, 0)) + quarter((13, 0), (16, 0), (16, 3))
        + line((16, 3), (16, 6), (26, 6)), 30),
    "ring": lambda: Part().turned(line((0, 10), (8, 10), (8, 0), (14, 0), (14, 10), (22, 10))),
    "wide_slot": lambda: Part().drawn(line((0, 10), (10, 10), (10, 0), (22, 0), (22, 10), (32, 10)), 30),
    "pyramid": lambda: pyramid(15, 15),
    "saw": lambda: Part().drawn(line(*[(6 * i, 6 * (i % 2)) for i in range(8)]), 30),
    "cap": lambda: Part().turned(line((0, 12), (12, 12), (12, 10), (4, 10), (4, 0), (20, 0))),
    "terraces": lambda: Part().turned(line((0, 20), (5, 20), (5, 10), (10, 10), (10, 5), (15, 5), (15, 0), (20, 0))),
    "stepped_hole": lambda: Part().turned(line((0, 0), (4, 0), (4, 5), (8, 5), (8, 10), (12, 10), (12, 15), (20, 15))),
    "needle": lambda: Part().turned(line((0, 15), (0.01, 0), (15, 0))),
    "bosses": bosses,
    "pockets": pockets,  # nine, no two of the same depth and draft
    "frusta": frusta,    # the same upside down
}

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in PARTS.items():
        (folder / f"{name}.bv").write_text("\n".join(make().lines) + "\n")

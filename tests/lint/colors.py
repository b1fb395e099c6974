#!/usr/bin/env python3
"""Holds the three tables of region and border colours to each other: colors.py ROOT.

A picture (.svg), a page (.html) and the web page show the same regions, and each has a table of its own, because each sees
other types: the planner's, the contract's in C++, and the contract's in TypeScript. This test reads the tables out of the
sources and reports every colour that is not the same in all of them.
"""
import pathlib
import re
import sys

SOURCES = ("cam/plan/job_preview.cc", "clients/cli/scene_words.cc", "clients/web/page/scene.ts")
KINDS = {"MOUNTAIN", "BASIN", "NEUTRAL"}
REASONS = {"CONCAVE", "FLOOR", "SHANK", "HOLDER", "OUTSIDE", "STRATEGY"}
BORDERS = {"SLOPE", "CURVATURE", "SILHOUETTE", "WATERSHED", "SEAM", "STRATEGY"}

RGB = r"(\d+), (\d+), (\d+)"
KIND = re.compile(r"(?:RegionKind(?:::k|\.)|REGION_KIND_)(\w+)\b[^;!]*?[sS]teep \?[^;\d]*" + RGB + r"[^;\d]*" + RGB)
REASON = re.compile(r"(?:UnreachableReason(?:::k|\.)|UNREACHABLE_REASON_)(\w+)\b[^;\d]{0,20}" + RGB)
OTHER = re.compile(r"(?:Rgb = \[|Rgb rgb\{|^ +: set\()" + RGB + r"[\])}]+;", re.MULTILINE)  # of a reason without a colour of its own
SHIFT = re.compile(r"% (\d+)\)? - (\d+)\) \* (\d+)")  # of the lightness of neighbours
BORDER = re.compile(r"(?:BorderKind(?:::k|\.)|BORDER_KIND_)(\w+)\b(?:, |\]: |:\s*return )\"(#[0-9a-f]{6})\"")
OTHER_BORDER = re.compile(r"(?:BorderKind::kReach, |default:\s*return |\?\? )\"(#[0-9a-f]{6})\"")


def upper(name):
    """kOpenEdge and OPEN_EDGE are the same kind."""
    return name if name.isupper() else re.sub(r"(?<!^)(?=[A-Z])", "_", name).upper()


def read(text):
    """The colours of a source by what they stand for."""
    colors = {}
    for name, *rgb in KIND.findall(text):
        colors[f"{upper(name)}, steep"] = ", ".join(rgb[:3])
        colors[f"{upper(name)}, gentle"] = ", ".join(rgb[3:])
    for name, *rgb in REASON.findall(text):
        colors[upper(name)] = ", ".join(rgb)
    for key, pattern in (("other reasons", OTHER), ("shift of neighbours", SHIFT)):
        found = pattern.search(text)
        if found:
            colors[key] = ", ".join(found.groups())
    for name, color in BORDER.findall(text):
        colors[f"border {upper(name)}"] = color
    found = OTHER_BORDER.search(text)
    if found:
        colors["other borders"] = found.group(1)
    return colors


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    tables = {source: read((root / source).read_text(encoding="utf-8")) for source in SOURCES}
    needed = {f"{kind}, {slope}" for kind in KINDS for slope in ("steep", "gentle")} | REASONS
    needed |= {f"border {kind}" for kind in BORDERS} | {"other reasons", "shift of neighbours", "other borders"}
    faults = 0
    for source, colors in tables.items():
        for key in sorted(needed - colors.keys()):
            faults += 1
            print(f"{source}: no colour was found for {key}; state it, or adapt tests/lint/colors.py to how it is stated")
    for key in sorted(set().union(*tables.values())):
        values = {source: colors[key] for source, colors in tables.items() if key in colors}
        # The picture draws open edges in any case, and REACH is what the other tables call other borders.
        if len(set(values.values())) > 1:
            faults += 1
            print(f"{key} has several colours: " + "; ".join(f"{value} in {source}" for source, value in values.items()))
    print(f"colors: {len(SOURCES)} tables of {len(needed)} colours, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

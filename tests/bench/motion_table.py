#!/usr/bin/env python3
"""The motion of ten parts as a table: feed blocks, arcs, lengths, retracts and time.

usage: motion_table.py PATCHMILL [OPTION...]     from the root of the repository

The options go to every `patchmill mill`, as --machine docs/machine.json does. A build that does not know a figure
leaves its column empty, so builds can be compared.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

PARTS = [
    ("teapot", "examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02"),
    ("two hills", "examples/two_hills.bv --tool-diameter 6 --scallop 0.01"),
    ("mouse", "examples/mouse.json --tool-diameter 6 --scallop 0.02"),
    ("bonnet", "examples/bonnet.json --tool-diameter 6 --scallop 0.02"),
    ("teacup", "tests/models/teacup.bpt --up z --scale 20 --tool-diameter 6 --scallop 0.02"),
    ("sphere", "tests/models/sphere.bv --scale 20 --tool-diameter 6 --scallop 0.02"),
    ("saddle", "tests/models/saddle.patches --scale 20 --tool-diameter 6 --scallop 0.02"),
    ("icosahedron", "tests/models/icosahedron.patches --scale 20 --tool-diameter 6 --scallop 0.02"),
    ("block", "tests/models/cad/block.step --tool-diameter 6 --scallop 0.02"),
    ("mixed kinds", "tests/models/mixed_kinds.bv --scale 8 --tool-diameter 6 --scallop 0.02"),
]


def row(binary: str, words: list[str], options: list[str], folder: pathlib.Path) -> list[str]:
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [binary, "mill", *words, *options, "--allowance", "0.5", "-o", folder / "part.ngc", "--report", report]
    subprocess.run(command, capture_output=True, check=False)
    if not report.exists():
        return ["no report"]
    figures = json.loads(report.read_text())

    def figure(key: str, form: str, scale: float = 1.0) -> str:
        return form.format(scale * figures[key]) if key in figures else ""

    blocks = figures.get("feed_block_count", figures["point_count"])
    return [
        figures["outcome"].removeprefix("OUTCOME_"),
        str(blocks),
        figure("arc_block_count", "{:.0f}"),
        figure("cut_length_mm", "{:.2f}", 1e-3),
        figure("rapid_length_mm", "{:.2f}", 1e-3),
        figure("retract_count", "{:.0f}"),
        figure("estimated_time_s", "{:.2f}", 1.0 / 60.0),
    ]


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| part | outcome | feed blocks | arcs | feed, m | rapids, m | retracts | minutes |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, words in PARTS:
            cells = row(sys.argv[1], words.split(), sys.argv[2:], pathlib.Path(folder))
            print("| " + " | ".join([name, *cells]) + " |")


if __name__ == "__main__":
    main()

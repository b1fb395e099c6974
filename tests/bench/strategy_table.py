#!/usr/bin/env python3
"""AUTO beside the forced strategies on ten parts: minutes, and what each leaves uncut.

usage: strategy_table.py PATCHMILL [PART...]     from the root of the repository; all parts of motion_table.py by default

The minutes are those of docs/machine.json. A forced strategy counts only where it finishes as much as AUTO does: where
it leaves at most a thousandth of the area more. "over" is how much longer AUTO takes than the quicker of those.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from motion_table import PARTS

STRATEGIES = ("auto", "contour", "zigzag")
SAME_FINISH = 1e-3  # of the area


def mill(binary: str, words: list[str], strategy: str, folder: pathlib.Path) -> tuple[float, float] | None:
    """Minutes, and the share of the area that stays uncut; None without a program."""
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = [binary, "mill", *words, "--strategy", strategy, "--allowance", "0.5", "--machine", "docs/machine.json",
               "--max-unreached", "100", "-o", folder / "part.ngc", "--report", report]
    subprocess.run(command, capture_output=True, check=False)
    if not report.exists():
        return None
    figures = json.loads(report.read_text())
    if not figures["outcome"].startswith("OUTCOME_COMPLETE"):
        return None
    area = sum(region["area_mm2"] for region in figures["regions"])
    return figures["estimated_time_s"] / 60.0, figures.get("unreachable_area_mm2", 0.0) / area


def row(binary: str, words: list[str], folder: pathlib.Path) -> list[str]:
    found = [mill(binary, words, strategy, folder) for strategy in STRATEGIES]
    cells = ["-" if f is None else f"{f[0]:.2f} ({100.0 * f[1]:.1f} %)" for f in found]
    auto, *forced = found
    if auto is None:
        return [*cells, "-"]
    rivals = [f[0] for f in forced if f is not None and f[1] <= auto[1] + SAME_FINISH]
    return [*cells, f"{100.0 * (auto[0] / min(rivals) - 1.0):+.1f} %" if rivals else "none finishes as much"]


def main() -> None:
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| part | AUTO, minutes (uncut) | contours | zig-zag lines | over |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, words in PARTS:
            if len(sys.argv) > 2 and name not in sys.argv[2:]:
                continue
            print(f"| {name} | {' | '.join(row(sys.argv[1], words.split(), pathlib.Path(folder)))} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Reads and judges a program of a million blocks: two hills, lines with scallops of 0.0005 mm, in blocks of at most 0.2 mm.

usage: million_blocks.py PATCHMILL [--blocks 1000000] [--tolerance 0.1]

The program is Patchmill's own with its blocks cut into equal parts, so that it says the same motion. A tolerance of 0.1 mm
judges with a certainty of 0.01 mm. Prints blocks, seconds, processor seconds and memory of `patchmill verify`.
"""
import argparse
import math
import pathlib
import re
import resource
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORD = re.compile(r"([XYZF])(-?[\d.]+)")


def cut(lines: list[str], longest: float) -> list[str]:
    """The same program with straight blocks of at most `longest` mm."""
    out, place, mode, known = [], {"X": 0.0, "Y": 0.0, "Z": 0.0}, 0, set()
    for line in lines:
        code = line.split("(")[0].strip()
        words = {k: float(v) for k, v in WORD.findall(code)}
        if m := re.match(r"(G53 )?G([01])\b", code):
            mode = int(m[2])
        plain = re.fullmatch(r"(G1 ?)?([XYZF]-?[\d.]+ ?)+", code) is not None
        axes = {k: v for k, v in words.items() if k != "F"}
        if not (plain and mode == 1 and known == {"X", "Y", "Z"}):
            out.append(line)
        else:
            length = math.dist([place[k] for k in "XYZ"], [axes.get(k, place[k]) for k in "XYZ"])
            parts = max(1, math.ceil(length / longest))
            for i in range(1, parts + 1):
                at = {k: place[k] + (axes.get(k, place[k]) - place[k]) * i / parts for k in axes}
                text = " ".join(f"{k}{v:.4f}" for k, v in at.items())
                out.append(text + (f" F{words['F']:g}" if i == 1 and "F" in words else ""))
                if i == 1 and code.startswith("G1"):
                    out[-1] = "G1 " + out[-1]
        if "G53" not in code:
            place.update(axes)
            known |= axes.keys()
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("patchmill")
    parser.add_argument("--blocks", type=int, default=1_000_000)
    parser.add_argument("--tolerance", type=float, default=0.1)
    options = parser.parse_args()
    part = ROOT / "examples/two_hills.bv"
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "program.ngc"
        subprocess.run([options.patchmill, "mill", part, "-o", file, "--tool-diameter", "6", "--scallop", "0.0005", "--no-arcs",
                        "--quiet"], check=True, stderr=subprocess.DEVNULL)
        lines = file.read_text().split("\n")
        longest = 0.2
        while len(blocks := cut(lines, longest)) < options.blocks:
            longest *= 0.9 * max(0.3, len(blocks) / options.blocks)
        file.write_text("\n".join(blocks))
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        run = subprocess.run([options.patchmill, "verify", part, file, "--tool-diameter", "6", "--scallop", "0.0005", "--tolerance",
                              str(options.tolerance)], capture_output=True, text=True)
        took, after = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
        print((run.stdout + run.stderr).strip().split("\n")[0])
        print(f"million_blocks: {len(blocks)} blocks of at most {longest:.3f} mm, status {run.returncode}, {took:.1f} s, "
              f"{after.ru_utime - before.ru_utime:.1f} processor s, at most {after.ru_maxrss / 1024:.0f} MiB")


if __name__ == "__main__":
    main()

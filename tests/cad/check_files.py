#!/usr/bin/env python3
"""Checks every STEP and IGES file below a folder, and prints those that are refused, with the first reason.

  tests/cad/check_files.py PATCHMILL FOLDER [--valid FILE.json] [--seconds 60]

PATCHMILL is the command line. FILE.json, as tests/cad/make_parts.py writes it, has the number of faces of
each part by the name of its file, without the ending: a file with another number counts as refused. Ends
with 1 if more than one file in twenty is refused.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

ENDINGS = (".step", ".stp", ".p21", ".iges", ".igs")


def fault_of(patchmill: str, part: pathlib.Path, seconds: float, wanted: int | None) -> tuple[str, int]:
    """Why the file is refused, "" if it is not, and how many faces it has."""
    try:
        run = subprocess.run([patchmill, "check", part], capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return f"not read within {seconds:g} s", 0
    said = run.stdout + run.stderr
    stated = re.search(r" (\d+) faces \(", said)
    faces = int(stated.group(1)) if stated else 0
    error = re.search(r"ERROR .*", said)
    if error:
        return error.group(0), faces
    if run.returncode != 0:
        return said.strip().splitlines()[-1] if said.strip() else f"exit {run.returncode}", faces
    if wanted is not None and faces != wanted:
        return f"{faces} faces, not {wanted}", faces
    return "", faces


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("patchmill")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--valid", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    wanted = json.loads(given.valid.read_text()) if given.valid else {}
    parts = sorted(p for p in given.folder.rglob("*") if p.suffix.lower() in ENDINGS)
    faces = refused = 0
    for part in parts:
        fault, count = fault_of(given.patchmill, part, given.seconds, wanted.get(part.stem))
        faces += count
        if fault:
            refused += 1
            print(f"{part.relative_to(given.folder)}: {fault}", flush=True)
    print(f"check_files: {len(parts) - refused} of {len(parts)} files, {faces} faces")
    return 0 if parts and 20 * refused <= len(parts) else 1


if __name__ == "__main__":
    sys.exit(main())

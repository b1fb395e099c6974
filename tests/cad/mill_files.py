#!/usr/bin/env python3
"""Mills and verifies the CAD files of options.tsv, and prints a row for each.

  tests/cad/mill_files.py PATCHMILL FOLDER [-o FOLDER_OF_RESULTS] [FILE ...]

PATCHMILL is the command line, FOLDER has the files. Each is milled with its options of options.tsv, and
its program is verified once more by `patchmill verify` with the same options. A file passes if the
outcome is COMPLETE or COMPLETE_WHERE_REACHABLE, its second verdict finds no gouge, and no height had to
be corrected by its certificate. Programs, reports and pictures stay in FOLDER_OF_RESULTS, if it is given.
"""

import argparse
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time

DONE = ("OUTCOME_COMPLETE", "OUTCOME_COMPLETE_WHERE_REACHABLE")


def options_of() -> dict[str, list[str]]:
    rows = {}
    for line in pathlib.Path(__file__).with_name("options.tsv").read_text().splitlines():
        if line and not line.startswith("#"):
            name, options = line.split("\t")
            rows[name] = shlex.split(options)
    return rows


def short(name: str) -> str:
    return name.removeprefix("OUTCOME_")


def mill(patchmill: str, part: pathlib.Path, options: list[str], results: pathlib.Path) -> bool:
    program, report_file = results / f"{part.name}.ngc", results / f"{part.name}.json"
    start = time.monotonic()
    milled = subprocess.run([patchmill, "mill", part, *options, "-o", program, "--report", report_file,
                             "--preview", results / f"{part.name}.png"], capture_output=True, text=True)
    took = time.monotonic() - start
    report = json.loads(report_file.read_text()) if report_file.exists() else {}
    outcome = report.get("outcome", "none")
    total, missed = report.get("total_area_mm2", 0.0), report.get("unreachable_area_mm2", 0.0)
    reasons = ", ".join(f"{part['reason'].removeprefix('UNREACHABLE_REASON_')} {100.0 * part['area_mm2'] / total:.1f} %"
                        for part in report.get("unreachable", []))
    verdict = "no program"
    if program.exists():
        judged = subprocess.run([patchmill, "verify", part, program, *options, "--report", results / f"{part.name}.verify.json"],
                                capture_output=True, text=True)
        verdict = "verified" if judged.returncode == 0 else (judged.stderr.strip().splitlines() or ["refused"])[0]
    defects = report.get("certificate_defect_count", 0)
    passed = milled.returncode == 0 and outcome in DONE and verdict == "verified" and defects == 0
    share = 100.0 * missed / total if total else 0.0
    gouge, leftover = report.get("max_gouge_mm", 0.0), report.get("max_leftover_mm", 0.0)
    print(f"{part.name:22} {'pass' if passed else 'FAIL':4}  {short(outcome):26} {took:6.1f} s  gouge {gouge:.4f} mm  "
          f"leftover {leftover:.4f} mm  not reached {share:.1f} % ({reasons or '-'})  "
          f"look down {report.get('underside_area_mm2', 0.0):.0f} mm2  defects {defects}  again: {verdict}", flush=True)
    if milled.returncode != 0:
        print("\n".join(f"    {line[:200]}" for line in milled.stderr.strip().splitlines()[:5]))
    return passed


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("patchmill")
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("files", nargs="*")
    arguments.add_argument("-o", "--output", type=pathlib.Path)
    args = arguments.parse_args()
    options = options_of()
    unknown = [name for name in args.files if name not in options]
    if unknown:
        arguments.error(f"{', '.join(unknown)}: not in options.tsv")
    missing = [name for name in args.files or options if not (args.folder / name).exists()]
    if missing:
        arguments.error(f"{args.folder} has no {', '.join(missing)}")
    with tempfile.TemporaryDirectory() as scratch:
        results = args.output or pathlib.Path(scratch)
        results.mkdir(parents=True, exist_ok=True)
        passed = [mill(args.patchmill, args.folder / name, options[name], results) for name in args.files or options]
    print(f"mill_files: {sum(passed)} of {len(passed)} passed")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())

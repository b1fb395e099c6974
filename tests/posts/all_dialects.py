#!/usr/bin/env python3
"""Mills three parts for every dialect, and checks each program, and those of tests/golden/posts, by the control's rules.

usage: all_dialects.py PATCHMILL

It prints a table; exit status 1 at a breach that KNOWN_BREACHES does not list, or at a job that fails. The options of the jobs are chosen
so that every pair of unit, arcs and restart points is met for every dialect, at the price of a few coarse jobs.
"""
import collections
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import control_rules  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
DIALECTS = ("linuxcnc", "grbl", "fanuc", "haas", "heidenhain", "siemens", "mach3")
COARSE = ["--scallop", "0.3", "--tolerance", "0.05"]
PARTS = {
    "hills": ["examples/two_hills.bv", "--tool-diameter", "6"],
    "block": ["tests/models/cad/block.step", "--tool-diameter", "10"],
    "wall": ["tests/models/vertical_wall.bpt", "--tool-diameter", "4"],
}
INCH, NO_ARCS, RESTART = ["--inch"], ["--no-arcs"], ["--restart-points", "--line-numbers", "10"]
# Any two of the three options are met in all four ways.
PAIRS = [[], INCH + NO_ARCS, INCH + RESTART, NO_ARCS + RESTART]

# Dialect, rule, and what is wrong with our programs: certain breaches of a manual, for the posts to correct.
KNOWN_BREACHES = [
    ("heidenhain", "unit-of-feeds", "Programs in inches state F in inch per minute, while the control reads 1/10 inch per minute."),
    ("heidenhain", "size-of-feeds", "Programs in inches have feeds with four decimals, while the format of F has three."),
]


def jobs():
    """Dialect, part and options of every job; block and hills, which take longest, are milled once for each dialect."""
    for number, dialect in enumerate(DIALECTS):
        yield dialect, "block", PAIRS[(number + 2) % 4]
        yield dialect, "hills", (INCH if number % 2 else []) + RESTART + ["--coolant", "flood"]
    for dialect in DIALECTS:
        for options in PAIRS:
            yield dialect, "wall", options


def mill(patchmill, folder, number, job):
    """Runs one job; its name, and the text of the program, or what the job said where it failed."""
    dialect, part, options = job
    program = pathlib.Path(folder) / f"{number}.nc"
    model, *tool = PARTS[part]
    done = subprocess.run([patchmill, "mill", str(ROOT / model), "-o", str(program), "--post", dialect, "--quiet", "--threads", "1",
                           "--program-number", "42", *tool, *COARSE, *options], capture_output=True, text=True, check=False)
    text = control_rules.read_file(program) if done.returncode == 0 else None
    return " ".join([part, *options]), dialect, text, done.stderr


def milled(patchmill):
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        running = [pool.submit(mill, patchmill, folder, number, job) for number, job in enumerate(jobs())]
        yield from (one.result() for one in running)


def golden():
    for path in sorted((ROOT / "tests/golden/posts").glob("*.ngc")):
        yield path.name, path.stem.removesuffix("_inch"), control_rules.read_file(path), ""


def is_known(dialect, breach):
    return any((dialect, breach.rule) == known[:2] for known in KNOWN_BREACHES)


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    failed, met, warned = False, set(), collections.Counter()
    print(f"{'dialect':11} {'program':62} {'lines':>6} {'breaches':>8} {'known':>6} {'warnings':>8}")
    for programs in (golden(), milled(arguments[0])):
        for name, dialect, text, said in programs:
            found = control_rules.check_text(text, dialect) if text is not None else []
            breaches = [b for b in found if b.certain and not is_known(dialect, b)]
            known = {b.rule for b in found if b.certain and is_known(dialect, b)}
            warned.update((dialect, b.rule) for b in {b.rule: b for b in found if not b.certain}.values())
            met |= {(dialect, rule) for rule in known}
            print(f"{dialect:11} {name:62} {(text or '').count(chr(10)):6} {len(breaches):8} {len(known):6} "
                  f"{sum(not b.certain for b in found):8}")
            for b in breaches[:10]:
                print(f"    line {b.line}: {b.rule}: {b.text} [{b.source}]")
            if text is None:
                print("    the job failed: " + said.strip())
            failed = failed or bool(breaches) or text is None
    for (dialect, rule), count in sorted(warned.items()):
        print(f"warning in {count} programs: {dialect}: {rule}")
    for dialect, rule, sentence in KNOWN_BREACHES:
        print(f"known: {dialect}: {rule}: {sentence}" + ("" if (dialect, rule) in met else " No program has it any more: strike it off."))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

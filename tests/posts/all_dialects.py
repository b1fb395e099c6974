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
import re
import shutil
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
    "block": ["tests/models/cad/block.step", "--tool-diameter", "10", "--detail", "0"],
    "wall": ["tests/models/vertical_wall.bpt", "--tool-diameter", "4"],
    "name": ["tests/models/vertical_wall.bpt", "--tool-diameter", "4"],
}
# The part "name" is a model with a name that a user may give it, with characters that mean something to some control.
AWKWARD = "MSG, 50% of (it)! ~ [new?]; %h#1$\u00e9.bpt"
INCH, NO_ARCS, RESTART = ["--inch"], ["--no-arcs"], ["--restart-points", "--line-numbers", "10"]
# Any two of the three options are met in all four ways.
PAIRS = [[], INCH + NO_ARCS, INCH + RESTART, NO_ARCS + RESTART]

# Dialect, rule, and what is wrong with our programs: certain breaches of a manual, for the posts to correct.
KNOWN_BREACHES = []


def jobs():
    """Dialect, part and options of every job; the block, which takes longest, is milled once for each dialect."""
    for number, dialect in enumerate(DIALECTS):
        yield dialect, "block", PAIRS[(number + 2) % 4]
        if number % 2 == 0:
            yield dialect, "hills", (INCH if number % 4 else []) + RESTART + ["--coolant", "flood"]
    for dialect in DIALECTS:
        for options in PAIRS:
            yield dialect, "wall", options
        yield dialect, "name", ["--spindle", "12345.6"]


def mill(patchmill, folder, number, job):
    """Runs one job; its name, and the text of the program, or what the job said where it failed."""
    dialect, part, options = job
    program = pathlib.Path(folder) / f"{number}.nc"
    program.with_suffix("").mkdir()
    model, *tool = PARTS[part]
    model = ROOT / model
    if part == "name":
        model = shutil.copy(model, pathlib.Path(folder) / str(number) / AWKWARD)
    done = subprocess.run([patchmill, "mill", str(model), "-o", str(program), "--post", dialect, "--quiet", "--threads", "1",
                           "--program-number", "42", *tool, *COARSE, *options], capture_output=True, text=True, check=False)
    text = control_rules.read_file(program) if done.returncode == 0 else None
    return " ".join([part, *options]), dialect, text, done.stderr


def milled(patchmill):
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        running = [pool.submit(mill, patchmill, folder, number, job) for number, job in enumerate(jobs())]
        yield from (one.result() for one in running)


def largest_feed(text):
    """The largest F of a program, comments left out."""
    code = re.sub(r"\(.*?\)|;.*", "", text)
    return max(float(f) for f in re.findall(r"F(\d+\.?\d*)", code))


def scale_of_feeds(programs):
    """Breaches of the scale of F: the wall in inches has the feeds of that in mm, over 25.4; on Heidenhain ten times that."""
    feeds = {(dialect, name): largest_feed(text) for name, dialect, text, _ in programs if text and name.startswith("wall")}
    for dialect in DIALECTS:
        wanted = 2.54 if dialect == "heidenhain" else 25.4
        mm, inch = feeds.get((dialect, "wall")), feeds.get((dialect, " ".join(["wall", *INCH, *NO_ARCS])))
        if mm and inch and abs(mm / inch / wanted - 1) > 0.01:
            yield dialect, control_rules.Breach(0, "scale-of-feeds", f"F{mm:g} in mm, F{inch:g} in inches", "the manual on F", True)


def golden():
    for path in sorted((ROOT / "tests/golden/posts").glob("*.ngc")):
        yield path.name, path.stem.removesuffix("_inch"), control_rules.read_file(path), ""


def is_known(dialect, breach):
    return any((dialect, breach.rule) == known[:2] for known in KNOWN_BREACHES)


class Table:
    """What is printed, and whether a breach is among it that is not known."""

    def __init__(self):
        self.failed, self.met, self.warned = False, set(), collections.Counter()
        print(f"{'dialect':11} {'program':64} {'lines':>6} {'breaches':>8} {'known':>6} {'warnings':>8}")

    def add(self, name, dialect, text, said):
        found = control_rules.check_text(text, dialect) if text is not None else []
        certain = [b for b in found if b.certain]
        self.warned.update((dialect, rule) for rule in {b.rule for b in found if not b.certain})
        known = {b.rule for b in certain if is_known(dialect, b)}
        print(f"{dialect:11} {name:64} {(text or '').count(chr(10)):6} {sum(not is_known(dialect, b) for b in certain):8} "
              f"{len(known):6} {len(found) - len(certain):8}")
        self.report(dialect, certain)
        if text is None:
            print("    the job failed: " + said.strip())
            self.failed = True

    def report(self, dialect, breaches):
        new = [b for b in breaches if not is_known(dialect, b)]
        self.met |= {(dialect, b.rule) for b in breaches}
        self.failed = self.failed or bool(new)
        for b in new[:10]:
            print(f"    line {b.line}: {b.rule}: {b.text} [{b.source}]")

    def finish(self):
        for (dialect, rule), count in sorted(self.warned.items()):
            print(f"warning in {count} programs: {dialect}: {rule}")
        for dialect, rule, sentence in KNOWN_BREACHES:
            print(f"known: {dialect}: {rule}: {sentence}" + ("" if (dialect, rule) in self.met else " NOT MET ANY MORE: strike it off."))
        return 1 if self.failed else 0


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    table, done = Table(), []
    for programs in (golden(), milled(arguments[0])):
        for one in programs:
            table.add(*one)
            done.append(one)
    for dialect, breach in scale_of_feeds(done):
        table.report(dialect, [breach])
    return table.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

#!/usr/bin/env python3
"""Lists what changed in the answers of the golden jobs between two commits, ready for a commit message.

usage: changes.py [OLD [NEW]]    OLD: a commit, by default HEAD; NEW: a commit, by default the files as they are
"""
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent


def text(name, commit):
    if commit is None:
        return (FOLDER / name).read_text()
    shown = subprocess.run(["git", "show", f"{commit}:./{name}"], cwd=FOLDER, capture_output=True, text=True)
    if shown.returncode != 0:
        sys.exit(f"{commit} has no tests/golden/{name}: {shown.stderr.strip()}")
    return shown.stdout


def rows(name, commit):
    """The titles of the columns and {first column: the others}."""
    lines = [line.split("\t") for line in text(name, commit).splitlines() if line]
    return lines[0][1:], {line[0]: line[1:] for line in lines[1:]}


def changed_parts(old, new):
    """{job: ["motion", "report"]} of all jobs in both."""
    parts = {}
    for key in sorted(set(old) & set(new)):
        if old[key] != new[key]:
            job, part = key.split("/")
            parts.setdefault(job, []).append(part)
    return parts


def figure(title, before, now):
    try:
        percent = f" ({100 * (float(now) - float(before)) / float(before):+.2f} %)"
    except (ValueError, ZeroDivisionError):
        percent = ""
    return f"{title} {before} -> {now}{percent}"


def main():
    if len(sys.argv) > 3 or "-h" in sys.argv or "--help" in sys.argv:
        sys.exit(__doc__.strip())
    old_commit = sys.argv[1] if len(sys.argv) > 1 else "HEAD"
    new_commit = sys.argv[2] if len(sys.argv) > 2 else None
    _, old_hashes = rows("hashes.tsv", old_commit)
    _, new_hashes = rows("hashes.tsv", new_commit)
    old_titles, old_figures = rows("figures.tsv", old_commit)
    titles, figures = rows("figures.tsv", new_commit)

    changed = changed_parts(old_hashes, new_hashes)
    for job, parts in changed.items():
        before = dict(zip(old_titles, old_figures[job]))
        now = dict(zip(titles, figures[job]))
        figures_changed = [figure(t, before[t], now[t]) for t in titles if t in before and before[t] != now[t]]
        print(f"{job}: {', '.join(parts)}")
        for line in figures_changed or ["no figure"]:
            print(f"  {line}")
    for job in sorted(set(figures) - set(old_figures)):
        print(f"{job}: new")
    for job in sorted(set(old_figures) - set(figures)):
        print(f"{job}: gone")
    print(f"{len(changed)} of {len(figures)} jobs changed")


if __name__ == "__main__":
    main()

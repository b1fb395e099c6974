#!/usr/bin/env python3
"""Fails on a retired word: docs/glossary.md has the word to use instead.

usage: words.py ROOT [FOLDER...]        all files of the repository, or those below the folders

Words are held as whole words, in code, comments, messages and pages. A phrase may run over the end of a line.
"""
import collections
import pathlib
import re
import subprocess
import sys

SUFFIXES = {".h", ".cc", ".proto", ".md", ".py", ".sh"}
# They list the retired words.
LISTS = {"docs/glossary.md", "tests/lint/words.py"}
# A file, and a part of the line in which the word stays.
EXCEPTIONS = [
    ("server/digest.cc", '"no round lines"'),  # hashed: the digests of requests depend on it
]
# Retired words of the glossary that English needs for other things. Only the names in WORDS below are held.
TOO_COMMON = {"around", "foot", "give", "judge", "keep in", "mend", "near part", "run on", "touched"}

# Phrase (in any case), names in code, what to use. Regular expressions of whole words. A blank stands for any white space, the
# end of a comment line included.
WORDS = [
    # the surface
    (r"steep grounds?", "", "steep area"),
    (r"(?:gentle|shallow) grounds?", "", "shallow area"),
    (r"upright grounds?", "", "vertical face"),
    (r"level grounds?", "", "flat"),
    (r"grounds?", "LevelGrounds?|ContourGround|GroundHeights|RoundGround|GroundCell", "surface, area, face; group of levels"),
    (r"hangs? together|hung together", "", "is connected"),
    # limits and reach
    ("", "ReachGive|reach_give|kGive|give_|params\\.give|`give`", "reach tolerance, ReachTolerance"),
    (r"keep-in", r"KeepIn\w*|\w*ToKeepIn|keep_in\w*", "limits of the operation, OperationLimits"),
    (r"least ball", "LeastBall", "smallest ball, SmallestBallRadius"),
    ("", r"NearPart|near_part\w*", "MaskProximity"),
    (r"plan mask", r"PlanMask|plan_mask\w*", "near-spots mask, NearSpotsMask"),
    ("", r"Touched(?=\()|kTouchedReach", "ContactPoints"),
    # steps and passes
    (r"flat steps?(?!-over)", "", "flat step-over"),
    (r"crease pass(?:es)?", "FindCrease|TraceCrease|CreasePoint|CreaseTracer", "pencil pass, FindPencilPoint"),
    (r"mend(?:s|ed|ing)?", "MendSpots|Mender|Mending", "finish; rest pass, RestPassesAt"),
    (r"needless(?:ly)?", "WithoutNeedless|SeemsNeedless", "redundant, RemoveRedundantPasses"),
    (r"crumbs?", "kCrumb", "short pass, or the quantity"),
    (r"once around", "OnceAround|once_around", "one full turn, RemoveOverlapTurn"),
    (r"round lines?|lines in circles", r"\w*RoundLines?|RoundTry", "circular lines, CircularLines"),
    (r"run-ons?|runs? on over", "RunOn", "extend pass, ExtendPasses; overrun"),
    (r"to and fro", "", "back and forth"),
    ("", "LiftFoot|feet_", "base level, LiftBaseLevel"),
    ("", "LevelItems", "ContactCandidates"),
    ("", "CoverageParams", "RestPassParams"),
    # motion, verification, messages
    (r"ways? in and out", "", "approach, retract"),
    (r"(?:the|an?|its|our|only|own|independent) judges?", "JudgedParts|JudgeForced", "verifier"),
    (r"least feed", "least_feed|LeastFeed", "least cut length, least_cut_length"),
    (r"told(?! apart)", "Told|told_", "reported, findings"),
    (r"asked for", "", "requested, wanted"),
    ("", "IdleSettings|IdleSpirals", "UnusedSettings, UnusedSpirals"),
]
LINE_END = r"[ \t]*\n[ \t]*(?://+|#+|\*)?[ \t]*"


def scanner(phrase: str, names: str) -> re.Pattern:
    words = [f"(?i:{phrase.replace(' ', f'(?:[ ]|{LINE_END})')})"] if phrase else []
    return re.compile(rf"(?<![\w-])(?:{'|'.join(words + ([names] if names else []))})(?!\w)")


SCAN = [(scanner(phrase, names), use) for phrase, names, use in WORDS]


def hits(text: str) -> list[tuple[int, str, str]]:
    """Offset, word found, what to use. Where two rows of WORDS fit one place the first one counts."""
    found, taken = [], set()
    for pattern, use in SCAN:
        for match in pattern.finditer(text):
            places = range(match.start(), match.end())
            if taken.isdisjoint(places):
                taken.update(places)
                found.append((match.start(), re.sub(rf"{LINE_END}|[ ]+", " ", match.group()), use))
    return sorted(found)


def glossary_gaps(root: pathlib.Path) -> list[str]:
    """Retired words of the glossary that no row of WORDS finds."""
    gaps = []
    for line in (root / "docs" / "glossary.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) != 6 or cells[5] in {"retired word", "---", ""}:
            continue
        gaps += [word for word in cells[5].split(", ") if word not in TOO_COMMON and not hits(f"a {word}\n")]
    return gaps


def main() -> int:
    root = pathlib.Path(sys.argv[1]).resolve()
    folders = tuple(folder.rstrip("/") + "/" for folder in sys.argv[2:])
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root, capture_output=True, text=True, check=True
    )
    faults, count, files = 0, collections.Counter(), 0
    for name in sorted(set(listed.stdout.splitlines())):
        path = root / name
        if path.suffix not in SUFFIXES or name in LISTS or not path.is_file():
            continue
        if folders and not name.startswith(folders):
            continue
        files += 1
        text = path.read_text(errors="replace")
        lines = text.splitlines()
        for at, word, use in hits(text):
            number = text.count("\n", 0, at) + 1
            if any(name == file and part in lines[number - 1] for file, part in EXCEPTIONS):
                continue
            print(f"{name}:{number}: {word} -> {use}")
            faults += 1
            count["/".join(name.split("/")[:2]) if "/" in name else "."] += 1
    for word in glossary_gaps(root):
        print(f"docs/glossary.md: retired word '{word}' is not held: add it to WORDS of tests/lint/words.py")
        faults += 1
    for folder, number in sorted(count.items()):
        print(f"{number:6} {folder}")
    print(f"words: {files} files, {faults} faults")
    return 1 if faults or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())

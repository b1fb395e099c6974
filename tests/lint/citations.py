#!/usr/bin/env python3
"""Every citation in brackets refers to a page, section, figure, equation, label or entry that is there.

usage: citations.py ROOT        (how to cite: docs/theory/README.md)

Fails, too, on the names of books that are not in the repository.
"""
import pathlib
import re
import subprocess
import sys

SUFFIXES = {".h", ".cc", ".proto", ".md", ".py", ".sh", ".txt", ".cmake"}
LOST_BOOKS = re.compile(r"\b(METHODS|ALGORITHMS|MACHINING|PEERS)\b|\bDESIGN \d")


def targets(page: pathlib.Path) -> set[str]:
    """What a page offers: "section 3", "figure 2", "(4)", "T22", "P1"."""
    found = set()
    for line in page.read_text().splitlines():
        for pattern, form in (
            (r"^## (\d+)\b", "section {}"),
            (r"^\*\*Figure (\d+)\.", "figure {}"),
            (r"^\s+.*\s\((\d+)\)\s*$", "({})"),
            (r"^\*\*Theorem (T\d+[a-z]?)\b", "{}"),
            (r"^\*\*([A-Z]\d+) ", "{}"),
        ):
            if match := re.match(pattern, line):
                found.add(form.format(match.group(1)))
    return found


def parts(detail: str) -> list[str] | None:
    """The targets that the text after the page's name asks for; None if it is no citation."""
    if not detail:
        return []
    if match := re.fullmatch(r", (section|figure) (\d+)", detail):
        return [f"{match.group(1)} {match.group(2)}"]
    if re.fullmatch(r" \(\d+\)(?:(?:-|, )\(\d+\))*", detail):
        numbers = []
        for first, last in re.findall(r"\((\d+)\)(?:-\((\d+)\))?", detail):
            numbers += range(int(first), int(last or first) + 1)
        return [f"({n})" for n in numbers]
    if re.fullmatch(r" [A-Z]\d+[a-z]?(?:, [A-Z]\d+[a-z]?)*", detail):
        return re.findall(r"[A-Z]\d+[a-z]?", detail)
    return None


def joined(text: str) -> str:
    """One line for each comment, so that a citation may run over the end of a line."""
    return re.sub(r"\n[ \t]*(?://+|#+|\*)? *", " ", text)


def main() -> int:
    root = pathlib.Path(sys.argv[1]).resolve()
    theory = root / "docs" / "theory"
    pages = {page.stem: targets(page) for page in theory.glob("*.md") if page.stem != "README"}
    entries = set(re.findall(r"^### (\S+)", (root / "docs" / "references.md").read_text(), re.MULTILINE))
    citation = re.compile(r"\[(" + "|".join(sorted(pages)) + r")((?:, | |)[^\]\[]*)\](?!\()")
    reference = re.compile(r"\[references: ([^\]]+)\]")
    faults, count = [], 0
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root, capture_output=True, text=True, check=True
    )
    for name in listed.stdout.splitlines():
        path = root / name
        if path.suffix not in SUFFIXES or not path.is_file() or name == "tests/lint/citations.py":
            continue
        text = path.read_text(errors="replace")
        for number, line in enumerate(text.splitlines(), 1):
            if LOST_BOOKS.search(line):
                faults.append(f"{name}:{number}: cites a book that is not in the repository: {line.strip()[:100]}")
        if path == theory / "README.md":
            continue
        flat = joined(text)
        for match in citation.finditer(flat):
            wanted = parts(match.group(2))
            if wanted is None:
                continue
            count += 1
            for target in wanted:
                if target not in pages[match.group(1)]:
                    faults.append(f"{name}: {match.group(0)} has no target: docs/theory/{match.group(1)}.md lacks {target}")
        for match in reference.finditer(flat):
            count += 1
            for label in match.group(1).split(", "):
                if label not in entries:
                    faults.append(f"{name}: {match.group(0)} has no entry in docs/references.md")
    print("\n".join(faults))
    print(f"{count} citations, {len(faults)} faults")
    if count < 100:
        print("hardly any citation was found: the grammar of this test is wrong")
        return 1
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

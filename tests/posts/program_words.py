"""Reads NC programs of G code into blocks, and follows the modes and positions that they leave in force.

What is read here is what all these controls have in common; what differs is in Syntax. Written from the makers' manuals.
"""
import re
from typing import NamedTuple

PLANES = {17: ("X", "Y", "I", "J"), 18: ("Z", "X", "K", "I"), 19: ("Y", "Z", "J", "K")}
WORD = re.compile(r"([A-Za-z])\s*=?\s*([+-]?\s*[0-9. ]*[0-9.]|)")
NAMES = re.compile(r"(SUPA|CYCLE\d+|MSG)\s*(\([^)]*\))?")


class Word(NamedTuple):
    letter: str
    text: str

    @property
    def value(self):
        return float(self.text.replace(" ", ""))


class Syntax(NamedTuple):
    round_comments: bool
    semicolon: bool
    names: bool


SYNTAX = {
    "linuxcnc": Syntax(True, True, False),
    "grbl": Syntax(True, True, False),
    "mach3": Syntax(True, False, False),
    "fanuc": Syntax(True, False, False),
    "haas": Syntax(True, False, False),
    "siemens": Syntax(False, True, True),
}


class Block:
    """One line: its words and comments, and the modes in force once they are read."""

    def __init__(self, line, text):
        self.line = line
        self.raw = text
        self.comments = []
        self.open_comment = False
        self.words = []
        self.names = []
        self.rest = ""
        self.mark = False

    def all(self, letter):
        return [w for w in self.words if w.letter == letter]

    def has(self, letter):
        return any(w.letter == letter for w in self.words)

    def value(self, letter):
        found = self.all(letter)
        return found[-1].value if found and number(found[-1].text) else None

    def codes(self, letter):
        return [w.value for w in self.all(letter) if number(w.text)]

    def axes(self):
        return {w.letter: w.value for w in self.words if w.letter in "XYZ" and number(w.text)}

    def named(self, name):
        return [arguments for found, arguments in self.names if found == name]


def number(text):
    """A number is a sign, digits and at most one point, with a digit somewhere."""
    return re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)", text.replace(" ", "")) is not None


def decimals(text):
    return len(text.partition(".")[2])


def split_comments(block, syntax):
    """The text of a line without its comments, which go to the block."""
    text, kept = block.raw, ""
    while text:
        starts = [i for i in (text.find("(") if syntax.round_comments else -1,
                              text.find(";") if syntax.semicolon else -1) if i >= 0]
        if not starts:
            return kept + text
        at = min(starts)
        kept += text[:at]
        if text[at] == ";":
            block.comments.append(text[at + 1:])
            return kept
        end = text.find(")", at)
        block.open_comment = end < 0
        block.comments.append(text[at + 1:end] if end >= 0 else text[at + 1:])
        text = text[end + 1:] if end >= 0 else ""
    return kept


def read_block(line, raw, syntax):
    block = Block(line, raw)
    text = split_comments(block, syntax)
    if syntax.names:
        block.names = [(m[1], (m[2] or "").strip("()")) for m in NAMES.finditer(text)]
        text = NAMES.sub(" ", text)
    if text.strip() == "%":
        block.mark = True
        return block
    at = 0
    for found in WORD.finditer(text):
        block.rest += text[at:found.start()].strip()
        block.words.append(Word(found[1].upper(), found[2].strip()))
        at = found.end()
    block.rest += text[at:].strip()
    return block


class Modes:
    """What is in force between blocks."""

    def __init__(self):
        self.motion = self.plane = self.unit = self.distance = self.centres = self.feed = self.speed = None
        self.feed_mode = 94
        self.compensation = self.length = self.tool = self.work_offset = None
        self.spindle = False
        self.place = {"X": None, "Y": None, "Z": None}

    def copy(self):
        new = Modes()
        new.__dict__.update(self.__dict__)
        new.place = dict(self.place)
        return new


UNITS = {20: "inch", 21: "mm", 70: "inch", 71: "mm", 700: "inch", 710: "mm"}


def take_codes(modes, block, dialect):
    for g in block.codes("G"):
        if g in (0, 1, 2, 3):
            modes.motion = g
        elif g == 80:
            modes.motion = None
        elif g in (17, 18, 19):
            modes.plane = int(g)
        elif g in (90, 91):
            modes.distance = g
        elif g in (90.1, 91.1):
            modes.centres = g
        elif g in (93, 94, 95):
            modes.feed_mode = g
        elif g in (40, 41, 42):
            modes.compensation = g
        elif g in (43, 43.1, 43.2, 44):
            modes.length = g
        elif g == 49:
            modes.length = 0
        elif 54 <= g < 60:
            modes.work_offset = g
        elif g in UNITS and (g < 22) == (dialect != "siemens"):
            modes.unit = UNITS[g]


def take_words(modes, block, dialect):
    if block.has("F") and 4 not in block.codes("G"):
        modes.feed = block.value("F")
    if block.has("S"):
        modes.speed = block.value("S")
    if block.has("T"):
        modes.tool = block.value("T")
    if dialect == "siemens" and block.has("D"):
        modes.length = block.value("D")
    for m in block.codes("M"):
        if m == 6:
            modes.spindle = False
            if dialect in ("linuxcnc", "mach3"):
                modes.length = modes.length or 0
    for m in block.codes("M"):
        if m in (3, 4):
            modes.spindle = True
        elif m in (0, 1, 2, 5, 30):
            modes.spindle = False


def move(modes, block):
    """Follows the axis words of a block. A place that machine coordinates or a reference point leave is unknown."""
    block.start = dict(modes.place)
    g = block.codes("G")
    block.machine = 53 in g or bool(block.named("SUPA"))
    block.reference = bool({28, 30} & set(g))
    block.sets = bool({10, 92, 4} & set(g))
    axes = block.axes()
    block.moves = bool(axes) and not block.sets
    for axis, value in axes.items() if block.moves else ():
        if block.machine or block.reference:
            modes.place[axis] = None
        elif modes.distance == 91:
            old = modes.place[axis]
            modes.place[axis] = None if old is None else old + value
        else:
            modes.place[axis] = value
    block.end = dict(modes.place)
    block.arc = modes.motion in (2, 3) and not (block.machine or block.reference or block.sets) and (
        block.moves or any(block.has(c) for c in "IJK"))
    block.feeds = (block.moves or block.arc) and modes.motion in (1, 2, 3) and not block.reference


def read_program(text, dialect):
    """All blocks of a program; block.before and block.modes are the modes before and after it."""
    modes = Modes()
    blocks = []
    for line, raw in enumerate(text.split("\n"), 1):
        if raw == "" and line > text.count("\n"):
            continue
        block = read_block(line, raw.rstrip("\r"), SYNTAX[dialect])
        block.before = modes.copy()
        take_codes(modes, block, dialect)
        take_words(modes, block, dialect)
        move(modes, block)
        block.modes = modes.copy()
        blocks.append(block)
    return blocks


def arc_radii(block):
    """Radius at the start, at the end, and the end as (u, v) from the centre; None where a place is unknown."""
    if block.modes.plane is None:
        return None
    u, v, i, j = PLANES[block.modes.plane]
    places = (block.start[u], block.start[v], block.end[u], block.end[v])
    if None in places or not (block.has(i) or block.has(j)):
        return None
    du, dv = block.value(i) or 0.0, block.value(j) or 0.0
    end = (places[2] - places[0] - du, places[3] - places[1] - dv)
    return (du * du + dv * dv) ** 0.5, (end[0] ** 2 + end[1] ** 2) ** 0.5

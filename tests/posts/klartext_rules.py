"""The rules of Heidenhain's conversational programs (klartext): TNC 320, 620, 640, iTNC 530. control_rules.py runs them."""
import re

USER = "HEIDENHAIN TNC 640/iTNC 530 User's Manual Conversational Programming"
CYCLES = "HEIDENHAIN TNC 640/iTNC 530 User's Manual Cycle Programming, Cycle 32 TOLERANCE"
FORMATS = "HEIDENHAIN TNC 640 User's Manual, Technical information: input format and unit of TNC functions"
RULES = []
KNOWN_M = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 14, 30, 89, 90, 91, 92, 94, 97, 98, 99, 107, 108, 116, 126, 127, 128, 129, 136, 137, 140}


def rule(source, certain=True):
    """Registers a rule with the manual that states it."""
    def register(function):
        RULES.append((function.__name__.replace("_", "-"), source, certain, function))
        return function
    return register


class Block:
    """One block: its number, its kind (the first words) and its words."""

    KINDS = ("BEGIN PGM", "END PGM", "TOOL CALL", "TOOL DEF", "BLK FORM", "CYCL DEF", "CYCL CALL", "CALL LBL", "LBL", "STOP", "CC", "CR",
             "CT", "C", "L")

    def __init__(self, line, raw):
        self.line, self.raw = line, raw
        numbered = re.match(r"(\d+)\s+(.*)$", raw)
        self.number = int(numbered[1]) if numbered else None
        text = numbered[2] if numbered else raw
        self.comment = text.partition(";")[2] if ";" in text else None
        self.text = text.partition(";")[0].strip()
        named = [k for k in self.KINDS if self.text == k or self.text.startswith(k + " ")]
        self.kind = named[0] if named else "M" if re.match(r"M\d", self.text) else ""
        self.words = self.text[len(self.kind):].split() if self.kind != "M" else self.text.split()
        self.moves = self.kind in ("L", "C", "CR", "CT")
        self.fmax = "FMAX" in self.words
        self.machine = "M91" in self.words or "M92" in self.words

    def m(self):
        return [int(w[1:]) for w in self.words if re.fullmatch(r"M\d+", w)]

    def place(self):
        return {w[0]: float(w[1:]) for w in self.words if re.fullmatch(r"[XYZ][+-]?(\d+\.?\d*|\.\d+)", w)}

    def feed(self):
        found = [w for w in self.words if re.fullmatch(r"F\d+\.?\d*", w)]
        return found[0][1:] if found else None


def read(text):
    lines = text.split("\n")
    return [Block(i, raw.rstrip("\r")) for i, raw in enumerate(lines, 1) if raw or i < len(lines)]


def places(program):
    """The blocks, each with the place before it; machine coordinates leave it unknown."""
    place = {}
    for block in program:
        before = dict(place)
        if block.moves:
            for axis, value in block.place().items():
                place[axis] = None if block.machine else value
        yield block, before


@rule(USER + ", Organization of an NC program")
def block_numbers(program):
    """Every block has a number; the numbers start at 0 and rise by one."""
    for expected, block in enumerate(program):
        if block.number != expected:
            yield block.line, f"block {block.number}, {expected} is expected"
            return


def frame(block, kind):
    found = re.fullmatch(kind + r" (\S+) (MM|INCH)", block.text)
    return found and (found[1], found[2])


@rule(USER + ", Organization of an NC program: BEGIN PGM, END PGM, name and unit")
def begin_and_end(program):
    """The first block is BEGIN PGM, the last is END PGM, with the same name and unit; there is one of each."""
    first, last = frame(program[0], "BEGIN PGM"), frame(program[-1], "END PGM")
    if not first:
        yield program[0].line, "no BEGIN PGM with name and unit"
    if not last:
        yield program[-1].line, "no END PGM with name and unit"
    elif first and first != last:
        yield program[-1].line, f"END PGM {' '.join(last)} is not BEGIN PGM {' '.join(first)}"
    for block in program[1:-1]:
        if block.kind in ("BEGIN PGM", "END PGM"):
            yield block.line, f"{block.kind} inside the program"


@rule(USER + ", M2, M30, and END PGM")
def end_of_program(program):
    """M2 or M30 stands before END PGM, and nothing between them."""
    ends = [i for i, block in enumerate(program) if {2, 30} & set(block.m())]
    if not ends:
        yield program[-1].line, "no M2 or M30"
    elif any(b.text for b in program[ends[0] + 1:-1]):
        yield program[ends[0] + 1].line, "blocks after the end of the program"


@rule(USER + ", characters of the editor")
def plain_characters(program):
    """A program consists of printable ASCII characters."""
    for block in program:
        if re.search(r"[^ -~]", block.raw):
            yield block.line, "a character that is not ASCII"


@rule(USER + ", comments: a block of its own, or at its end; ~ continues a block")
def comment_form(program):
    """A comment starts with ; and does not end in ~."""
    for block in program:
        if block.raw.rstrip().endswith("~"):
            yield block.line, "~ at the end"
        if "(" in block.text:
            yield block.line, "brackets are no comment"


@rule(USER + ", block length", certain=False)
def line_length(program):
    """A block fits into the editor of older controls."""
    for block in program:
        if len(block.raw) > 128:
            yield block.line, f"{len(block.raw)} characters"


@rule(USER + ", path functions")
def known_blocks(program):
    """The control knows the function of every block."""
    for block in program:
        if block.text and not block.kind:
            yield block.line, f"unknown: {block.text[:30]}"


@rule(USER + ", path functions")
def known_words(program):
    """The words of moves are coordinates, R0, F and M."""
    allowed = r"I?[XYZ][+-]?(\d+\.?\d*|\.\d+)|R0|RL|RR|F\d+\.?\d*|FMAX|F|M\d+|DR[+-]"
    for block in program:
        for word in block.words if block.moves or block.kind in ("CC", "M") else []:
            if not re.fullmatch(allowed, word) or word == "F":
                yield block.line, f"word {word}"


@rule(FORMATS + ": 5 places before and 4 after the point")
def size_of_lengths(program):
    """Coordinates have five places before the point and, in mm, four after it."""
    mm = program[0].text.endswith("MM")
    for block in program:
        for word in block.words if block.moves or block.kind == "CC" else []:
            found = re.fullmatch(r"I?[XYZ][+-]?(\d*)\.?(\d*)", word)
            if found and (len(found[1].lstrip("0")) > 5 or (mm and len(found[2]) > 4)):
                yield block.line, f"{word} has too many digits"


@rule(FORMATS + ": four places after the point, stated for mm", certain=False)
def decimals_of_inches(program):
    """Coordinates and tolerances in inches have four places after the point; five are an option (display step)."""
    if program[0].text.endswith("INCH"):
        for block in program:
            for word in block.words if block.moves or block.kind in ("CC", "CYCL DEF") else []:
                if re.fullmatch(r"I?[XYZT][+-]?\d*\.\d{5,}", word):
                    yield block.line, f"{word} has more than four decimals"


@rule(FORMATS + ": feed rates 0 to 99 999.999 (5, 3)")
def size_of_feeds(program):
    """A feed is above zero, with five places before the point and three after it."""
    for block in program:
        feed = block.feed()
        if feed and not (re.fullmatch(r"\d{1,5}(\.\d{0,3})?", feed) and float(feed) > 0):
            yield block.line, f"F{feed} is out of its format"


@rule(USER + ", Feed rate F; TNC7 User's Manual, Cutting data: in inch programs 1/10 inch/min")
def unit_of_feeds(program):
    """In an inch program F counts tenths of an inch per minute; a comment that says inch per minute is wrong by ten."""
    if not program[0].text.endswith("INCH"):
        return
    for block in program:
        if block.comment and re.search(r"feeds? (in )?inch(es)? per minute", block.comment, re.I) and "1/10" not in block.comment:
            yield block.line, "F is meant in inch per minute, the control reads 1/10 inch per minute"


@rule(USER + ", Feed rate F; FMAX holds in its block alone")
def feed_before_feed_moves(program):
    """A feed is in force at every move without FMAX."""
    feed = None
    for block in program:
        feed = block.feed() or feed
        if block.moves and not block.fmax and not feed:
            yield block.line, "a feed move without F"
            return


@rule(USER + ", M functions: two per block on the iTNC 530, four on the TNC 640")
def number_of_m_words(program):
    """A block holds two M functions at most."""
    for block in program:
        if len(block.m()) > 2:
            yield block.line, f"{len(block.m())} M functions"


@rule(USER + ", M functions")
def known_m_words(program):
    """The control knows every M function."""
    for block in program:
        for m in block.m():
            if m not in KNOWN_M:
                yield block.line, f"M{m}"


@rule(USER + ", Tool radius compensation: R0")
def compensation_off(program):
    """R0 stands in the first move, and never RL or RR."""
    moves = [b for b in program if b.moves]
    if moves and "R0" not in moves[0].words:
        yield moves[0].line, "no R0 in the first move"
    for block in moves:
        if {"RL", "RR"} & set(block.words):
            yield block.line, "radius compensation"


@rule(USER + ", Calling tool data: TOOL CALL number, axis, S")
def tool_call(program):
    """TOOL CALL has the number of the tool, the axis Z and S above zero, and stands before the first move in work coordinates."""
    called = False
    for block in program:
        if block.kind == "TOOL CALL":
            called = True
            found = re.match(r"TOOL CALL (\d+) Z S(\d+\.?\d*)( F\d+\.?\d*)?$", block.text)
            if not found or not 0 < float(found[2]) <= 99999.999 or int(found[1]) > 32767:
                yield block.line, block.text
        elif block.moves and not block.machine and not called:
            yield block.line, "a move before TOOL CALL"
            return


@rule(USER + ", M3 M4 M5; TOOL CALL stops the spindle")
def spindle_before_feed_moves(program):
    """The spindle turns at every feed move."""
    on = False
    for block in program:
        on = False if block.kind == "TOOL CALL" else on
        for m in block.m():
            on = m in (3, 4, 13, 14) or (on and m not in (0, 2, 5, 30))
        if block.moves and not block.fmax and not on:
            yield block.line, "a feed move with the spindle off"
            return


@rule(USER + ", Machine-referenced coordinates M91, M92: in their block alone")
def machine_moves(program):
    """M91 stands in a straight move with coordinates, at FMAX."""
    for block in program:
        if block.machine and not (block.kind == "L" and block.place() and block.fmax):
            yield block.line, "M91 outside a rapid straight move"


@rule(USER + ", Circle center CC")
def centre_form(program):
    """CC has X and Y, and nothing else."""
    for block in program:
        if block.kind == "CC" and sorted(w.lstrip("I")[0] for w in block.words) != ["X", "Y"]:
            yield block.line, block.text


@rule(USER + ", Circular path C around circle center CC")
def arc_form(program):
    """C follows a CC, has an end in X and Y, and DR+ or DR-; Z, which CP alone takes, does not stand in it, nor R0."""
    centre = False
    for block in program:
        centre = centre or block.kind == "CC"
        if block.kind != "C":
            continue
        if not centre:
            yield block.line, "C before CC"
        if not {"X", "Y"} & set(block.place()):
            yield block.line, "C without an end"
        if "Z" in block.place():
            yield block.line, "C with Z: a helix is CP"
        if not {"DR+", "DR-"} & set(block.words):
            yield block.line, "C without DR"


@rule(USER + ", path functions: a rapid is straight", certain=False)
def no_rapid_arcs(program):
    """An arc does not run at FMAX."""
    for block in program:
        if block.kind in ("C", "CR", "CT") and block.fmax:
            yield block.line, "an arc at FMAX"


def radius_errors(program):
    """Of every arc the block, the difference of its radii in mm, and its radius."""
    scale, centre = (25.4 if program[0].text.endswith("INCH") else 1.0), {}
    for block, before in places(program):
        centre = block.place() if block.kind == "CC" else centre
        if block.kind == "C" and {"X", "Y"} <= set(centre):
            end = {**before, **block.place()}
            ends = [p for p in (before, end) if p.get("X") is not None and p.get("Y") is not None]
            if len(ends) < 2:
                yield block, None, 0
                continue
            r1, r2 = (((p["X"] - centre["X"]) ** 2 + (p["Y"] - centre["Y"]) ** 2) ** 0.5 for p in ends)
            yield block, abs(r1 - r2) * scale, min(r1, r2) * scale


@rule(USER + ", Circular path C: start and end lie on the circle, input tolerance up to 0.016 mm (circleDeviation, MP7431)")
def radii_agree(program):
    """Start and end of an arc lie on its circle, within 0.016 mm, and its radius is above zero."""
    for block, error, radius in radius_errors(program):
        if error is None:
            yield block.line, "an arc from a place that is not stated"
        elif error > 0.016 or radius <= 0:
            yield block.line, f"radius {radius:.4f} mm, the ends differ by {error:.4f} mm"


@rule(USER + ", circleDeviation is a parameter of the machine; 0.005 mm is usual", certain=False)
def radii_agree_by_parameter(program):
    """Start and end of an arc lie on its circle, within what machines are usually set to."""
    for block, error, _ in radius_errors(program):
        if error and error > 0.005:
            yield block.line, f"the ends differ by {error:.4f} mm"


@rule(CYCLES)
def tolerance_cycle(program):
    """CYCL DEF 32.0 is followed by 32.1 with T above zero, or with none to reset; 32.2 has HSC-MODE and TA."""
    for i, block in enumerate(program):
        if block.kind != "CYCL DEF" or not block.text.startswith("CYCL DEF 32."):
            continue
        before = program[i - 1].text if i else ""
        if block.text.startswith("CYCL DEF 32.0"):
            if i + 1 >= len(program) or not program[i + 1].text.startswith("CYCL DEF 32.1"):
                yield block.line, "32.0 without 32.1"
        elif block.text.startswith("CYCL DEF 32.1"):
            found = re.fullmatch(r"CYCL DEF 32\.1( T(\d{1,5}\.?\d*))?", block.text)
            if not found or (found[2] and not float(found[2]) > 0) or not before.startswith("CYCL DEF 32.0"):
                yield block.line, block.text
        elif not re.fullmatch(r"CYCL DEF 32\.2 HSC-MODE:[01] TA\d+\.?\d*", block.text) or not before.startswith("CYCL DEF 32.1"):
            yield block.line, block.text


@rule(CYCLES + ": reset with NO ENT", certain=False)
def tolerance_reset_form(program):
    """How a reset looks in a file, 32.1 without T or with an empty T, differs between controls."""
    for block in program:
        if block.text == "CYCL DEF 32.1":
            yield block.line, "32.1 without T"


@rule(CYCLES + ": T is in the unit of the program; below 0.001 mm nothing is smoothed", certain=False)
def tolerance_range(program):
    """T is at least 0.001 mm."""
    scale = 25.4 if program[0].text.endswith("INCH") else 1.0
    for block in program:
        found = re.fullmatch(r"CYCL DEF 32\.1 T(\d+\.?\d*)", block.text)
        if found and float(found[1]) * scale < 0.001:
            yield block.line, f"T{found[1]}"


def check_text(text):
    """All breaches: line, rule, text, source, certain."""
    program = read(text)
    if not program:
        return [(1, "begin-and-end", "an empty program", USER, True)]
    return [(line, name, message, source, certain) for name, source, certain, function in RULES for line, message in function(program)]

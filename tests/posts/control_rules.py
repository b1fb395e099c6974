#!/usr/bin/env python3
"""Reads NC programs as a control would, and reports every breach of the control's rules.

usage: control_rules.py DIALECT FILE...     DIALECT: linuxcnc grbl fanuc haas heidenhain siemens mach3

A breach is a line FILE:LINE: RULE: what is wrong [source]; exit status 1 if there is one. A rule that the manual does not settle, or that
machine parameters change, is uncertain: it is reported as a warning and does not fail.

The rules were written from the makers' manuals, without reading the posts of Patchmill. Every rule is a function of its own.
"""
import pathlib
import re
import sys
from typing import NamedTuple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import klartext_rules  # noqa: E402
from program_words import PLANES, arc_radii, decimals, number, read_program  # noqa: E402

NGC = "LinuxCNC, G-code Overview"
NGC_G = "LinuxCNC, G-codes"
GRBL = "Grbl v1.1, doc/markdown/interface.md, error"
GRBL_WORDS = "Grbl v1.1, doc/markdown/commands.md, $G: modal groups"
FANUC = "Fanuc 0i/30i Operator's Manual (B-64304EN, B-64484EN)"
HAAS = "Haas Mill Operator's Manual"
SIEMENS = "SINUMERIK 840D sl/828D Programming Manual Fundamentals"
SIEMENS_JOB = "SINUMERIK 840D sl/828D Programming Manual Job Planning"
MACH3 = "Using Mach3Mill, chapter 10"
NIST = "NIST RS274/NGC Interpreter, Version 3"

ISO = ("linuxcnc", "grbl", "fanuc", "haas", "siemens", "mach3")


class Breach(NamedTuple):
    line: int
    rule: str
    text: str
    source: str
    certain: bool


class Rule(NamedTuple):
    name: str
    sources: dict
    certain: bool
    function: object


RULES = []


def rule(sources, certain=True):
    """Registers a rule: sources maps each dialect that has it to the manual that states it."""
    def register(function):
        RULES.append(Rule(function.__name__.replace("_", "-"), sources, certain, function))
        return function
    return register


def everywhere(sources, default):
    return {dialect: sources.get(dialect, default) for dialect in ISO}


# ---- text ----

LENGTHS = {"linuxcnc": 256, "grbl": 79, "siemens": 512, "mach3": 256}


@rule({"linuxcnc": NGC + ", Format of a line: 256 characters", "grbl": GRBL + " 11; commands.md, $I: less than 80 characters",
       "siemens": SIEMENS + ", Block rules: 512 characters", "mach3": MACH3 + ", Format of a line: 256 characters"})
def line_length(program, dialect):
    """A line is no longer than the control's buffer for one block."""
    for block in program:
        if len(block.raw) > LENGTHS[dialect]:
            yield block.line, f"{len(block.raw)} characters, {LENGTHS[dialect]} are allowed"


@rule({"fanuc": FANUC + ", program display", "haas": HAAS + ", Edit screen"}, certain=False)
def readable_line_length(program, dialect):
    """A line that fits the screen of the control can be read there; no limit of a block is documented below 128 characters."""
    for block in program:
        if len(block.raw) > 128:
            yield block.line, f"{len(block.raw)} characters"


@rule(everywhere({"fanuc": FANUC + ", Appendix: program code list", "grbl": "Grbl v1.1, realtime_cmds.md: codes above 127 are commands"},
                 "the manual's list of characters"))
def plain_characters(program, dialect):
    """A program consists of printable ASCII characters."""
    for block in program:
        for c in sorted(set(block.raw)):
            if not " " <= c <= "~":
                yield block.line, f"character {c!r}"


@rule({"grbl": "Grbl v1.1, doc/markdown/realtime_cmds.md: picked off the stream wherever they stand"})
def no_realtime_characters(program, dialect):
    """The characters ? ! ~ are commands to GRBL even inside a comment: status report, feed hold, cycle start."""
    for block in program:
        for c in "?!~":
            if c in block.raw:
                yield block.line, f"character {c} is a realtime command"


@rule({"fanuc": FANUC + ", Appendix: program code list; Program configuration: tape end", "haas": HAAS + ", Program structure: %"})
def no_tape_end_in_comments(program, dialect):
    """A comment does not hold %, which ends the record wherever it stands."""
    for block in program:
        if any("%" in comment for comment in block.comments):
            yield block.line, "% in a comment"


@rule({"fanuc": FANUC + ", EOB: shown as ;, the file has LF (Table 13.2 (a))", "haas": HAAS + ", Basic programming: ; is EOB"},
      certain=False)
def no_block_end_in_comments(program, dialect):
    """A comment does not hold the semicolon, by which these controls show and enter the end of a block."""
    for block in program:
        if any(";" in comment for comment in block.comments):
            yield block.line, "; in a comment"


@rule({"fanuc": FANUC + ", Appendix: program code list has capitals alone"}, certain=False)
def capitals(program, dialect):
    """Small letters are not in the ISO code table of older controls."""
    for block in program:
        if re.search("[a-z]", block.raw):
            yield block.line, "small letters"


@rule(everywhere({"linuxcnc": NGC + ", Comments", "mach3": MACH3 + ", Comments and messages", "haas": HAAS + ", ( ) comments",
                  "fanuc": FANUC + ", Program section: comment", "grbl": "Grbl v1.1, doc: comments"}, SIEMENS + ", Comments"))
def closed_comments(program, dialect):
    """A comment in round brackets ends on its line and holds no other bracket."""
    for block in program:
        if block.open_comment:
            yield block.line, "the comment does not end on its line"
        if dialect != "siemens" and any("(" in c for c in block.comments if "(" + c in block.raw):
            yield block.line, "a comment inside a comment"


@rule({"linuxcnc": NGC + ", Messages, Probe Logging, Logging, Debug, Print", "mach3": MACH3 + ", Comments and messages"})
def no_active_comments(program, dialect):
    """A comment does not start with a word that makes the control act: MSG, DEBUG, PRINT, LOG, PROBEOPEN."""
    for block in program:
        for comment in block.comments:
            if re.match(r"\s*(MSG|DEBUG|PRINT|LOG|LOGOPEN|LOGAPPEND|LOGCLOSE|PROBEOPEN|PROBECLOSE|PY|abort)\s*(,|$)", comment, re.I):
                yield block.line, f"active comment {comment.strip()[:20]}"


@rule(everywhere({"grbl": GRBL + " 1, 2", "linuxcnc": NGC + ", Word, Numbers", "siemens": SIEMENS + ", Structure of a block"},
                 "the manual's word format: an address and a number"))
def only_words(program, dialect):
    """Outside comments a line consists of letters with numbers."""
    for block in program:
        if block.rest:
            yield block.line, f"not a word: {block.rest}"
        for word in block.words:
            if not number(word.text):
                yield block.line, f"{word.letter} without a number"


LETTERS = {"linuxcnc": "ABCDFGHIJKLMNPQRSTUVWXYZ", "grbl": "FGIJKLMNPRSTXYZ", "mach3": "ABCDFGHIJKLMNOPQRSTXYZ",
           "fanuc": "ABCDFGHIJKLMNOPQRSTUVWXYZ", "haas": "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "siemens": "ABCDFGHIJKLMNPRSTUVWXYZ"}


@rule(everywhere({"grbl": GRBL + " 20", "linuxcnc": NGC + ", Word"}, "the manual's table of addresses"))
def known_letters(program, dialect):
    """The control knows the letter of every word."""
    for block in program:
        for word in block.words:
            if word.letter not in LETTERS[dialect]:
                yield block.line, f"address {word.letter}"


# ---- G and M words ----

def span(first, last):
    return set(range(first, last + 1))


COMMON = {0, 1, 2, 3, 4, 10, 17, 18, 19, 20, 21, 28, 30, 40, 41, 42, 43, 49, 53, 80, 90, 91, 92, 94} | span(54, 59)
KNOWN_G = {
    "linuxcnc": COMMON | {5, 7, 8, 33, 43.1, 43.2, 61, 61.1, 64, 93, 95, 96, 97, 98, 99, 90.1, 91.1, 92.1, 92.2, 92.3, 28.1, 30.1, 59.1,
                          59.2, 59.3, 38.2, 38.3, 38.4, 38.5, 52, 73, 76, 74, 84} | span(81, 89),
    "grbl": (COMMON - {41, 42, 43}) | {28.1, 30.1, 38.2, 38.3, 38.4, 38.5, 43.1, 61, 91.1, 92.1, 93},
    "mach3": COMMON | {12, 13, 15, 16, 31, 50, 51, 52, 61, 64, 68, 69, 70, 71, 73, 93, 95, 98, 99, 28.1, 90.1, 91.1, 92.1, 92.2,
                       92.3} | span(81, 89),
    "fanuc": COMMON | {9, 11, 15, 16, 22, 23, 27, 29, 31, 33, 37, 44, 45, 46, 47, 48, 50, 51, 52, 54.1, 60, 61, 62, 63, 64, 65, 66, 67,
                       68, 69, 73, 74, 76, 93, 95, 96, 97, 98, 99, 5.1, 7.1, 8, 5, 43.4, 43.5} | span(81, 89),
    "haas": COMMON | {9, 12, 13, 29, 31, 35, 36, 37, 44, 47, 50, 51, 52, 60, 61, 64, 65, 68, 69, 70, 71, 72, 73, 74, 76, 77, 93, 95, 98,
                      99, 150, 154, 187} | span(81, 89) | span(100, 129),
    "siemens": {0, 1, 2, 3, 4, 5, 7, 9, 17, 18, 19, 25, 26, 33, 34, 35, 40, 41, 42, 53, 54, 55, 56, 57, 60, 62, 63, 64, 70, 71, 74, 75,
                90, 91, 93, 94, 95, 96, 97, 110, 111, 112, 147, 148, 153, 247, 248, 347, 348, 331, 332, 340, 341, 450, 451, 460, 461,
                462, 500, 601, 602, 603, 621, 641, 642, 643, 644, 645, 700, 710, 810, 811, 820, 821} | span(505, 599),
}
KNOWN_M = {
    "linuxcnc": {0, 1, 2, 30, 60, 3, 4, 5, 6, 7, 8, 9, 19, 48, 49, 50, 51, 52, 53, 61} | span(62, 68) | span(70, 73) | span(98, 199),
    "grbl": {0, 1, 2, 30, 3, 4, 5, 7, 8, 9, 56},
    "mach3": {0, 1, 2, 30, 3, 4, 5, 6, 7, 8, 9, 47, 48, 49, 98, 99},
    "fanuc": {0, 1, 2, 30, 3, 4, 5, 6, 7, 8, 9, 19, 29, 98, 99},
    "haas": {0, 1, 2, 30, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 19, 31, 33, 83, 84, 88, 89, 97, 98, 99, 130},
    "siemens": {0, 1, 2, 17, 30, 3, 4, 5, 6, 7, 8, 9, 19, 40, 41, 42, 43, 44, 45, 70},
}


@rule(everywhere({"grbl": GRBL_WORDS + "; error 20", "linuxcnc": NGC_G, "mach3": MACH3 + ", G-code reference", "haas": HAAS + ", G-codes",
                  "siemens": SIEMENS + ", Tables: G commands"}, FANUC + ", Preparatory function: G code list"))
def known_g_words(program, dialect):
    """The control knows every G word."""
    for block in program:
        for g in block.codes("G"):
            if g not in KNOWN_G[dialect]:
                yield block.line, f"G{g:g} is unknown or refused"


@rule(everywhere({"grbl": GRBL_WORDS + "; error 20", "linuxcnc": "LinuxCNC, M-codes", "mach3": MACH3 + ", Built-in M-codes",
                  "haas": HAAS + ", M-codes", "siemens": SIEMENS + ", M functions"}, FANUC + ", Auxiliary function"))
def known_m_words(program, dialect):
    """The control knows every M word."""
    for block in program:
        for m in block.codes("M"):
            if m not in KNOWN_M[dialect]:
                yield block.line, f"M{m:g} is unknown or refused"


NGC_GROUPS = [{0, 1, 2, 3, 33, 38.2, 38.3, 38.4, 38.5, 73, 76, 80} | span(81, 89), {17, 18, 19}, {90, 91}, {90.1, 91.1}, {93, 94, 95},
              {20, 21}, {40, 41, 42}, {43, 43.1, 43.2, 49}, {98, 99}, set(range(54, 60)) | {59.1, 59.2, 59.3}, {61, 61.1, 64}, {96, 97},
              {7, 8}, {4, 10, 28, 30, 52, 53, 92, 92.1, 92.2, 92.3}]
FANUC_GROUPS = [{0, 1, 2, 3, 33}, {17, 18, 19}, {90, 91}, {93, 94, 95}, {20, 21}, {40, 41, 42}, {43, 44, 49}, {98, 99},
                set(range(54, 60)) | {54.1}, {61, 62, 63, 64}, {96, 97}, {73, 74, 76, 80} | span(81, 89), {50, 51}, {66, 67}, {68, 69}]
GROUPS = {
    "linuxcnc": NGC_GROUPS, "grbl": NGC_GROUPS, "mach3": NGC_GROUPS, "fanuc": FANUC_GROUPS, "haas": FANUC_GROUPS,
    "siemens": [{0, 1, 2, 3, 33, 331, 332}, {17, 18, 19}, {90, 91}, {93, 94, 95, 96, 97}, {70, 71, 700, 710}, {40, 41, 42},
                {500, 54, 55, 56, 57} | span(505, 599), {60, 64, 641, 642, 643, 644, 645}, {601, 602, 603}, {53, 153}, {4, 63, 74, 75}],
}


@rule(everywhere({"linuxcnc": NGC + ", Repeated Items, Modal Groups", "grbl": GRBL + " 21", "mach3": MACH3 + ", Modal groups",
                  "fanuc": FANUC + ", Preparatory function: only the last of a group would be valid", "haas": HAAS + ", G-codes: groups"},
                 SIEMENS + ", Tables: G groups"))
def one_g_word_of_a_group(program, dialect):
    """A block holds one G word of each group at most."""
    for block in program:
        for group in GROUPS[dialect]:
            found = [g for g in block.codes("G") if g in group]
            if len(found) > 1:
                yield block.line, "G words of one group: " + " ".join(f"G{g:g}" for g in found)


M_GROUPS = [{0, 1, 2, 30, 60}, {3, 4, 5}, {7, 9}, {8, 9}, {48, 49}]
MOST_M = {"linuxcnc": 4, "mach3": 4, "fanuc": 1, "haas": 1, "siemens": 5, "grbl": 99}


@rule(everywhere({"linuxcnc": NGC + ", Repeated Items: four M words", "grbl": GRBL + " 21", "mach3": MACH3 + ", Repeated items",
                  "fanuc": FANUC + ", Auxiliary function: one M code in a block (three with parameter 3404#7)",
                  "haas": HAAS + ", M-codes: one M code in a line"}, SIEMENS + ", M functions: five in a block"))
def number_of_m_words(program, dialect):
    """A block holds as many M words as the control takes, one of each group."""
    for block in program:
        codes = block.codes("M")
        if len(codes) > MOST_M[dialect]:
            yield block.line, f"{len(codes)} M words, {MOST_M[dialect]} are allowed"
        for group in M_GROUPS:
            if sum(m in group for m in codes) > 1:
                yield block.line, "M words of one group"


@rule(everywhere({"linuxcnc": NGC + ", Repeated Items", "grbl": GRBL + " 25", "mach3": MACH3 + ", Repeated items"},
                 "the manual's block format: an address once in a block"))
def one_word_of_a_letter(program, dialect):
    """A letter other than G and M stands once in a block."""
    for block in program:
        for letter in sorted({w.letter for w in block.words} - set("GM")):
            if len(block.all(letter)) > 1:
                yield block.line, f"{letter} stands {len(block.all(letter))} times"


def users(block):
    """The letters that some word of the block uses, beside axes, F, S, T, N, O, G and M."""
    used = "IJKRP" if block.arc else ""
    for code, letters in {4: "P", 10: "LPRIJK", 43: "H", 43.1: "", 64: "PQ", 41: "D", 42: "D", 5: "IJPQ", 33: "K", 52: "", 92: ""}.items():
        if code in block.codes("G"):
            used += letters
    if {73, 76, 81, 82, 83, 84, 85, 86, 87, 88, 89} & set(block.codes("G")) or {98, 62, 66, 67, 68, 61, 19, 56} & set(block.codes("M")):
        used += "RLPQIJKDE"
    return used


@rule({"linuxcnc": NGC_G + ": words with no G code that uses them", "grbl": GRBL + " 36", "mach3": NIST + ", 3.5",
       "fanuc": FANUC + ", Functions of each address", "haas": HAAS + ", address codes"})
def no_unused_words(program, dialect):
    """Every word belongs to a function of its block; I, J and K stand in arcs alone, never beside a rapid."""
    for block in program:
        used = users(block) + ("E" if 187 in block.codes("G") else "") + ("P" if 187 in block.codes("G") else "")
        for word in block.words:
            if word.letter in "IJKRPQLHDE" and word.letter not in used and not (dialect in ("fanuc", "haas") and word.letter in "HD"):
                yield block.line, f"nothing uses {word.letter}{word.text}"


@rule({"grbl": GRBL + " 24", "linuxcnc": NGC + ", Modal Groups", "mach3": MACH3 + ", Modal groups"})
def axis_words_used_once(program, dialect):
    """Two G words that both use the axis words do not share a block."""
    for block in program:
        codes = block.codes("G")
        if {0, 1, 2, 3} & set(codes) and {10, 28, 30, 52, 92} & set(codes):
            yield block.line, "two G words use the axes"


# ---- numbers ----

@rule({"fanuc": FANUC + ", Decimal point programming: without a point the unit is the least input increment (parameter 3401#0)",
       "haas": HAAS + ", Setting 77: without a point the last digit is 1/10000 inch or 1/1000 mm"})
def decimal_points(program, dialect):
    """Lengths have a decimal point."""
    for block in program:
        for word in block.words:
            if word.letter in "XYZIJKRQ" and "." not in word.text and not {4, 10} & set(block.codes("G")):
                yield block.line, f"{word.letter}{word.text} has no decimal point"


@rule({"haas": HAAS + ", F: without a point the last digit counts (Setting 77)", "fanuc": FANUC + ", Decimal point programming"},
      certain=False)
def decimal_points_of_feeds(program, dialect):
    """A feed with a decimal point does not depend on a setting."""
    for block in program:
        for word in block.all("F"):
            if "." not in word.text:
                yield block.line, f"F{word.text} has no decimal point"


@rule(everywhere({"fanuc": FANUC + ", alarm PS0007 ILLEGAL USE OF DECIMAL POINT", "grbl": GRBL + " 23"},
                 "the manual's table of addresses: whole numbers"))
def whole_numbers(program, dialect):
    """Numbers of tools, offsets, programs, lines and M words have no decimal point, and no sign."""
    for block in program:
        for word in block.words:
            if word.letter in "HDTMNO" and not word.text.isdigit():
                yield block.line, f"{word.letter}{word.text} is no whole number"
            if dialect == "fanuc" and word.letter in "SP" and not word.text.isdigit():
                yield block.line, f"{word.letter}{word.text} is no whole number"


@rule({"haas": HAAS + ", S: a whole number from 1 to 99999"}, certain=False)
def whole_speeds(program, dialect):
    """A speed is a whole number."""
    for block in program:
        for word in block.all("S"):
            if not word.text.isdigit():
                yield block.line, f"S{word.text} is no whole number"


DECIMALS = {"fanuc": {"mm": 3, "inch": 4}}


@rule({"fanuc": FANUC + ", Increment system IS-B: 0.001 mm, 0.0001 inch; digits beyond it are lost"})
def decimals_of_lengths(program, dialect):
    """Lengths have no more decimals than the increment of the control."""
    for block in program:
        for word in block.words:
            most = DECIMALS[dialect].get(block.modes.unit, 4)
            if word.letter in "XYZIJKR" and decimals(word.text) > most:
                yield block.line, f"{word.letter}{word.text} has more than {most} decimals"


@rule({"haas": HAAS + ", address codes X, I: four fractional positions in inches, three in mm; E: 0.0001 (not repeated for the NGC)"},
      certain=False)
def decimals_of_haas_lengths(program, dialect):
    """Lengths have three decimals in mm and four in inches."""
    for block in program:
        most = 3 if block.modes.unit == "mm" else 4
        for word in block.words:
            if word.letter in "XYZIJKRE" and decimals(word.text) > (4 if word.letter == "E" else most):
                yield block.line, f"{word.letter}{word.text} has more than {most} decimals"


@rule({"fanuc": FANUC + ", Range of command value: feed per minute in 1 mm/min or 0.01 inch/min (0i), finer on the 30i",
       "haas": HAAS + ", F: four fractional positions in inches, three in mm"}, certain=False)
def decimals_of_feeds(program, dialect):
    """A feed has no more decimals than the control keeps."""
    most = {"fanuc": {"mm": 0, "inch": 2}, "haas": {"mm": 3, "inch": 4}}[dialect]
    for block in program:
        for word in block.all("F"):
            if decimals(word.text) > most.get(block.modes.unit, 0):
                yield block.line, f"F{word.text} has more than {most.get(block.modes.unit, 0)} decimals"


LARGEST = {"fanuc": {"mm": 999999.999, "inch": 99999.9999}, "haas": {"mm": 39300, "inch": 15400}, "linuxcnc": {}, "mach3": {},
           "siemens": {"mm": 99999999, "inch": 99999999}, "grbl": {"mm": 99999, "inch": 9999}}


@rule({"fanuc": FANUC + ", Range of command value; alarm PS0003 TOO MANY DIGITS", "haas": HAAS + ", address code X",
       "siemens": SIEMENS + ", Addresses: ranges of values"})
def size_of_lengths(program, dialect):
    """Lengths stay within the range of the address, with eight digits at most on Fanuc."""
    for block in program:
        most = LARGEST[dialect].get(block.modes.unit)
        for word in (w for w in block.words if w.letter in "XYZIJKR" and number(w.text) and most):
            digits = len(re.sub(r"\D", "", word.text).lstrip("0"))
            if abs(word.value) > most or (dialect == "fanuc" and digits > 8):
                yield block.line, f"{word.letter}{word.text} is out of range"


@rule({"grbl": "Grbl v1.1, interface.md: values are 32-bit floats, seven digits count"}, certain=False)
def float_digits(program, dialect):
    """A number has no more significant digits than a 32-bit float keeps."""
    for block in program:
        for word in block.words:
            if len(re.sub(r"\D", "", word.text).lstrip("0")) > 7:
                yield block.line, f"{word.letter}{word.text} has more than seven digits"


FEEDS = {"fanuc": {"mm": (0.001, 240000), "inch": (0.0001, 9600)}, "haas": {"mm": (0.001, 50000), "inch": (0.0001, 2000)}}


@rule(everywhere({"grbl": GRBL + " 4, 22", "fanuc": FANUC + ", Range of command value; alarm PS0011 FEED ZERO"},
                 "the manual on F: above 0"))
def size_of_feeds(program, dialect):
    """A feed is above zero and within the range of F."""
    for block in program:
        low, high = FEEDS.get(dialect, {}).get(block.modes.unit, (1e-9, 1e9))
        for feed in [] if 4 in block.codes("G") else [block.value("F")] if block.has("F") else []:
            if feed is None or not low <= feed <= high:
                yield block.line, f"feed {feed} is out of range"


# ---- frame of the program ----

@rule({"fanuc": FANUC + ", Program configuration: tape start, program number, tape end", "haas": HAAS + ", Program structure"})
def percent_marks(program, dialect):
    """The first and the last line are a % mark, and no other."""
    marks = [i for i, block in enumerate(program) if block.mark]
    if marks != [0, len(program) - 1]:
        yield program[-1].line, f"% marks on {len(marks)} lines"


@rule({"linuxcnc": NGC + ", File Requirements", "mach3": MACH3 + ", Format of a program", "siemens": SIEMENS + ", NC program",
       "grbl": GRBL + " 1: % is no word"})
def percent_marks_in_pairs(program, dialect):
    """Where % marks are optional there are two or none; GRBL and Siemens take none."""
    marks = [block for block in program if block.mark]
    if marks and (len(marks) != 2 or dialect in ("grbl", "siemens")):
        yield marks[0].line, "% mark"


@rule({"fanuc": FANUC + ", Program number: O and four digits, 1 to 9999", "haas": HAAS + ", O: five digits at most"})
def program_number(program, dialect):
    """The program number stands on the line after %, and is the only O word."""
    found = [block for block in program if block.has("O")]
    if [block.line for block in found] != [2]:
        yield 2, "the program number is not on line 2 alone"
        return
    text = found[0].all("O")[0].text
    if not text.isdigit() or int(text) == 0 or len(text) > (4 if dialect == "fanuc" else 5):
        yield 2, f"O{text} is no program number"


@rule({"fanuc": FANUC + ", Program number: 8000 to 9999 can be locked (parameters 3202#0, #4)", "haas": HAAS + ", Setting 23: 9000 on"},
      certain=False)
def free_program_number(program, dialect):
    """The program number is not one of those that a parameter locks."""
    for block in program:
        if (block.value("O") or 0) >= (8000 if dialect == "fanuc" else 9000):
            yield block.line, "the program number may be locked"


ENDS = {"linuxcnc": {2, 30}, "grbl": {2, 30}, "mach3": {2, 30}, "fanuc": {2, 30}, "haas": {2, 30}, "siemens": {2, 17, 30}}


@rule(everywhere({"linuxcnc": NGC + ", File Requirements", "grbl": GRBL_WORDS + ": program mode", "siemens": SIEMENS + ", End of program"},
                 "the manual on M02 and M30"))
def end_of_program(program, dialect):
    """M2 or M30 ends the program, and nothing follows but a % mark."""
    ends = [i for i, block in enumerate(program) if ENDS[dialect] & set(block.codes("M"))]
    if not ends:
        yield program[-1].line, "no end of the program"
    elif any(block.words or block.names for block in program[ends[0] + 1:]):
        yield program[ends[0] + 1].line, "words after the end of the program"


LARGEST_N = {"linuxcnc": 99999999, "grbl": 9999999, "mach3": 99999, "fanuc": 99999, "haas": 99999, "siemens": 99999999}


@rule(everywhere({"grbl": GRBL + " 27: 1 to 9,999,999", "fanuc": FANUC + ", Sequence number: 1 to 99999", "mach3": MACH3 + ", Line number",
                  "linuxcnc": NGC + ", Line Number", "siemens": SIEMENS + ", Block number"}, HAAS + ", N: 0 to 99999"))
def line_numbers(program, dialect):
    """A line number is the first word of its line, whole and in range."""
    for block in program:
        for i, word in enumerate(block.words):
            if word.letter == "N" and (i > 0 or not word.text.isdigit() or not 1 <= int(word.text) <= LARGEST_N[dialect]):
                yield block.line, f"line number N{word.text}"


@rule(everywhere({"linuxcnc": NGC + ", Line Number: normal practice"}, "the manual on sequence numbers: any order works, search wants one"),
      certain=False)
def rising_line_numbers(program, dialect):
    """Line numbers rise, so that a search finds the right one."""
    last = 0
    for block in program:
        n = block.value("N")
        if n is not None and n <= last:
            yield block.line, f"N{n:g} after N{last:g}"
        last = n or last


# ---- modes ----

@rule(everywhere({"linuxcnc": NGC_G + ", G20 G21: a preamble states the unit"},
                 "the manual on G20/G21 or G700/G710: the unit outlasts a program"))
def unit_before_motion(program, dialect):
    """The unit is stated before the first length."""
    for block in program:
        if block.axes() and block.modes.unit is None:
            yield block.line, "a length before its unit"
            return


@rule({"siemens": SIEMENS + ", G70/G71/G700/G710: G70 and G71 leave the unit of F as it is"})
def unit_of_feeds(program, dialect):
    """The unit holds for feeds, too: G700 or G710."""
    for block in program:
        if {70, 71} & set(block.codes("G")):
            yield block.line, "G70 and G71 do not switch the unit of F"


@rule({"linuxcnc": NGC + ", Order of Execution: F comes before the unit"})
def no_feed_beside_the_unit(program, dialect):
    """F does not stand beside G20 or G21, where it would count in the unit before."""
    for block in program:
        if block.has("F") and {20, 21} & set(block.codes("G")):
            yield block.line, "F beside G20 or G21"


@rule(everywhere({}, "the manual on G90/G91, G17-G19: they outlast a program"))
def modes_before_motion(program, dialect):
    """G90 or G91 and the plane are stated before the first move, and radius compensation is off."""
    for block in program:
        if block.moves:
            for name, value in (("G90 or G91", block.modes.distance), ("G17", block.modes.plane), ("G40", block.modes.compensation)):
                if value is None:
                    yield block.line, f"no {name} before the first move"
            return


@rule({"mach3": MACH3 + ", G90.1 G91.1: the initial mode is a setting", "grbl": GRBL_WORDS + ": G91.1 alone"})
def centres_before_arcs(program, dialect):
    """G91.1 states that arc centres count from the start of the arc."""
    for block in program:
        if block.arc and block.modes.centres != 91.1:
            yield block.line, "an arc without G91.1"
            return


@rule(everywhere({"linuxcnc": NGC_G + ", G1: no feed rate", "grbl": GRBL + " 22", "fanuc": FANUC + ", alarm PS0011 FEED ZERO (COMMAND)",
                  "siemens": SIEMENS + ", F; alarm 10860"}, "the manual on G1: F is needed"))
def feed_before_feed_moves(program, dialect):
    """A feed is in force at every feed move."""
    for block in program:
        if block.feeds and not block.modes.feed:
            yield block.line, "a feed move without F"
            return


@rule(everywhere({"linuxcnc": NGC + ", Feed Rate Mode: G93 wants F on every line", "grbl": GRBL + " 22"}, "the manual on G94"))
def feed_per_minute(program, dialect):
    """Feeds are per minute (G94)."""
    for block in program:
        if block.feeds and block.modes.feed_mode != 94:
            yield block.line, f"a feed move under G{block.modes.feed_mode:g}"
            return


@rule(everywhere({"linuxcnc": "LinuxCNC, M-codes, M3: S is needed"}, "the manual on S and M3"))
def speed_before_spindle(program, dialect):
    """S above zero stands before M3 or beside it."""
    for block in program:
        if {3, 4} & set(block.codes("M")) and not block.modes.speed:
            yield block.line, "M3 without S"


@rule(everywhere({}, "good practice of every manual: no feed with a standing spindle"))
def spindle_before_feed_moves(program, dialect):
    """The spindle turns at every feed move."""
    for block in program:
        if block.feeds and not block.modes.spindle:
            yield block.line, "a feed move with the spindle off"
            return


@rule(everywhere({}, "the manual on G41 G42: off unless an offset is set up"))
def compensation_off(program, dialect):
    """Radius compensation stays off, as the program holds centre paths."""
    for block in program:
        if {41, 42} & set(block.codes("G")):
            yield block.line, "radius compensation"


# ---- tools ----

@rule({d: s for d, s in everywhere({"siemens": SIEMENS + ", T and M6"}, "the manual on T and M6").items() if d != "grbl"})
def tool_before_change(program, dialect):
    """T stands before M6 or beside it."""
    for block in program:
        if 6 in block.codes("M") and block.modes.tool is None:
            yield block.line, "M6 without T"


@rule({"fanuc": FANUC + ", Tool length offset (G43, G44, G49)", "haas": HAAS + ", G43", "linuxcnc": NGC_G + ", G43",
       "mach3": MACH3 + ", G43", "siemens": SIEMENS + ", Tool offset: D; D0 is none"})
def length_before_z(program, dialect):
    """The length of the tool is in force at every move along Z in work coordinates."""
    for block in program:
        if block.moves and "Z" in block.axes() and not (block.machine or block.reference) and not block.modes.length:
            yield block.line, "Z without the length of the tool"
            return


@rule({"fanuc": FANUC + ", G43 H: 0 to 400", "haas": HAAS + ", G43 H: 1 to 200", "linuxcnc": NGC_G + ", G43 H", "mach3": MACH3 + ", G43 H"})
def length_has_its_offset(program, dialect):
    """G43 names its offset, and it is not 0."""
    for block in program:
        if 43 in block.codes("G") and not block.value("H"):
            yield block.line, "G43 without H"


@rule({"haas": HAAS + ", Setting 15: H & T agreement", "fanuc": FANUC + ", usual practice"})
def offset_of_the_tool(program, dialect):
    """The number of the offset is that of the tool."""
    for block in program:
        if 43 in block.codes("G") and block.has("H") and block.modes.tool not in (None, block.value("H")):
            yield block.line, f"H{block.value('H'):g} with T{block.modes.tool:g}"


@rule({"fanuc": FANUC + ", Reference position return: tool length offset should be cancelled before G28"}, certain=False)
def length_off_before_reference(program, dialect):
    """G49 stands before G28, which should run without the offsets of the tool."""
    for block in program:
        if {28, 30} & set(block.codes("G")) and block.modes.length != 0:
            yield block.line, "G28 while G43 is, or may be, in force"


# ---- machine coordinates ----

@rule({"grbl": GRBL + " 30", "linuxcnc": NGC_G + ", G53", "mach3": MACH3 + ", G53"})
def machine_moves_are_straight(program, dialect):
    """G53 stands with G0 or G1 in force."""
    for block in program:
        if 53 in block.codes("G") and block.axes() and block.modes.motion not in (0, 1):
            yield block.line, "G53 without G0 or G1"


@rule({"fanuc": FANUC + ", G53 is ignored in G91", "haas": HAAS + ", G53", "siemens": SIEMENS + ", SUPA"})
def machine_moves_are_absolute(program, dialect):
    """A move in machine coordinates stands in G90."""
    for block in program:
        if block.machine and block.axes() and block.modes.distance == 91:
            yield block.line, "machine coordinates in G91"


@rule({"siemens": SIEMENS + ", SUPA: a modal path command is in force; approach with G0"})
def machine_moves_are_rapid(program, dialect):
    """SUPA stands in a block with G0 and axes."""
    for block in program:
        if block.named("SUPA") and not (0 in block.codes("G") and block.axes()):
            yield block.line, "SUPA without G0 and axes"


@rule({d: "the manual on G28: the axes go through the place in the block" for d in ("fanuc", "haas", "linuxcnc", "mach3", "grbl")})
def reference_goes_straight_up(program, dialect):
    """G28 stands in G91 with Z0, so that it goes up without a way through the part."""
    for block in program:
        if {28, 30} & set(block.codes("G")) and not (block.modes.distance == 91 and block.axes() == {"Z": 0}):
            yield block.line, "G28 goes through a place of its own"


# ---- arcs ----

@rule(everywhere({"linuxcnc": NGC_G + ", Center Format Arcs: illegal offset", "grbl": GRBL + " 36", "mach3": NIST + ", 3.5.3",
                  "siemens": SIEMENS + ", Circular interpolation: I J K of the plane"}, "the manual on G2 and G3: I J K of the plane"))
def centre_of_the_plane(program, dialect):
    """The centre has words of the plane in force alone, one at least."""
    for block in program:
        if not block.arc or block.has("R") or block.modes.plane is None:
            continue
        allowed = PLANES[block.modes.plane][2:]
        given = [c for c in "IJK" if block.has(c)]
        if not given:
            yield block.line, "an arc without a centre"
        if set(given) - set(allowed):
            yield block.line, f"centre {' '.join(given)} in G{block.modes.plane}"


@rule({"grbl": GRBL + " 32", "mach3": MACH3 + ", Center format arc: X and Y both omitted"})
def end_of_the_arc(program, dialect):
    """An arc names an axis of its plane, a full circle, too."""
    for block in program:
        if block.arc and block.modes.plane and not set(PLANES[block.modes.plane][:2]) & set(block.axes()):
            yield block.line, "an arc without an end"


@rule(everywhere({}, "the manual on G2 and G3: the start is a known place"))
def start_of_the_arc(program, dialect):
    """The start of an arc is known in work coordinates."""
    for block in program:
        if block.arc and block.modes.plane and None in [block.start[a] for a in PLANES[block.modes.plane][:2]]:
            yield block.line, "an arc from a place that is not stated"


def radius_slack(dialect, unit, radius):
    """By how much the radii at both ends may differ, in the unit of the program."""
    inch = unit == "inch"
    if dialect in ("linuxcnc", "grbl"):
        low, high = (0.0005, 0.05) if inch and dialect == "linuxcnc" else (0.005 / 25.4, 0.5 / 25.4) if inch else (0.005, 0.5)
        return min(high, max(low, 0.001 * radius))
    if dialect == "mach3":
        return 0.0002 if inch else 0.002
    if dialect == "siemens":
        return max(0.01 / 25.4 if inch else 0.01, 0.001 * radius)
    return 0.0010 if inch else 0.010


def radius_breaches(program, dialect):
    for block in program:
        radii = arc_radii(block) if block.arc else None
        if radii is None:
            continue
        slack = radius_slack(dialect, block.modes.unit, radii[0])
        if min(radii) <= 0:
            yield block.line, "an arc of radius 0"
        elif abs(radii[0] - radii[1]) > slack + 1e-9:
            yield block.line, f"radii {radii[0]:.5f} and {radii[1]:.5f} differ by more than {slack:.5f}"


@rule({"linuxcnc": NGC_G + ", Center Format Arcs: 0.005 mm and 0.1 %", "grbl": GRBL + " 33; gnea/grbl issue 897: 0.005 mm and 0.1 %",
       "mach3": MACH3 + ", Center format arc; " + NIST + ", 3.5.3.2: 0.002 mm, 0.0002 inch",
       "siemens": SIEMENS + "; MD21000 CIRCLE_ERROR_CONST 0.01 mm, MD21010 CIRCLE_ERROR_FACTOR 0.001; alarm 14040",
       "haas": HAAS + ", alarm 304: 0.010 mm, 0.0010 inch"})
def radii_agree(program, dialect):
    """The radius at the end of an arc is that at its start, within the slack of the control."""
    yield from radius_breaches(program, dialect)


@rule({"fanuc": FANUC + ", alarm PS0020 OVER TOLERANCE OF RADIUS: parameter 3410, taken as 0.010 mm here"}, certain=False)
def radii_agree_by_parameter(program, dialect):
    """The radius at the end of an arc is that at its start, within what a machine's parameter allows."""
    yield from radius_breaches(program, dialect)


@rule(everywhere({}, "the manual on G2 and G3: R of nearly whole or half circles is ill-conditioned"), certain=False)
def arcs_by_centre(program, dialect):
    """An arc states its centre, not its radius."""
    for block in program:
        if block.arc and block.has("R"):
            yield block.line, "an arc by radius"


# ---- words of one control ----

@rule({"linuxcnc": NGC_G + ", G64"})
def path_tolerance(program, dialect):
    """G64 states a tolerance above zero; bare, the deviation has no limit."""
    for block in program:
        if 64 in block.codes("G") and not (block.value("P") or 0) > 0:
            yield block.line, "G64 without P"
        if 64 in block.codes("G") and (block.value("Q") or 0) < 0:
            yield block.line, "Q below zero"


@rule({"fanuc": FANUC + ", Dwell: P in ms without a point", "linuxcnc": NGC_G + ", G4: P in seconds", "grbl": GRBL + " 28",
       "haas": HAAS + ", G04 P", "mach3": MACH3 + ", G4 P", "siemens": SIEMENS + ", Dwell: F or S in a block of its own"})
def dwell(program, dialect):
    """G4 states its time, with no motion beside it."""
    for block in program:
        if 4 in block.codes("G"):
            letters = "FS" if dialect == "siemens" else "PX" if dialect == "fanuc" else "P"
            if not any((block.value(c) or -1) >= 0 for c in letters):
                yield block.line, "G4 without its time"


@rule({"mach3": MACH3 + ", G4: seconds or milliseconds by a setting"}, certain=False)
def dwell_unit(program, dialect):
    """The unit of a dwell depends on the configuration."""
    for block in program:
        if 4 in block.codes("G"):
            yield block.line, "G4 P may be seconds or milliseconds"


@rule({"grbl": "Grbl v1.1, realtime_cmds.md, Toggle mist coolant: M7 is an option of the build, off by default"}, certain=False)
def mist_is_an_option(program, dialect):
    """M7 works on a GRBL that was built with it; others answer error 20."""
    for block in program:
        if 7 in block.codes("M"):
            yield block.line, "M7"


@rule({"haas": HAAS + ", G187; Setting 85; E 0.0001 to 0.25 inch, 0.001 to 2.5 mm; P1 to P3"})
def smoothness(program, dialect):
    """G187 stands alone in its block, with P from 1 to 3 and E within its range."""
    for block in program:
        if 187 not in block.codes("G"):
            continue
        low, high = (0.0001, 0.25) if block.modes.unit == "inch" else (0.001, 2.5)
        if {w.letter for w in block.words} - set("GPEN") or len(block.codes("G")) > 1:
            yield block.line, "G187 beside other words"
        if block.has("E") and not low <= block.value("E") <= high:
            yield block.line, f"E{block.value('E'):g} is out of range"
        if block.has("P") and block.value("P") not in (1, 2, 3):
            yield block.line, "P is not 1, 2 or 3"


@rule({"siemens": SIEMENS_JOB + ", CYCLE832(S_TOL, S_TOLM, S_OTOL): S_OTOL must be programmed, 1 on 3-axis machines"})
def high_speed_settings(program, dialect):
    """CYCLE832 stands alone, with a tolerance above zero (0 in the deselection), the type 0 to 4, and 1 as third argument."""
    for block in program:
        for arguments in block.named("CYCLE832"):
            if any(w.letter != "N" for w in block.words):
                yield block.line, "CYCLE832 beside other words"
            parts = [a.strip() for a in arguments.split(",")] if arguments else []
            if len(parts) != 3 or not all(number(a) for a in parts):
                yield block.line, "CYCLE832 wants three numbers"
            elif float(parts[1]) not in (0, 1, 2, 3, 4) or float(parts[2]) != 1 or (float(parts[0]) > 0) != (float(parts[1]) > 0):
                yield block.line, f"CYCLE832({arguments})"


@rule({"siemens": SIEMENS + ", Names of cycles; brackets"})
def known_names(program, dialect):
    """Brackets close, and the control knows the cycles."""
    for block in program:
        code = block.raw.split(";")[0]
        if code.count("(") != code.count(")"):
            yield block.line, "brackets do not close"
        for name, _ in block.names:
            if name not in ("SUPA", "MSG", "CYCLE832"):
                yield block.line, f"cycle {name}"


def check_text(text, dialect):
    """All breaches of a program, in the order of its lines."""
    if dialect == "heidenhain":
        found = [Breach(*b) for b in klartext_rules.check_text(text)]
    else:
        program = read_program(text, dialect)
        found = [Breach(line, r.name, message, r.sources[dialect], r.certain) for r in RULES if dialect in r.sources and program
                 for line, message in r.function(program, dialect)]
        if not program:
            found = [Breach(1, "end-of-program", "an empty program", "-", True)]
    return sorted(found, key=lambda b: (b.line, b.rule))


def read_file(path):
    """The text of a file as the control gets it: bytes, without conversion of line ends."""
    return pathlib.Path(path).read_bytes().decode("latin-1")


def main(arguments):
    if len(arguments) < 2 or arguments[0] not in ISO + ("heidenhain",):
        print(__doc__, file=sys.stderr)
        return 2
    failed = False
    for path in arguments[1:]:
        for breach in check_text(read_file(path), arguments[0]):
            failed = failed or breach.certain
            print(f"{path}:{breach.line}: {'' if breach.certain else 'warning: '}{breach.rule}: {breach.text} [{breach.source}]")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

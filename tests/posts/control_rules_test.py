#!/usr/bin/env python3
"""Shows that every rule of control_rules.py bites: a small good program of each control passes, and a planted fault does not.

The good programs are written after the manuals, not taken from the posts of Patchmill.
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import control_rules  # noqa: E402
import klartext_rules  # noqa: E402

LINUXCNC = """(a slot with a rounded corner)
G17 G21 G40 G49 G54 G80 G90 G91.1 G94
G64 P0.01 Q0
G53 G0 Z0
T1 M6
S8000 M3
G43 H1 G0 X0 Y0 Z20
N10 G1 Z-1 F300
N20 X10 F900
N30 G3 X15 Y5 I0 J5
N40 G0 Z20
G4 P0.5
M5
G53 G0 Z0
M2
"""
GRBL = """(a slot with a rounded corner)
G17 G21 G40 G49 G54 G80 G90 G91.1 G94
G53 G0 Z-2
S8000 M3
G4 P2
G0 X0 Y0
Z20
N10 G1 Z-1 F300
N20 X10 F900
N30 G3 X15 Y5 I0 J5
G0 Z20
M5
M30
"""
FANUC = """%
O1234
(SLOT WITH A ROUNDED CORNER)
G17 G21 G40 G49 G80 G90 G94
G91 G28 Z0.
G90 G54
T1 M6
S8000 M3
G0 X0. Y0.
G43 H1 Z20.
N10 G1 Z-1. F300.
N20 X10. F900.
N30 G3 X15. Y5. I0. J5.
G0 Z20.
G4 P500
M5
G49
G91 G28 Z0.
M30
%
"""
HAAS = """%
O01234
(SLOT WITH A ROUNDED CORNER)
G17 G21 G40 G49 G80 G90 G94
G187 P3 E0.01
G53 G0 Z0.
T1 M6
S8000 M3
G0 G54 X0. Y0.
G43 H1 Z20.
N10 G1 Z-1. F300.
N20 X10. F900.
N30 G3 X15. Y5. I0. J5.
G0 Z20.
M5
G53 G0 Z0.
M30
%
"""
SIEMENS = """; a slot with a rounded corner
G17 G40 G54 G64 G90 G94 G710
CYCLE832(0.01,1,1)
G0 SUPA Z0 D0
T1
M6
D1 S8000 M3
G0 X0 Y0
Z20
N10 G1 Z-1 F300
N20 X10 F900
N30 G3 X15 Y5 I0 J5
G0 Z20
G4 F0.5
M5
CYCLE832(0,0,1)
M30
"""
MACH3 = LINUXCNC.replace("G64 P0.01 Q0\n", "G61\n").replace("G4 P0.5\n", "")
HEIDENHAIN = """0 BEGIN PGM SLOT MM
1 ; a slot with a rounded corner
2 TOOL CALL 1 Z S8000
3 L Z+0 R0 FMAX M91
4 CYCL DEF 32.0 TOLERANCE
5 CYCL DEF 32.1 T0.01
6 L X+0 Y+0 R0 FMAX M3
7 L Z+20 FMAX
8 L Z-1 F300
9 L X+10 F900
10 CC X+10 Y+5
11 C X+15 Y+5 DR+
12 L Z+20 FMAX M5
13 M30
14 END PGM SLOT MM
"""
GOOD = {"linuxcnc": LINUXCNC, "grbl": GRBL, "fanuc": FANUC, "haas": HAAS, "siemens": SIEMENS, "mach3": MACH3, "heidenhain": HEIDENHAIN}

# Control, rule, what is replaced in the good program, and by what.
FAULTS = [
    ("grbl", "line-length", "a slot with", "a slot with" + "x" * 80),
    ("linuxcnc", "line-length", "a slot with", "a slot with" + "x" * 260),
    ("mach3", "line-length", "a slot with", "a slot with" + "x" * 260),
    ("siemens", "line-length", "a slot with", "a slot with" + "x" * 500),
    ("fanuc", "readable-line-length", "SLOT WITH", "SLOT WITH" + "X" * 120),
    ("linuxcnc", "plain-characters", "a slot", "a sl\u00f6t"),
    ("grbl", "plain-characters", "X10", "X\t10"),
    ("grbl", "no-realtime-characters", "a slot", "a slot!"),
    ("fanuc", "no-tape-end-in-comments", "ROUNDED", "50% ROUNDED"),
    ("haas", "no-block-end-in-comments", "ROUNDED", "; ROUNDED"),
    ("fanuc", "capitals", "ROUNDED", "rounded"),
    ("linuxcnc", "closed-comments", "corner)", "corner"),
    ("mach3", "closed-comments", "a slot with", "a (slot) with"),
    ("linuxcnc", "no-active-comments", "(a slot", "(MSG,a slot"),
    ("mach3", "no-active-comments", "(a slot", "(msg, a slot"),
    ("grbl", "only-words", "X10 ", "X "),
    ("siemens", "only-words", "X10 ", "X10-1 "),
    ("grbl", "known-letters", "N20 X10", "N20 X10 A4"),
    ("grbl", "known-g-words", "G49 ", "G43 "),
    ("mach3", "known-g-words", "G61", "G61.1"),
    ("fanuc", "known-g-words", "G94", "G94 G187"),
    ("haas", "known-g-words", "G94", "G94 G91.1"),
    ("siemens", "known-g-words", "G710", "G710 G21"),
    ("siemens", "known-g-words", "G710", "G710 G80"),
    ("grbl", "known-m-words", "S8000 M3", "T1 M6\nS8000 M3"),
    ("linuxcnc", "one-g-word-of-a-group", "G64 P", "G61 G64 P"),
    ("fanuc", "one-g-word-of-a-group", "G91 G28", "G90 G91 G28"),
    ("siemens", "one-g-word-of-a-group", "G64 ", "G60 G64 "),
    ("fanuc", "number-of-m-words", "S8000 M3", "S8000 M3 M8"),
    ("haas", "number-of-m-words", "S8000 M3", "S8000 M3 M8"),
    ("linuxcnc", "number-of-m-words", "M3", "M3 M5"),
    ("grbl", "one-word-of-a-letter", "X10 ", "X9 X10 "),
    ("grbl", "no-unused-words", "X10 ", "X10 P1 "),
    ("linuxcnc", "no-unused-words", "G0 Z20", "G0 Z20 I1"),
    ("grbl", "axis-words-used-once", "G0 Z20", "G0 G28 Z20"),
    ("fanuc", "decimal-points", "X10.", "X10"),
    ("haas", "decimal-points", "X10.", "X10"),
    ("haas", "decimal-points-of-feeds", "F900.", "F900"),
    ("fanuc", "whole-numbers", "H1", "H1."),
    ("fanuc", "whole-numbers", "P500", "P500."),
    ("fanuc", "whole-numbers", "S8000", "S8000.5"),
    ("haas", "whole-speeds", "S8000", "S8000.5"),
    ("grbl", "whole-numbers", "N20", "N20.5"),
    ("fanuc", "decimals-of-lengths", "X10.", "X10.0001"),
    ("haas", "decimals-of-haas-lengths", "X10.", "X10.0001"),
    ("fanuc", "decimals-of-feeds", "F900.", "F900.5"),
    ("fanuc", "size-of-lengths", "X10.", "X123456.789"),
    ("siemens", "size-of-lengths", "X10 ", "X999999999 "),
    ("grbl", "float-digits", "X10 ", "X10.000001 "),
    ("grbl", "size-of-feeds", "F900", "F0"),
    ("fanuc", "size-of-feeds", "F900.", "F900000."),
    ("fanuc", "percent-marks", "%\nO", "O"),
    ("haas", "percent-marks", "M30\n%\n", "M30\n"),
    ("linuxcnc", "percent-marks-in-pairs", "(a slot", "%\n(a slot"),
    ("grbl", "percent-marks-in-pairs", "(a slot", "%\n(a slot"),
    ("fanuc", "program-number", "O1234", "O12345"),
    ("haas", "program-number", "O01234\n", ""),
    ("fanuc", "free-program-number", "O1234", "O9001"),
    ("linuxcnc", "end-of-program", "M2\n", ""),
    ("fanuc", "end-of-program", "M30\n", "M30\nG0 X1.\n"),
    ("grbl", "line-numbers", "N20", "N0"),
    ("fanuc", "line-numbers", "N20", "N100000"),
    ("siemens", "line-numbers", "N20 X10", "X10 N20"),
    ("linuxcnc", "rising-line-numbers", "N30", "N20"),
    ("linuxcnc", "unit-before-motion", "G21 ", ""),
    ("siemens", "unit-before-motion", " G710", ""),
    ("siemens", "unit-of-feeds", "G710", "G71"),
    ("linuxcnc", "no-feed-beside-the-unit", "G21", "G21 F100"),
    ("mach3", "modes-before-motion", "G90 ", ""),
    ("fanuc", "modes-before-motion", "G17 ", ""),
    ("mach3", "centres-before-arcs", "G91.1 ", ""),
    ("grbl", "feed-before-feed-moves", " F300", ""),
    ("linuxcnc", "feed-per-minute", "G94", "G93"),
    ("siemens", "speed-before-spindle", "S8000 ", ""),
    ("linuxcnc", "spindle-before-feed-moves", " M3", ""),
    ("fanuc", "spindle-before-feed-moves", "T1 M6\nS8000 M3", "S8000 M3\nT1 M6"),
    ("haas", "compensation-off", "N20 X10.", "N20 G41 D1 X10."),
    ("haas", "tool-before-change", "T1 M6", "M6"),
    ("fanuc", "length-before-z", "G43 H1 ", ""),
    ("siemens", "length-before-z", "D1 ", ""),
    ("linuxcnc", "length-before-z", "G43 H1 ", ""),
    ("haas", "length-has-its-offset", "H1 ", ""),
    ("haas", "offset-of-the-tool", "H1", "H2"),
    ("fanuc", "length-off-before-reference", "G49\n", ""),
    ("grbl", "machine-moves-are-straight", "G53 G0", "G53 G2"),
    ("haas", "machine-moves-are-absolute", "G53 G0", "G91 G53 G0"),
    ("siemens", "machine-moves-are-rapid", "G0 SUPA", "SUPA"),
    ("fanuc", "reference-goes-straight-up", "G91 G28 Z0.", "G28 Z0."),
    ("grbl", "centre-of-the-plane", "I0 J5", "I0 K5"),
    ("siemens", "centre-of-the-plane", " I0 J5", ""),
    ("mach3", "end-of-the-arc", "X15 Y5 ", ""),
    ("linuxcnc", "start-of-the-arc", "X0 Y0 ", ""),
    ("linuxcnc", "radii-agree", "X15 Y5", "X15.0052 Y5"),
    ("grbl", "radii-agree", "X15 Y5", "X15.0052 Y5"),
    ("mach3", "radii-agree", "X15 Y5", "X15.0022 Y5"),
    ("siemens", "radii-agree", "X15 Y5", "X15.011 Y5"),
    ("haas", "radii-agree", "X15. Y5.", "X15.011 Y5."),
    ("fanuc", "radii-agree-by-parameter", "X15. Y5.", "X15.011 Y5."),
    ("grbl", "arcs-by-centre", "I0 J5", "R5"),
    ("linuxcnc", "path-tolerance", "G64 P0.01 Q0", "G64"),
    ("grbl", "dwell", "G4 P2", "G4"),
    ("siemens", "dwell", "G4 F0.5", "G4"),
    ("mach3", "dwell-unit", "M5", "G4 P2\nM5"),
    ("grbl", "mist-is-an-option", "M5", "M7\nM5"),
    ("haas", "smoothness", "E0.01", "E3."),
    ("haas", "smoothness", "G187 P3", "G187 G0 P3"),
    ("siemens", "high-speed-settings", "0.01,1,1", "0.01,1"),
    ("siemens", "high-speed-settings", "0.01,1,1", "0.01,1,0"),
    ("siemens", "high-speed-settings", "0.01,1,1", "0,1,1"),
    ("siemens", "known-names", "CYCLE832(0.01,1,1)", "CYCLE999(0.01,1,1)"),
    ("siemens", "known-names", "0.01,1,1)", "0.01,1,1"),
    ("heidenhain", "block-numbers", "\n7 ", "\n8 "),
    ("heidenhain", "begin-and-end", "END PGM SLOT MM", "END PGM SLOT INCH"),
    ("heidenhain", "begin-and-end", "END PGM SLOT", "END PGM SLIT"),
    ("heidenhain", "end-of-program", "13 M30", "13 M5"),
    ("heidenhain", "plain-characters", "a slot", "a sl\u00f6t"),
    ("heidenhain", "comment-form", "corner", "corner ~"),
    ("heidenhain", "line-length", "corner", "corner" + "x" * 128),
    ("heidenhain", "known-blocks", "9 L", "9 G1"),
    ("heidenhain", "known-words", "X+10 F900", "X+10 K4 F900"),
    ("heidenhain", "size-of-lengths", "X+10 F", "X+10.00001 F"),
    ("heidenhain", "size-of-lengths", "X+10 F", "X+100000 F"),
    ("heidenhain", "decimals-of-inches", None, None),
    ("heidenhain", "size-of-feeds", "F900", "F900.1234"),
    ("heidenhain", "unit-of-feeds", None, None),
    ("heidenhain", "feed-before-feed-moves", " F300", ""),
    ("heidenhain", "number-of-m-words", "M3\n", "M3 M8 M13\n"),
    ("heidenhain", "known-m-words", "M3\n", "M333\n"),
    ("heidenhain", "compensation-off", "L X+10", "L X+10 RL"),
    ("heidenhain", "compensation-off", "L Z+0 R0", "L Z+0"),
    ("heidenhain", "tool-call", " S8000", ""),
    ("heidenhain", "tool-call", "TOOL CALL 1 Z S8000", "TOOL CALL 1 X S8000"),
    ("heidenhain", "spindle-before-feed-moves", " M3\n", "\n"),
    ("heidenhain", "machine-moves", "FMAX M91", "F100 M91"),
    ("heidenhain", "centre-form", "CC X+10 Y+5", "CC X+10 Z+5"),
    ("heidenhain", "arc-form", " DR+", ""),
    ("heidenhain", "arc-form", "C X+15 Y+5", "C X+15 Y+5 Z-2"),
    ("heidenhain", "no-rapid-arcs", "DR+", "DR+ FMAX"),
    ("heidenhain", "radii-agree", "C X+15", "C X+15.017"),
    ("heidenhain", "radii-agree-by-parameter", "C X+15", "C X+15.006"),
    ("heidenhain", "tolerance-cycle", "T0.01", "T0"),
    ("heidenhain", "tolerance-cycle", "5 CYCL DEF 32.1 T0.01", "5 L Z+0 FMAX M91"),
    ("heidenhain", "tolerance-reset-form", " T0.01", ""),
    ("heidenhain", "tolerance-range", "T0.01", "T0.0001"),
]
INCH_FAULTS = {"decimals-of-inches": ("X+10 F", "X+10.00001 F"), "unit-of-feeds": ("; a slot", "; feeds inch per minute; a slot")}


def planted(dialect, rule, old, new):
    """The good program with its fault; faults of programs in inches need one in inches."""
    text = GOOD[dialect]
    if old is None:
        text = text.replace("SLOT MM", "SLOT INCH").replace("T0.01", "T0.001")
        old, new = INCH_FAULTS[rule]
    assert old in text, (dialect, rule, old)
    return text.replace(old, new, 1)


class ControlRulesTest(unittest.TestCase):
    def test_good_programs_pass_without_a_warning(self):
        for dialect, text in GOOD.items():
            self.assertEqual([], control_rules.check_text(text, dialect), dialect)

    def test_good_programs_pass_in_inches(self):
        for dialect, text in GOOD.items():
            inch = text.replace("G21", "G20").replace("G710", "G700").replace("SLOT MM", "SLOT INCH")
            self.assertEqual([], [b for b in control_rules.check_text(inch, dialect) if b.certain], dialect)

    def test_every_planted_fault_is_found(self):
        for dialect, rule, old, new in FAULTS:
            with self.subTest(dialect=dialect, rule=rule, new=new):
                found = control_rules.check_text(planted(dialect, rule, old, new), dialect)
                self.assertIn(rule, [b.rule for b in found])

    def test_every_rule_has_a_planted_fault(self):
        bitten = {(dialect == "heidenhain", rule) for dialect, rule, _, _ in FAULTS}
        rules = {(False, r.name) for r in control_rules.RULES} | {(True, r[0]) for r in klartext_rules.RULES}
        self.assertEqual(rules, bitten)

    def test_every_rule_has_a_sentence_and_a_source(self):
        for r in control_rules.RULES:
            self.assertTrue(r.function.__doc__.strip().endswith("."), r.name)
            self.assertTrue(all(r.sources.values()), r.name)
        for name, source, _, function in klartext_rules.RULES:
            self.assertTrue(function.__doc__.strip().endswith(".") and source, name)

    def test_arcs_in_other_planes(self):
        arc = "G18 G2 X15 Z4 I5 K0\n"  # from X10 Z-1 around X15 Z-1: clockwise seen from +Y
        for dialect in ("linuxcnc", "grbl", "mach3", "siemens"):
            text = GOOD[dialect].replace("N30 G3 X15 Y5 I0 J5\n", arc)
            self.assertEqual([], control_rules.check_text(text, dialect), dialect)
            wrong = text.replace("Z4 I5", "Z4.2 I5")
            self.assertIn("radii-agree", [b.rule for b in control_rules.check_text(wrong, dialect)], dialect)

    def test_lines_are_named(self):
        found = control_rules.check_text(GRBL.replace("N20 X10", "N20 X10 A1"), "grbl")
        self.assertEqual([9], [b.line for b in found])


if __name__ == "__main__":
    unittest.main()

"""Programs of any source against a body: good ones, and those that gouge."""
import pathlib
import re

import patchmill as pm
from patchmill_freecad import service, verification
from support import InDocument, command_line, report_view

KNOWN = ("--tool-diameter", 6, "--scallop", 0.2, "--tolerance", 0.05, "--zero", "origin")


class Verify(InDocument):
    def setUp(self):
        super().setUp()
        self.part = self.filleted_box()
        self.made = self.operation(self.part)

    def verified(self, program, **values):
        with report_view() as report:
            made = verification.create(self.part, program)
            made.Scallop, made.Tolerance, made.ProgramZero = 0.2, 0.05, "Origin"
            for name, value in values.items():
                setattr(made, name, value)
            self.document.recompute()
        self.assertNotIn("Traceback", report.text)
        return made, report

    def gouging(self, depth_mm):
        """The program, lower by so much."""
        text = pathlib.Path(self.made.WrittenFile).read_text()
        file = self.folder / "lower.ngc"
        file.write_text(re.sub(r"(?<=Z)-?[\d.]+", lambda z: f"{float(z[0]) - depth_mm:.4f}", text))
        return file

    def test_a_good_program(self):
        made, report = self.verified(self.made.WrittenFile)
        self.assertEqual(made.Outcome, self.made.Outcome)
        self.assertNotIn("do not run", report.text)
        of_package = service.client().verify(
            self.made.ModelFile, pathlib.Path(self.made.WrittenFile), pm.ball(6, plunge_feed_mm_per_min=0), tolerance_mm=0.05,
            scallop_mm=0.2, setup=pm.Setup(zero_anchor=pm.ZeroAnchor.ORIGIN))
        self.assertAlmostEqual(made.LargestGouge.Value, of_package.report.max_gouge_mm, places=9)
        self.assertEqual(len([c for c in made.Path.Commands if c.Name in ("G0", "G1", "G2", "G3")]), len(of_package.path) + 1)
        command_line("verify", self.made.ModelFile, self.made.WrittenFile, *KNOWN)

    def test_a_program_that_gouges(self):
        program = self.gouging(0.7)
        made, report = self.verified(program, ReportFile=str(self.folder / "report.json"))
        self.assertEqual(made.Outcome, "VERIFICATION_FAILED")
        self.assertGreater(made.LargestGouge.Value, 0.6)
        self.assertTrue(any(line.startswith("ERROR ") and "GOUGE" in line for line in made.Findings), made.Findings)
        self.assertRegex(report.text, r"Patchmill: Verify part: ERROR \w*GOUGE\w*")
        self.assertIn(f"do not run {program}", report.text)
        self.assertTrue((self.folder / "report.json").is_file())
        said = command_line("verify", self.made.ModelFile, program, *KNOWN, status=1)
        self.assertIn("GOUGE", said)

    def test_the_path_is_that_of_the_file(self):
        made, _ = self.verified(self.gouging(0.7))
        good, _ = self.verified(self.made.WrittenFile)
        lowest = [min(c.Parameters["Z"] for c in one.Path.Commands if c.Name == "G1") for one in (made, good)]
        self.assertAlmostEqual(lowest[0], lowest[1] - 0.7, places=3)

    def test_another_control(self):
        self.made.Dialect, self.made.ProgramFile = "heidenhain", str(self.folder / "part.h")
        self.document.recompute()
        made, _ = self.verified(self.folder / "part.h", Dialect="heidenhain")
        self.assertEqual(made.Outcome, self.made.Outcome)

    def test_a_program_of_freecads_own_post_processor(self):
        from PathScripts.post import linuxcnc_post

        text = linuxcnc_post.export([self.made], "-", "--no-show-editor")
        file = self.folder / "posted.ngc"
        file.write_text(text)
        made, _ = self.verified(file, AssumeExactPath=True, CheckFinish=False)
        self.assertLess(made.LargestGouge.Value, 0.06, made.Findings)
        self.assertGreater(len(made.Path.Commands), 50, made.Outcome)

    def test_a_file_that_changes_is_judged_again(self):
        program = self.gouging(0.0)
        made, _ = self.verified(program)
        self.assertEqual(made.Outcome, self.made.Outcome)
        self.gouging(0.7)
        made.touch()
        self.document.recompute()
        self.assertEqual(made.Outcome, "VERIFICATION_FAILED")

    def test_errors_name_the_file(self):
        for program, words in (("", "ProgramFile is empty"), (self.folder / "none.ngc", "none.ngc")):
            made, report = self.verified(program)
            self.assertIn(words, made.Outcome)
            self.assertIn(words, report.text)
        (self.folder / "words.ngc").write_text("G1 X1 Q@\nM2\n")
        made, report = self.verified(self.folder / "words.ngc")
        self.assertTrue(made.Outcome.startswith("FAILED"), made.Outcome)
        self.assertIn("line", made.Outcome)

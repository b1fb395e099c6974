"""From a body of FreeCAD to a program: bytes, path, faces, recompute, files."""
import json
import math
import pathlib

import FreeCAD as App
import patchmill as pm
from patchmill_freecad import service
from support import QUICK, InDocument, command_line, quick, report_view


class SameBytes(InDocument):
    def check(self, made, *words, job=None, **arguments):
        model = made.ModelFile
        ours = self.program(made)
        self.assertEqual(ours, self.of_command_line(model, *QUICK, *words))
        of_package = service.client().mill(model, job or quick(), setup=arguments.pop("setup", pm.Setup(zero_anchor=pm.ZeroAnchor.ORIGIN)),
                                           **arguments)
        self.assertEqual(ours, of_package.program_bytes)
        self.assertGreater(len(ours), 1000)
        return of_package

    def test_a_filleted_box(self):
        made = self.operation(self.filleted_box())
        of_package = self.check(made)
        self.assertEqual(made.Outcome, of_package.outcome.name)
        self.assertAlmostEqual(made.LargestGouge.Value, of_package.report.max_gouge_mm, places=6)

    def test_a_lofted_surface(self):
        self.check(self.operation(self.loft()))

    def test_options_of_every_group(self):
        made = self.operation(
            self.filleted_box(), ToolDiameter="8 mm", ToolNumber=7, Feed="900 mm/min", PlungeFeed="250 mm/min", SpindleSpeed=9000,
            CoolantMode="Flood", Stickout=60, Holder=["20,28", "25,40,50"], StockToLeave=0.1, SteepAngle=50, Direction="Either", Bend=0,
            LimitFloor=True, Floor=2, StockKind="Block", BlockMargin=3, Allowance=0.3, AcceptDepth=15, Clearance=12,
            LeadRadius=1, LinkFeed="700 mm/min", Dialect="heidenhain", Arcs=False, ProgramFile=str(self.folder / "own.h"))
        tool = pm.ball(8, number=7, feed_mm_per_min=900, plunge_feed_mm_per_min=250, spindle_rpm=9000, coolant=pm.Coolant.FLOOD,
                       stickout_mm=60, holder=[pm.HolderSegment(length_mm=20, lower_diameter_mm=28, upper_diameter_mm=28),
                                               pm.HolderSegment(length_mm=25, lower_diameter_mm=40, upper_diameter_mm=50)])
        job = pm.Operation(
            tool=tool, scallop_mm=0.2, tolerance_mm=0.05, stock_to_leave_mm=0.1, steep_angle_deg=50, zigzag_bend_deg=0, accept_depth_mm=15,
            contour_direction=pm.CutDirection.EITHER, heights=pm.Heights(floor_z_mm=2, clearance_above_mm=12), leads=pm.Leads(radius_mm=1),
            feeds=pm.Feeds(link_mm_per_min=700))
        self.check(
            made, "--tool-diameter", 8, "--tool-number", 7, "--feed", 900, "--plunge-feed", 250, "--spindle", 9000, "--coolant", "flood",
            "--stickout", 60, "--holder", "20,28 25,40,50", "--leave", 0.1, "--steep-angle", 50, "--direction", "either", "--bend", 0,
            "--floor", 2, "--stock", "block,3", "--allowance", 0.3, "--accept-depth", 15, "--clearance", 12, "--lead-radius", 1,
            "--link-feed", 700, "--post", "heidenhain", "--no-arcs", job=job, post=pm.Post(dialect="heidenhain", arcs=False),
            setup=pm.Setup(zero_anchor=pm.ZeroAnchor.ORIGIN, stock=pm.Stock(allowance_mm=0.3, block=pm.BlockStock(margin_mm=3))))
        self.assertEqual(made.WrittenFile, str(self.folder / "own.h"))

    def test_a_body_that_lies_elsewhere_in_the_document(self):
        part = self.filleted_box()
        group = self.document.addObject("App::Part", "Assembly")
        group.addObject(part)
        group.Placement.Base = App.Vector(100, 0, 5)
        made = self.operation(part)
        self.check(made)
        self.assertGreater(min(c.Parameters["X"] for c in made.Path.Commands if "X" in c.Parameters), 90)


class TreeAndFiles(InDocument):
    def test_the_path_has_the_moves_of_the_program(self):
        made = self.operation(self.filleted_box())
        result = service.client().mill(made.ModelFile, quick(), setup=pm.Setup(zero_anchor=pm.ZeroAnchor.ORIGIN))
        header, commands = made.Path.Commands[:2], made.Path.Commands[4:]  # the first place is two commands
        self.assertEqual([c.Name for c in header], ["M6", "M3"])
        names = {0: "G1", 1: ("G2", "G3"), 2: "G1", 3: "G1"}
        planes, at = set(), -1
        for k in range(1, len(result.path)):
            # A move is one command; an arc in another plane than XY is several, the last of which ends there.
            tip, plane = [float(v) for v in result.path.tip_mm[k]], int(result.path.arc_plane[k])
            first = at = at + 1
            while plane > 1 and [commands[at].Parameters[axis] for axis in "XYZ"] != tip:
                self.assertLess(self.off_arc(commands[at], result.path, k), 1e-6)
                at += 1
            self.assertEqual([commands[at].Parameters[axis] for axis in "XYZ"], tip)
            planes.add(plane)
            for command in commands[first:at + 1]:
                is_rapid = result.path.kind[k] == pm.MoveKind.RAPID
                self.assertIn(command.Name, "G0" if is_rapid else names[plane])
                if not is_rapid:
                    self.assertAlmostEqual(command.Parameters["F"] * 60, float(result.path.feed_mm_per_min[k]), places=2)
        self.assertEqual(at, len(commands) - 1)
        self.assertLessEqual({0, 1, 2}, planes)

    def off_arc(self, command, path, k):
        first, second = {2: ("Z", "X"), 3: ("Y", "Z")}[int(path.arc_plane[k])]
        center = dict(zip("XYZ", path.arc_center_mm[k]))
        start = dict(zip("XYZ", path.tip_mm[k - 1]))
        radii = [math.hypot(p[first] - center[first], p[second] - center[second]) for p in (start, command.Parameters)]
        return abs(radii[0] - radii[1])

    def test_arcs_have_the_radius_of_both_ends(self):
        made = self.operation(self.filleted_box())
        here, arcs = None, 0
        for command in made.Path.Commands[2:]:
            words = command.Parameters
            if command.Name in ("G2", "G3"):
                center = (here["X"] + words["I"], here["Y"] + words["J"])
                radii = [math.hypot(p["X"] - center[0], p["Y"] - center[1]) for p in (here, words)]
                self.assertAlmostEqual(radii[0], radii[1], delta=0.001)
                arcs += 1
            here = {**(here or {}), **words}
        self.assertGreater(arcs, 3)

    def test_the_path_lies_on_a_turned_part_with_another_zero(self):
        part = self.filleted_box()
        part.Placement = App.Placement(App.Vector(10, 0, 0), App.Rotation(App.Vector(1, 0, 0), -90))  # what was up points to +Y
        made = self.operation(part, UpAxis="Y", ProgramZero="Top centre")
        ends = [made.Placement.multVec(App.Vector(*[c.Parameters[a] for a in "XYZ"])) for c in made.Path.Commands if c.Name == "G1"]
        box = part.Shape.BoundBox
        lowest = min(ends, key=lambda p: p.y)
        self.assertGreaterEqual(lowest.y, box.YMin - 0.1)
        cutting = [p for p in ends if p.y < box.YMax + 0.5]
        self.assertAlmostEqual(min(p.x for p in cutting), box.XMin, delta=6)
        self.assertAlmostEqual(max(p.x for p in cutting), box.XMax, delta=6)
        self.assertAlmostEqual(max(p.z for p in cutting), box.ZMax, delta=6)
        self.assertEqual(self.program(made), self.of_command_line(made.ModelFile, *QUICK[:4], "--zero", "top-center", "--up", "y"))

    def test_faces_alone(self):
        part = self.filleted_box()
        top = max(range(len(part.Shape.Faces)), key=lambda k: part.Shape.Faces[k].CenterOfMass.z) + 1
        made = self.operation(part, [f"Face{top}"])
        self.assertEqual(self.program(made), self.of_command_line(made.ModelFile, *QUICK, "--only", f"f{top}"))
        heights = [c.Parameters["Z"] for c in made.Path.Commands if c.Name == "G1"]
        whole = [c.Parameters["Z"] for c in self.operation(part).Path.Commands if c.Name == "G1"]
        self.assertGreater(min(heights), min(whole) + 1)  # the fillets stay

    def test_faces_to_avoid(self):
        part = self.filleted_box()
        top = max(range(len(part.Shape.Faces)), key=lambda k: part.Shape.Faces[k].CenterOfMass.z) + 1
        made = self.operation(part, Avoid=(part, [f"Face{top}"]), AvoidMargin=1)
        self.assertEqual(self.program(made), self.of_command_line(made.ModelFile, *QUICK, "--avoid", f"f{top}", "--avoid-margin", 1))

    def test_boundary_and_clamp(self):
        part = self.filleted_box()
        import Part

        ring = self.document.addObject("Part::Feature", "Ring")
        ring.Shape = Part.makePolygon([App.Vector(*p) for p in ((5, 5, 0), (45, 5, 0), (45, 35, 0), (5, 35, 0), (5, 5, 0))])
        clamp = self.document.addObject("Part::Box", "Clamp")
        clamp.Length, clamp.Width, clamp.Height, clamp.Placement.Base = 10, 10, 20, App.Vector(-5, -5, 0)
        made = self.operation(part, Boundary=ring, Clamps=[clamp])
        self.assertEqual(self.program(made), self.of_command_line(
            made.ModelFile, *QUICK, "--boundary", "5,5 45,5 45,35 5,35", "--obstacle", "Clamp=20: -5,-5 5,-5 5,5 -5,5"))

    def test_recompute_after_a_property_changes(self):
        made = self.operation(self.filleted_box())
        before, count = self.program(made), len(made.Path.Commands)
        made.Scallop = "0.4 mm"
        self.document.recompute()
        after = self.program(made)
        self.assertNotEqual(before, after)
        self.assertLess(len(made.Path.Commands), count)
        self.assertEqual(after, self.of_command_line(made.ModelFile, "--scallop", 0.4, *QUICK[2:]))

    def test_recompute_after_the_body_changes(self):
        part = self.filleted_box()
        made = self.operation(part)
        self.document.Box.Height = 15
        self.document.recompute()
        self.assertEqual(self.program(made), self.of_command_line(made.ModelFile, *QUICK))
        self.assertGreater(max(c.Parameters["Z"] for c in made.Path.Commands if c.Name == "G1"), 14.9)

    def test_nothing_is_computed_twice(self):
        made = self.operation(self.filleted_box())
        file = pathlib.Path(made.WrittenFile)
        written = file.stat().st_mtime_ns
        made.touch()
        self.document.recompute()
        self.assertEqual(file.stat().st_mtime_ns, written)
        file.unlink()
        made.touch()
        self.document.recompute()
        self.assertTrue(file.is_file())

    def test_save_and_reopen(self):
        made = self.operation(self.filleted_box(), StockKind="Allowance", Detail=0.25)
        name, outcome, gcode, program = made.Name, made.Outcome, made.Path.toGCode(), self.program(made)
        self.document.save()
        file = self.document.FileName
        App.closeDocument(self.document.Name)
        self.document = App.openDocument(file)
        again = self.document.getObject(name)
        self.assertEqual((again.Outcome, again.Path.toGCode(), again.Detail, again.StockKind), (outcome, gcode, 0.25, "Allowance"))
        self.assertEqual(type(again.Proxy).__name__, "Operation")
        again.touch()
        self.document.recompute()
        self.assertEqual(self.program(again), program)
        pathlib.Path(again.WrittenFile).unlink()
        again.touch()
        self.document.recompute()
        # FreeCAD saves shapes with fewer bits than they have: the last digits of the program may be others.
        self.assertEqual(self.program(again), self.of_command_line(again.ModelFile, *QUICK, "--allowance", 0.5, "--detail", 0.25))
        again.Scallop = 0.4
        self.document.recompute()
        self.assertNotEqual(self.program(again), program)

    def test_report_page_and_inches(self):
        made = self.operation(self.filleted_box(), ReportFile=str(self.folder / "report.json"), PageFile=str(self.folder / "part.html"),
                              Inch=True)
        self.assertEqual(json.loads((self.folder / "report.json").read_text())["outcome"], f"OUTCOME_{made.Outcome}")
        self.assertIn("<html", (self.folder / "part.html").read_text()[:500])
        self.assertIn(b"G20", self.program(made))

    def test_the_command_line_says_the_program_is_good(self):
        made = self.operation(self.filleted_box())
        command_line("verify", made.ModelFile, made.WrittenFile, "--tool-diameter", 6, "--scallop", 0.2, "--tolerance", 0.05, "--zero",
                     "origin", "--plunge-feed", 400)


class Errors(InDocument):
    def fails(self, made, *words):
        self.assertTrue(made.Outcome.startswith("FAILED"), made.Outcome)
        self.assertEqual(len(made.Path.Commands), 0)
        for word in words:
            self.assertIn(word, made.Outcome)

    def changed(self, made, **values):
        with report_view() as report:
            for name, value in values.items():
                setattr(made, name, value)
            self.document.recompute()
        self.assertNotIn("Traceback", report.text)
        return report

    def test_wrong_values_are_named_by_their_properties(self):
        made = self.operation(self.filleted_box())
        report = self.changed(made, Scallop=9, Detail=3)
        self.fails(made, "Scallop", "ball radius = 3", "Detail", "[0, 1]")
        self.assertIn("Patchmill: Mill part: Scallop", report.text)
        self.assertIn("of an earlier state", report.text)
        self.changed(made, Scallop=0.2, Detail=0.5)
        self.assertTrue(made.Outcome.startswith("COMPLETE"))

    def test_values_that_are_refused_before_the_call(self):
        made = self.operation(self.filleted_box())
        for values, words in (({"ToolDiameter": 0}, ("ToolDiameter", "above 0")), ({"Holder": ["x"]}, ("Holder[0]", "'x'")),
                              ({"StockKind": "Job"}, ("StockKind", "job of FreeCAD")),
                              ({"PostFile": "/nothing.post"}, ("PostFile", "nothing.post"))):
            before = {name: getattr(made, name) for name in values}
            self.changed(made, **values)
            self.fails(made, *words)
            self.changed(made, **before)
        self.assertTrue(made.Outcome.startswith("COMPLETE"), made.Outcome)

    def test_wrong_links(self):
        part = self.filleted_box()
        made = self.operation(part)
        self.changed(made, Part=(part, ["Edge1"]))
        self.fails(made, "Part has 'Edge1'", "faces only")
        self.changed(made, Part=None)
        self.fails(made, "Part is empty")
        self.changed(made, Part=(part, []), Clamps=[part], ProgramZero="Top centre")
        self.fails(made, "Clamps needs", "Top centre")
        self.changed(made, Clamps=[], ProgramZero="Origin", ToolController=part)
        self.fails(made, "ToolController is 'part'")

    def test_a_file_that_cannot_be_written(self):
        made = self.operation(self.filleted_box())
        self.changed(made, ProgramFile=str(self.folder / "none" / "part.ngc"))
        self.fails(made, "ProgramFile", "cannot be written")

    def test_a_file_of_somebody_else_is_never_replaced(self):
        made = self.operation(self.filleted_box())
        for name in ("ProgramFile", "ReportFile", "PageFile", "ModelFile"):
            with self.subTest(name):
                theirs = self.folder / f"{name}.txt"
                theirs.write_text("a list of tools\n")
                self.changed(made, **{name: str(theirs)})
                self.fails(made, name, "no result of Patchmill")
                self.assertEqual(theirs.read_text(), "a list of tools\n")
                # A result of before is replaced.
                ours = self.folder / f"{name}.ours"
                for _ in range(2):
                    self.changed(made, **{name: str(ours)}, Scallop=made.Scallop * 1.1)
                    self.assertTrue(ours.is_file(), made.Outcome)

    def test_a_job_without_a_program(self):
        made = self.operation(self.filleted_box())
        self.changed(made, StockKind="Block", BlockMargin=4, StockIsWhole=True)
        self.fails(made, "NEEDS_ROUGHING")
        self.assertTrue(any("NEEDS_ROUGHING" in line for line in made.Findings) or "NEEDS_ROUGHING" in made.Outcome)

    def test_findings_are_in_the_report_view_with_their_severity(self):
        with report_view() as report:
            made = self.operation(self.filleted_box(), ProgramZero="Not stated")
        warned = [line for line in report.text.splitlines() if line.startswith("Patchmill: Mill part: WARNING ")]
        self.assertTrue(any("DEFAULT_CUTTING_DATA" in line for line in warned), report.text)
        self.assertEqual(len(warned), sum(line.startswith("WARNING") for line in made.Findings))
        self.assertIn("largest gouge", report.text)

    def test_cancel_ends_the_job(self):
        class Indicator:
            steps = 0

            def start(self, text, steps):
                pass

            def next(self, can_abort):
                Indicator.steps += 1
                raise App.Base.FreeCADAbort("abort")

            def stop(self):
                pass

        made = self.operation(self.filleted_box())
        real, App.Base.ProgressIndicator = App.Base.ProgressIndicator, Indicator
        try:
            with report_view() as report:
                made.Scallop = 0.01
                self.document.recompute()
        finally:
            App.Base.ProgressIndicator = real
        self.fails(made, "cancelled")
        self.assertEqual(Indicator.steps, 1)
        self.assertNotIn("Traceback", report.text)

    def test_a_server_that_is_not_there(self):
        made = self.operation(self.filleted_box())
        preferences = App.ParamGet(service.PREFERENCES)
        preferences.SetString("Program", "/nowhere/patchmilld")
        try:
            self.changed(made, Scallop=0.3)
        finally:
            preferences.RemString("Program")
        self.fails(made, "/nowhere/patchmilld", "Preferences")

"""Operations in a job of FreeCAD's own Path workbench: tool, feeds and stock from there, and its post
processors."""
import pathlib

import FreeCAD as App
import PathScripts.PathJob as PathJob
import PathScripts.PathStock as PathStock
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController
from patchmill_freecad import cam_job, operation, selection
from support import InDocument, report_view

BALL = pathlib.Path("/usr/share/freecad/Mod/Path/Tools/Bit/6mm_Ball_End.fctb")


class InJob(InDocument):
    def setUp(self):
        super().setUp()
        self.part = self.filleted_box()
        self.job = PathJob.Create("Job", [self.part])
        self.job.Label = "job"
        self.document.recompute()

    def add_ball(self):
        bit = PathToolBit.Factory.CreateFrom(str(BALL))
        controller = PathToolController.Create("TC: ball", bit, 7)
        self.job.Proxy.addToolController(controller)
        controller.HorizFeed, controller.VertFeed, controller.SpindleSpeed = "900 mm/min", "250 mm/min", 9000.0
        self.document.recompute()
        return controller

    def made(self, part=None):
        made = operation.create(part or self.part, job=self.job)
        made.Scallop, made.Tolerance = 0.2, 0.05
        made.AcceptDepth = 15  # the fillets on the outer border go down into the stock beside the part
        made.ModelFile = str(self.folder / "part.step")
        return made

    def test_tool_stock_and_bytes(self):
        controller = self.add_ball()
        made = self.made()
        self.assertEqual((made.ToolController, made.StockKind, made.ProgramZero, made.WorkOffset), (controller, "Job", "Origin", "G54"))
        self.assertIn(made, self.job.Operations.Group)
        self.document.recompute()
        box = self.job.Stock.Shape.BoundBox
        outline = f"outline: {box.XMin},{box.YMin} {box.XMax},{box.YMin} {box.XMax},{box.YMax} {box.XMin},{box.YMax}"
        self.assertLess(box.XMin, -0.5)
        self.assertEqual(self.program(made), self.of_command_line(
            made.ModelFile, "--scallop", 0.2, "--tolerance", 0.05, "--zero", "origin", "--tool", BALL, "--tool-number", 7, "--feed", 900,
            "--plunge-feed", 250, "--spindle", 9000, "--stock", outline, "--stock-top", box.ZMax, "--allowance", 0.5, "--accept-depth", 15))

    def test_a_round_stock(self):
        self.add_ball()
        self.document.removeObject(self.job.Stock.Name)
        place = App.Placement(App.Vector(25, 20, 0), App.Rotation())
        self.job.Stock = PathStock.CreateCylinder(self.job, radius=40, height=14, placement=place)
        self.document.recompute()
        found = cam_job.stock_of(self.job, (0.0, 0.0, 0.0))
        self.assertAlmostEqual(found.diameter_mm, 80)
        self.assertAlmostEqual(found.top_mm, 14)
        made = self.made()
        self.document.recompute()
        self.assertEqual(self.program(made), self.of_command_line(
            made.ModelFile, "--scallop", 0.2, "--tolerance", 0.05, "--zero", "origin", "--tool", BALL, "--tool-number", 7, "--feed",
            900, "--plunge-feed", 250, "--spindle", 9000, "--stock", "cylinder,80,25,20", "--stock-top", 14, "--allowance", 0.5,
            "--accept-depth", 15))

    def test_the_job_is_found_from_body_model_and_operation(self):
        self.assertIs(cam_job.job_of(self.part), self.job)
        self.assertIs(cam_job.job_of(self.job.Model.Group[0]), self.job)
        made = self.made()
        self.assertIs(cam_job.job_of(made), self.job)
        self.assertIsNone(cam_job.job_of(self.document.addObject("Part::Box", "Alone")))

    def test_a_selected_job_stands_for_its_model(self):
        class One:
            Object, SubElementNames = self.job, ()

        found = selection.selected([One])
        self.assertEqual((found.job, found.bodies), (self.job, [(self.job.Model.Group[0], [])]))
        self.add_ball()
        made = self.made(found.bodies[0][0])
        self.document.recompute()
        self.assertTrue(made.Outcome.startswith("COMPLETE"), made.Outcome)

    def test_a_tool_without_a_ball_end(self):
        with report_view() as report:
            made = self.made()
        self.assertIsNone(made.ToolController)
        self.assertIn("no tool with a ball end", report.text)
        made.ToolController = self.job.Tools.Group[0]
        with report_view() as report:
            self.document.recompute()
        self.assertIn("'endmill'", made.Outcome)
        self.assertIn("ballend", report.text)

    def test_freecads_post_processor_writes_the_moves(self):
        controller = self.add_ball()
        made = self.made()
        self.document.recompute()
        from PathScripts.post import linuxcnc_post

        text = linuxcnc_post.export([controller, made], "-", "--no-show-editor")
        self.assertIn("M3 S9000", text)
        self.assertRegex(text, r"G1 .*F900")
        self.assertGreater(text.count("\n"), len(made.Path.Commands) - 5)

    def test_an_inactive_operation(self):
        self.add_ball()
        made = self.made()
        self.document.recompute()
        self.assertGreater(len(made.Path.Commands), 50)
        with report_view() as report:
            made.Active = False
            self.document.recompute()
        self.assertEqual((len(made.Path.Commands), made.Outcome), (0, "INACTIVE"))
        self.assertIn("of an earlier state", report.text)

"""Check of surfaces, regions, and fairing."""
import csv

import FreeCAD as App
import numpy as np
import Part
from patchmill_freecad import analysis, fairing
from support import InDocument, command_line, report_view


class Check(InDocument):
    def test_a_good_body(self):
        with report_view() as report:
            result = analysis.check(self.filleted_box(), 6)
        self.assertTrue(result.is_usable)
        self.assertIn("Patchmill: part: usable: ", report.text)
        self.assertIn("10 faces", report.text)

    def test_a_gap_between_two_surfaces(self):
        sheets = [Part.makePlane(20, 20), Part.makePlane(20, 20, App.Vector(20.0005, 0, 0))]
        body = self.document.addObject("Part::Feature", "Gap")
        body.Shape = Part.makeCompound(sheets)
        result = analysis.check(body)
        self.assertEqual(result.face_count, 2)
        self.assertEqual(result.open_edge_count + 2 * result.joined_edge_count, 8)

    def test_a_round_that_is_narrower_than_the_ball(self):
        box = self.document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = 40, 40, 20
        cut = self.document.addObject("Part::Cylinder", "Groove")
        cut.Radius, cut.Height, cut.Placement = 2, 40, App.Placement(App.Vector(20, 0, 20), App.Rotation(App.Vector(1, 0, 0), -90))
        part = self.document.addObject("Part::Cut", "Part")
        part.Base, part.Tool = box, cut
        self.document.recompute()
        with report_view() as report:
            result = analysis.check(part, 6)
        self.assertAlmostEqual(result.min_concave_radius_mm, 2, places=3)
        self.assertIn("smallest concave radius: 2 mm", report.text)


class Regions(InDocument):
    def test_borders_lie_on_the_part(self):
        part = self.filleted_box()
        part.Placement.Base = App.Vector(30, 0, 0)
        made = self.operation(part, ProgramZero="Top centre")
        with report_view() as report:
            regions = analysis.regions(made)
        self.assertIn(" regions: part", report.text)
        listed = command_line("regions", made.ModelFile, "-o", self.folder / "regions.json", "--scallop", 0.2, "--tolerance", 0.05,
                              "--zero", "top-center")
        self.assertIsNotNone(listed)
        self.assertGreater(len(regions.Shape.Edges), 3)
        box, whole = regions.Shape.BoundBox, part.Shape.BoundBox
        self.assertGreaterEqual(box.XMin, whole.XMin - 0.1)
        self.assertLessEqual(box.XMax, whole.XMax + 0.1)
        for vertex in regions.Shape.Vertexes[::7]:
            self.assertLess(part.Shape.distToShape(Part.Vertex(vertex.Point))[0], 0.1)


class Fair(InDocument):
    def wire(self):
        rng = np.random.default_rng(5)
        self.points = [App.Vector(5.0 * k, 20 * np.sin(k / 4) + rng.normal(0, 0.2), 0) for k in range(15)]
        wire = self.document.addObject("Part::Feature", "Measured")
        wire.Shape = Part.makePolygon(self.points)
        return wire

    def test_the_points_are_those_of_the_command_line(self):
        made = fairing.create(self.wire())
        made.Band, made.Iterations = "0.5 mm", 30
        self.document.recompute()
        source, faired = self.folder / "points.csv", self.folder / "faired.csv"
        source.write_text("".join(f"{p.x!r},{p.y!r},{p.z!r}\n" for p in self.points))
        command_line("fair", source, "-o", faired, "--band", 0.5, "--iterations", 30)
        expected = [[float(word) for word in row] for row in list(csv.reader(faired.open()))[1:]]  # below the heading
        curve = made.Shape.Edges[0]
        self.assertEqual(len(expected), len(self.points))
        for point in expected:
            self.assertLess(curve.distToShape(Part.Vertex(App.Vector(*point, *[0.0] * (3 - len(point)))))[0], 1e-6)
        self.assertGreater(made.LargestMove.Value, 0.05)

    def test_it_follows_its_source_and_a_lock(self):
        source = self.wire()
        made = fairing.create(source, locked=[7])
        self.document.recompute()
        self.assertLess(made.Shape.distToShape(Part.Vertex(self.points[7]))[0], 1e-6)
        before = made.LargestMove.Value
        moved = [App.Vector(p.x, p.y + (3 if k == 4 else 0), p.z) for k, p in enumerate(self.points)]
        source.Shape = Part.makePolygon(moved)
        self.document.recompute()
        self.assertNotEqual(made.LargestMove.Value, before)

    def test_what_is_no_measured_curve(self):
        short = self.document.addObject("Part::Feature", "Short")
        short.Shape = Part.makePolygon([App.Vector(0, 0, 0), App.Vector(1, 0, 0)])
        with report_view() as report:
            made = fairing.create(short)
            self.document.recompute()
        self.assertIn("2 points", made.Outcome)
        self.assertIn("4 or more", report.text)
        self.assertNotIn("Traceback", report.text)

"""Jobs: the bytes of the command line, the arrays of the answer, cancel, deadline, errors."""
import json
import pathlib
import tempfile
import threading
import time
import types
import unittest

import grpc
import numpy as np
import patchmill as pm
from patchmill import _run
from support import CLIENT, DOME, DOME_JSON, HILLS, ROOT, command_line, long_operation, operation


class SameBytes(unittest.TestCase):
    def test_a_file_of_patches_for_another_control(self):
        teapot = ROOT / "examples/teapot.bpt"
        ours = CLIENT.mill(teapot, operation(0.5, 0.1), setup=pm.Setup(up=pm.UpAxis.Y, scale=20), post=pm.Post(dialect="heidenhain"),
                           outputs=())
        theirs = command_line(teapot, "--up", "y", "--scale", 20, "--scallop", 0.5, "--tolerance", 0.1, "--post", "heidenhain")
        self.assertEqual(ours.program_bytes, theirs)

    def test_a_cad_file_and_its_report(self):
        part = ROOT / "tests/models/cad/dome.step"
        ours = CLIENT.mill(part, operation(0.5, 0.05, pm.ball(8, number=7, feed_mm_per_min=900)), outputs=())
        with tempfile.TemporaryDirectory() as folder:
            report = pathlib.Path(folder) / "report.json"
            theirs = command_line(part, "--tool-diameter", 8, "--scallop", 0.5, "--tolerance", 0.05, "--tool-number", 7, "--feed", 900,
                                  "--report", report)
            reports = [json.loads(text) for text in (ours.report_json(), report.read_text())]
        self.assertEqual(ours.program_bytes, theirs)
        for one in reports:
            del one["stages"]  # times
        self.assertEqual(reports[0], reports[1])

    def test_stock_clamp_holder_boundary_machine_inches(self):
        holder = [pm.HolderSegment(length_mm=20, lower_diameter_mm=28, upper_diameter_mm=28),
                  pm.HolderSegment(length_mm=25, lower_diameter_mm=40, upper_diameter_mm=50)]
        axis = {"rapid_mm_per_min": 10000, "feed_mm_per_min": 5000, "acceleration_mm_per_s2": 500}
        machine = pm.Machine(
            name="bench mill", junction_deviation_mm=0.02, spindle_min_rpm=100, spindle_max_rpm=24000,
            axes=[pm.MachineAxis(travel_min_mm=-400, travel_max_mm=0, **axis), pm.MachineAxis(travel_min_mm=-250, travel_max_mm=0, **axis),
                  pm.MachineAxis(travel_min_mm=-200, travel_max_mm=0, rapid_mm_per_min=5000, feed_mm_per_min=3000,
                                 acceleration_mm_per_s2=300)])
        square = np.array([[5, 5], [55, 5], [55, 55], [5, 55]])
        job = pm.Operation(
            tool=pm.ball(8, stickout_mm=60, holder=holder), scallop_mm=0.3, tolerance_mm=0.05, accept_depth_mm=30,
            leads=pm.Leads(radius_mm=1), feeds=pm.Feeds(link_mm_per_min=700),
            selection=pm.Selection(boundary_xy_mm=square, boundary_mode=pm.BoundaryMode.CONTACT),
            region_overrides=[pm.RegionOverride(at=pm.Point3(30, 30, 14.125), strategy=pm.Strategy.ZIGZAG, zigzag_angle_deg=30)])
        setup = pm.Setup(
            program_zero=pm.Point3(0, 0, 10), translation=pm.Point3(0, 0, 5), machine=machine,
            stock=pm.Stock(allowance_mm=0.3, floor_allowance_mm=0.4, cylinder=pm.CylinderStock(diameter_mm=100)),
            obstacles=[pm.Obstacle(id="vice", top_z_mm=5, outline_xy_mm=[[-20, -20], [-10, -20], [-10, 120], [-20, 120]])])
        with tempfile.TemporaryDirectory() as folder:
            part = pathlib.Path(folder) / "dome.json"
            part.write_text(DOME_JSON)
            ours = CLIENT.mill(part, job, setup=setup, post=pm.Post(unit=pm.LengthUnit.INCH, line_number_step=5))
            theirs = command_line(
                part, "--tool-diameter", 8, "--stickout", 60, "--holder", "20,28 25,40,50", "--scallop", 0.3, "--tolerance", 0.05,
                "--accept-depth", 30, "--lead-radius", 1, "--link-feed", 700, "--boundary", "5,5 55,5 55,55 5,55", "--boundary-mode",
                "contact", "--region", "30,30,14.125:zigzag:angle=30", "--zero", "0,0,10", "--translate", "0,0,5", "--machine",
                ROOT / "docs/machine.json", "--allowance", 0.3, "--allowance-floors", 0.4, "--stock", "cylinder,100", "--obstacle",
                "vice=5: -20,-20 -10,-20 -10,120 -20,120", "--inch", "--line-numbers", 5)
        self.assertEqual(ours.program_bytes, theirs)
        self.assertIn("G20", ours.program)
        self.assertEqual(ours.report.time_basis, "accelerations")
        self.assertAlmostEqual(ours.regions.regions[0].zigzag_angle_deg, 30)
        self.assertIn("vice", ours.page())


class Answer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = CLIENT.mill(pm.Model.from_patches(DOME, name="dome"), operation(),
                                 outputs=(*pm.VIEW, pm.Output.PICTURE, pm.Output.ARCS))

    def test_progress_comes_with_names_and_shares(self):
        seen = []
        CLIENT.mill(HILLS, operation(0.02, 0.01), name="progress", progress=seen.append, outputs=())
        self.assertTrue(seen)
        self.assertTrue(all(0.0 <= p.fraction <= 1.0 for p in seen))
        shares = [p.overall_fraction for p in seen]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual([p.job_stage for p in seen], sorted(p.job_stage for p in seen))

    def test_the_path_is_that_of_the_program(self):
        path, report = self.result.path, self.result.report
        self.assertEqual(len(path), len(path.tip_mm))
        self.assertAlmostEqual(float(path.seconds.sum()), report.estimated_time_s, delta=1e-3 * report.estimated_time_s)
        self.assertAlmostEqual(path.tip_mm[:, 2].min(), report.tip_z_min_mm, places=4)
        arcs = np.flatnonzero(path.arc_plane)
        self.assertEqual(len(arcs), report.arc_block_count)
        # Both ends of an arc are equally far from its centre, in its plane.
        in_plane = {1: [0, 1], 2: [0, 2], 3: [1, 2]}
        for k in arcs[:50]:
            plane = in_plane[int(path.arc_plane[k])]
            radii = [np.linalg.norm((path.tip_mm[j] - path.arc_center_mm[k])[plane]) for j in (k - 1, k)]
            self.assertAlmostEqual(radii[0], radii[1], delta=2e-3)
        # A cutting ball rests on the surface: its centre is a radius from the contact point.
        touches = ~np.isnan(path.contact_mm[:, 0]) & path.is_kind(pm.MoveKind.CUT)
        self.assertGreater(touches.sum(), 100)
        center = path.tip_mm[touches] + [0, 0, 3]
        self.assertLess(np.abs(np.linalg.norm(center - path.contact_mm[touches], axis=1) - 3.0).max(), 0.05)
        self.assertEqual(len(self.result.arcs), report.arc_block_count)

    def test_the_mesh_lies_on_the_patch(self):
        mesh = self.result.mesh
        self.assertEqual(mesh.corners.max(), len(mesh.position_mm) - 1)
        self.assertEqual(mesh.leftover_mm.shape, mesh.slope_deg.shape)
        self.assertLessEqual(mesh.leftover_mm.max(), self.result.report.max_leftover_mm + 1e-3)
        self.assertLessEqual(mesh.gouge_mm.max(), self.result.report.max_gouge_mm + 1e-4)
        a, b, c = (mesh.position_mm[mesh.corners[:, k]].astype(float) for k in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        self.assertAlmostEqual(area, self.result.report.total_area_mm2, delta=0.01 * area)

    def test_regions_have_points_borders_and_kinds(self):
        regions = self.result.regions
        self.assertAlmostEqual(sum(r.area_mm2 for r in regions.regions), self.result.report.total_area_mm2, delta=1.0)
        self.assertTrue(all(isinstance(r.kind, pm.RegionKind) for r in regions.regions))
        self.assertEqual(regions.border_lines[0].points_mm.shape[1], 3)

    def test_findings_have_code_severity_and_message(self):
        codes = {f.code: f for f in self.result.findings}
        self.assertEqual(codes["STOCK_ASSUMED"].severity, pm.Severity.WARNING)
        self.assertIn("0.5 mm", codes["STOCK_ASSUMED"].message)

    def test_it_prints_and_saves(self):
        self.assertIn("COMPLETE", str(self.result))
        self.assertIn("largest gouge", str(self.result))
        self.assertRegex(repr(self.result), r"^<MillResult COMPLETE\w*: gouge 0\.\d{4} mm")
        self.assertTrue(self.result.picture.startswith(b"<svg"))
        self.assertIn('"outcome": "OUTCOME_COMPLETE', self.result.report_json())
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "dome.ngc"
            self.result.save(program)
            self.assertEqual([p.name for p in pathlib.Path(folder).iterdir()], ["dome.ngc"])
            self.assertEqual(program.read_bytes(), self.result.program_bytes)
            verified = CLIENT.verify(pm.Model.from_patches(DOME), program, pm.ball(6), tolerance_mm=0.05, scallop_mm=0.2)
        self.assertTrue(verified.is_good, str(verified))
        self.assertEqual(verified.outcome, self.result.outcome)

    def test_defaults_of_the_server_are_told(self):
        accepted = CLIENT.resolve(pm.Model.from_patches(DOME), operation())
        self.assertEqual(accepted.resolved_job.operations[0].steep_angle_deg, 45.0)
        self.assertEqual(accepted.resolved_post.dialect, "linuxcnc")

    def test_a_program_that_gouges_is_found(self):
        wrong = CLIENT.verify(pm.Model.from_patches(DOME + [0, 0, 0.5]), self.result, pm.ball(6), tolerance_mm=0.05, scallop_mm=0.2,
                              leftover_map=True)
        self.assertFalse(wrong.is_good)
        self.assertEqual(wrong.outcome, pm.Outcome.VERIFICATION_FAILED)
        self.assertGreater(wrong.report.max_gouge_mm, 0.4)
        self.assertTrue(wrong.leftover_csv.startswith(b"x_mm,"))
        self.assertTrue(wrong.leftover_png.startswith(b"\x89PNG"))


class NoProgram(unittest.TestCase):
    def test_a_job_that_needs_roughing_has_a_reason_and_no_program(self):
        result = CLIENT.mill(HILLS, operation(), setup=pm.Setup(stock=pm.Stock(block=pm.BlockStock(margin_mm=4))), outputs=())
        self.assertEqual(result.outcome, pm.Outcome.NEEDS_ROUGHING)
        self.assertFalse(result.has_program)
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(pm.NoProgramError, "NEEDS_ROUGHING"):
                result.save(pathlib.Path(folder) / "no.ngc")
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [])
        with self.assertRaises(pm.NoProgramError):
            result.program


class Errors(unittest.TestCase):
    def test_wrong_fields_are_listed_with_their_paths(self):
        with self.assertRaises(pm.InvalidRequestError) as caught:
            CLIENT.mill(HILLS, pm.Operation(tool=pm.ball(6), scallop_mm=9, tolerance_mm=0.01, detail=3))
        error = caught.exception
        self.assertEqual((error.code, error.reason, error.wrong_field_count), ("INVALID_ARGUMENT", "INVALID_FIELDS", 2))
        self.assertEqual([w.field for w in error.wrong_fields], ["job.operations[0].scallop_mm", "job.operations[0].detail"])
        self.assertRegex(str(error), r"^2 fields are wrong:\n  job.operations\[0\].scallop_mm = 9; .*"
                                     r"\n  job.operations\[0\].detail = 3; [^\n]*$")

    def test_a_ball_without_a_size(self):
        for diameter in (0, -6, float("nan"), "six"):
            with self.assertRaisesRegex(pm.OptionError, r"diameter_mm = .*; it must be a number above 0"):
                pm.ball(diameter)

    def test_an_unreadable_model(self):
        with self.assertRaises(pm.ModelError) as caught:
            CLIENT.check(pm.Model.from_bytes(b"3 3\n1 2 x\n", "bpt"))
        self.assertEqual(caught.exception.reason, "MODEL_UNREADABLE")

    def test_a_program_with_an_unknown_word(self):
        with self.assertRaisesRegex(pm.UnreadableError, "line 2"):
            CLIENT.verify(HILLS, "G21\nQ7 W3\nM2\n", pm.ball(6), tolerance_mm=0.01)

    def test_a_field_that_is_not_there_yet(self):
        with self.assertRaises(pm.NotAvailableError):
            CLIENT.mill(HILLS, operation(), post=pm.Post(spindle_dwell_s=1))

    def test_overrides_of_other_regions(self):
        stale = operation()
        stale.regions_sha256, stale.region_overrides = bytes(32), [pm.RegionOverride(region_id=0, skip=True)]
        with self.assertRaises(pm.RegionsStaleError):
            CLIENT.mill(HILLS, stale)

    def test_a_limit(self):
        with self.assertRaises(pm.LimitError) as caught:
            CLIENT.mill(HILLS, operation(), tessellation_chord_mm=0.0001)
        self.assertGreater(caught.exception.actual_value, caught.exception.limit_value)


class EndingEarly(unittest.TestCase):
    def test_cancel_by_the_progress_callback(self):
        cancel, began = pm.Canceller(), time.monotonic()
        with self.assertRaises(pm.JobCancelledError):
            CLIENT.mill(HILLS, long_operation(), progress=lambda p: cancel(), cancel=cancel)
        self.assertLess(time.monotonic() - began, 15)
        # It stays cancelled: another call does not even begin.
        with self.assertRaises(pm.JobCancelledError):
            CLIENT.check(HILLS, cancel=cancel)

    def test_cancel_by_another_thread(self):
        cancel = pm.Canceller()
        threading.Timer(0.05, cancel).start()
        with self.assertRaises(pm.JobCancelledError):
            CLIENT.regions(HILLS, long_operation(), tessellation_chord_mm=0.002, cancel=cancel)

    def test_an_error_of_the_callback_ends_the_job(self):
        def fail(progress):
            raise ZeroDivisionError(progress.stage)

        with self.assertRaises(ZeroDivisionError):
            CLIENT.mill(HILLS, long_operation(), progress=fail)

    def test_deadline(self):
        began = time.monotonic()
        with self.assertRaisesRegex(pm.DeadlineError, "not done within its time"):
            CLIENT.mill(HILLS, long_operation(), timeout_s=0.5)
        self.assertLess(time.monotonic() - began, 10)

    def test_a_server_whose_clock_is_ahead_ends_the_call_first(self):
        call, cancelled = types.SimpleNamespace(cancel=None), grpc.RpcError()
        cancelled.code = lambda: grpc.StatusCode.CANCELLED
        now = time.monotonic()
        self.assertIsInstance(_run._error_of(call, cancelled, "here", True, now + 0.01), pm.DeadlineError)
        for end in (now + 60, None):
            self.assertIsInstance(_run._error_of(call, cancelled, "here", True, end), pm.ServerLostError)


if __name__ == "__main__":
    unittest.main()

"""The add-on for FreeCAD as far as it needs no FreeCAD: options and jobs, and stand-ins for the jobs of
FreeCAD's own workbench. tests/freecad has the rest, in FreeCAD itself."""
import dataclasses
import math
import os
import pathlib
import stat
import sys
import tempfile
import types
import unittest

import numpy as np
import patchmill as pm
from support import CLIENT, ROOT, command_line

sys.path.insert(0, str(ROOT / "clients/freecad"))
from patchmill_freecad import cam_job, frame, job, moves, options, output  # noqa: E402
from patchmill_freecad.problem import Problem  # noqa: E402

DOME = ROOT / "tests/models/cad/dome.step"
VALUES = {option.name: option.default for option in options.OPERATION}
VERIFIED = {option.name: option.default for option in options.VERIFICATION}


class Options(unittest.TestCase):
    def test_every_field_of_the_contract_has_a_property_or_is_left_out_on_purpose(self):
        # docs/freecad.md, "What is not there".
        left_out = {
            "operation.id", "operation.regions_sha256", "operation.region_overrides", "setup.scale", "setup.translation", "setup.up_face",
            "setup.machine", "setup.wall_sides", "setup.zero", "post.spindle_dwell_s", "operation.heights.low_rapids",
            "operation.heights.clearance_z_mm", "import.skip_faces"}
        by_hand = {
            "operation.tool", "tool.number", "tool.number_is_default", "tool.name", "tool.ball_end", "tool.holder", "tool.spindle_rpm",
            "tool.feed_mm_per_min", "tool.plunge_feed_mm_per_min", "tool.cutting_data_is_default", "setup.program_zero",
            "setup.zero_anchor", "setup.stock", "setup.obstacles", "post.post_file", "post.unit", "operation.heights.floor_z_mm",
            "operation.heights.top_z_mm", "operation.selection.patch_ids", "operation.selection.avoid_patch_ids",
            "operation.selection.boundary_xy_mm", "operation.selection.boundary_mode", "operation.selection.boundary_offset_mm",
            "operation.selection.more_boundary_rings"}
        fields = set()
        for root, kind in (("operation", pm.Operation), ("tool", pm.Tool), ("setup", pm.Setup), ("post", pm.Post),
                           ("import", pm.ImportOptions)):
            for field in dataclasses.fields(kind):
                nested = {"selection": pm.Selection, "heights": pm.Heights, "leads": pm.Leads, "feeds": pm.Feeds}.get(field.name)
                if nested is None:
                    fields.add(f"{root}.{field.name}")
                else:
                    fields.update(f"{root}.{field.name}.{inner.name}" for inner in dataclasses.fields(nested))
        named = {option.field for option in options.OPERATION if option.field}
        self.assertEqual(named - fields, set())
        self.assertEqual(fields - named - by_hand - left_out, set())

    def test_enumerators_exist(self):
        for option in options.OPERATION:
            if option.field in job.ENUMS:
                for label, name in option.choices:
                    self.assertIn(name, job.ENUMS[option.field].__members__, f"{option.name} {label}")
            if option.choices:
                self.assertEqual(option.default, option.choices[0][0])
        self.assertEqual([name for name, _ in next(o for o in options.OPERATION if o.name == "Dialect").choices],
                         [post.name for post in sorted(CLIENT.posts(), key=lambda p: list(options.DIALECTS).index(p.name))])

    def test_defaults_are_those_of_the_service(self):
        """A value that is left out because it is the default must be the default there, too."""
        resolved = CLIENT.resolve(DOME, pm.Operation(tool=pm.ball(6), scallop_mm=0.2, tolerance_mm=0.05))
        roots = {"operation": resolved.resolved_job.operations[0], "tool": resolved.resolved_job.operations[0].tool,
                 "setup": resolved.resolved_job.setup, "post": resolved.resolved_post}
        compared = 0
        for option in options.OPERATION:
            root, *path = option.field.split(".")
            if root not in roots or option.required or "0:" in option.text or "-1:" in option.text:
                continue
            there = roots[root]
            for name in path:
                there = getattr(there, name, None) if there is not None else None
            if there is None or there == "":
                continue
            ours = job.ENUMS[option.field][dict(option.choices)[option.default]] if option.field in job.ENUMS else option.default
            if isinstance(ours, float):
                self.assertAlmostEqual(there, ours * option.factor, places=9, msg=option.name)
            else:
                self.assertEqual(there, ours, option.name)
            compared += 1
        self.assertGreater(compared, 15)

    def test_wrong_fields_are_named_by_properties(self):
        for field, name in (("job.operations[0].scallop_mm", "Scallop"), ("job.operations[0].tool.ball_end.diameter_mm", "ToolDiameter"),
                            ("job.operations[0].tool.holder[1].length_mm", "Holder"), ("job.setup.stock.block.margin_mm", "BlockMargin"),
                            ("tools[0].shank_diameter_mm", "ShankDiameter"), ("tolerance_mm", "Tolerance"),
                            ("post.work_offset", "WorkOffset"), ("job.setup.unknown", "")):
            self.assertEqual(options.property_of(field), name)

    def test_messages_name_properties(self):
        text = "raise --accept-depth or --zero, not --server"
        self.assertEqual(options.with_properties(text), "raise AcceptDepth or ProgramZero, not --server")


class Jobs(unittest.TestCase):
    def program(self, **values):
        request = job.job_request({**VALUES, "Scallop": 0.5, "Tolerance": 0.05, **values})
        model = pm.Model.from_file(DOME, import_options=request.import_options)
        return CLIENT.mill(model, request.operation, setup=request.setup, post=request.post, outputs=()).program_bytes

    def test_defaults_give_the_bytes_of_the_command_line(self):
        self.assertEqual(self.program(), command_line(DOME, "--scallop", 0.5, "--tolerance", 0.05))

    def test_options_of_every_group(self):
        ours = self.program(ToolDiameter=8.0, ToolNumber=3, Feed=15.0, Strategy="Zig-zag", ZigzagAngle=30.0, OneWay=True, UpAxis="Z",
                            ProgramZero="Point", ZeroPoint=(1.0, 2.0, 3.0), StockKind="Allowance", Allowance=0.3, FloorAllowance=0.5,
                            KeepFeed=True, LinkFeed=10.0, Inch=True, WorkOffset="G55", LineNumbers=5,
                            MaxUnreached=80.0, BorderTolerance=0.001)
        theirs = command_line(
            DOME, "--scallop", 0.5, "--tolerance", 0.05, "--tool-diameter", 8, "--tool-number", 3, "--feed", 900, "--strategy", "zigzag",
            "--zigzag-angle", 30, "--one-way", "--zero", "1,2,3", "--allowance", 0.3, "--allowance-floors", 0.5,
            "--keep-feed", "--link-feed", 600, "--inch", "--work-offset", "G55", "--line-numbers", 5, "--max-unreached", 80,
            "--border-tolerance", 0.001)
        self.assertEqual(ours, theirs)

    def test_verification_takes_the_same_properties(self):
        program = self.program()
        request, arguments = job.verification_arguments({**VERIFIED, "Scallop": 0.5, "Tolerance": 0.05})
        result = CLIENT.verify(DOME, program, request.operation.tool, **arguments)
        self.assertTrue(result.is_good, str(result))

    def test_wrong_values_are_named(self):
        for values, words in (({"ToolDiameter": 0.0}, "ToolDiameter is 0 mm"), ({"Holder": ["20"]}, r"Holder\[0\] is '20'"),
                              ({"Scallop": math.nan}, "Scallop is nan"), ({"StockKind": "Job"}, "StockKind is Job")):
            with self.assertRaisesRegex(Problem, words):
                job.job_request({**VALUES, **values})

    def test_long_names_are_cut(self):
        self.assertEqual(len(job.wire_name("ü" * 80).encode()), 100)


class Quantity:
    def __init__(self, value):
        self.Value = value


def made(**properties):
    return types.SimpleNamespace(**properties)


def controller(tool):
    return made(Label="TC", Tool=tool, ToolNumber=4, HorizFeed=Quantity(15.0), VertFeed=Quantity(5.0), SpindleSpeed=9000.0,
                SpindleDir="Forward")


LENGTHS = {"Diameter": Quantity(8.0), "CuttingEdgeHeight": Quantity(30.0), "ShankDiameter": Quantity(8.0)}
# Tools as the versions of FreeCAD have them. 0.20 is tried in FreeCAD itself; the others are stand-ins.
TOOLS = {
    "0.18": made(Name="ball", ToolType="BallEndMill", Diameter=8.0, CuttingEdgeHeight=30.0, ShankDiameter=8.0),
    "0.20": made(Label="ball", ShapeName="ballend", BitShape="/usr/share/Shape/ballend.fcstd", **LENGTHS),
    "0.20, a shape of one's own": made(Label="ball", ShapeName="", BitShape="C:\\shapes\\MyBall.FCStd", **LENGTHS),
    "1.0": made(Label="ball", ShapeName="ballend", BitShape="ballend.fcstd", **LENGTHS),
    "1.1": made(Label="ball", ShapeType="Ballend", ShapeID="ballend", **LENGTHS),
}


class CamJobs(unittest.TestCase):
    def test_tools_of_every_version(self):
        for version, tool in TOOLS.items():
            with self.subTest(version):
                self.assertEqual(cam_job.tool_of(controller(tool)),
                                 job.ToolData("ball", 8.0, 4, 30.0, 8.0, 9000.0, 900.0, 300.0))

    def test_tools_that_are_no_balls(self):
        for shape in ("endmill", "Bullnose", "TaperedBallNose", "v-bit", ""):
            tool = made(Label="tool", ShapeType=shape, **LENGTHS)
            self.assertFalse(cam_job.is_ball(tool), shape)
            with self.assertRaisesRegex(Problem, "must have a ball end"):
                cam_job.tool_of(controller(tool))

    def test_a_spindle_that_turns_the_other_way(self):
        other = controller(TOOLS["0.20"])
        other.SpindleDir = "Reverse"
        with self.assertRaisesRegex(Problem, "SpindleDir"):
            cam_job.tool_of(other)

    def test_controllers_of_every_layout(self):
        flat, ball = controller(made(ShapeName="endmill", **LENGTHS)), controller(TOOLS["1.1"])
        for layout in ({"Tools": made(Group=[flat, ball])}, {"ToolController": made(Group=[flat, ball])}, {"ToolController": [flat, ball]}):
            self.assertIs(cam_job.ball_controller(made(**layout)), ball)
        self.assertIsNone(cam_job.ball_controller(made(Tools=made(Group=[flat]))))

    def test_the_job_of_an_object(self):
        of_all = made(Operations=made(Group=[]), Stock=None, SetupSheet=None)
        inner = made(InListRecursive=[made(Label="Model"), of_all])
        self.assertIs(cam_job.job_of(inner), of_all)
        self.assertIs(cam_job.job_of(of_all), of_all)
        self.assertIsNone(cam_job.job_of(made(InListRecursive=[])))
        cam_job.add_operation(of_all, inner)
        self.assertEqual(of_all.Operations.Group, [inner])

    def test_stock(self):
        box = made(XMin=-1.0, YMin=-2.0, ZMin=0.0, XMax=61.0, YMax=60.0, ZMax=21.0)
        shape = made(BoundBox=box, isNull=lambda: False)
        found = cam_job.stock_of(made(Stock=made(Shape=shape)), (1.0, 0.0, 20.0))
        self.assertEqual(found, job.StockData((-2.0, -2.0, 60.0, 60.0), 1.0))
        cylinder = cam_job.stock_of(made(Stock=made(Shape=shape, Radius=Quantity(31.0))), (0.0, 0.0, 0.0))
        self.assertEqual(cylinder.diameter_mm, 62.0)
        lying = made(XMin=0.0, YMin=0.0, ZMin=0.0, XMax=90.0, YMax=62.0, ZMax=62.0)
        self.assertEqual(cam_job.stock_of(made(Stock=made(Shape=made(BoundBox=lying, isNull=lambda: False), Radius=Quantity(31.0))),
                                          (0.0, 0.0, 0.0)).diameter_mm, 0.0)


def path(*rows):
    """Moves: kind, end, and of an arc plane, centre and turns."""
    return _Path([row if len(row) == 5 else (*row, 0, (math.nan,) * 3, 0.0) for row in rows])


class _Path:
    def __init__(self, rows):
        self.kind, self.arc_plane = [r[0] for r in rows], [r[2] for r in rows]
        self.tip_mm, self.arc_center_mm, self.arc_turns = [r[1] for r in rows], [r[3] for r in rows], [r[4] for r in rows]
        self.feed_mm_per_min = [600.0] * len(rows)

    def __len__(self):
        return len(self.kind)


class Moves(unittest.TestCase):
    def test_lines_rapids_and_an_arc(self):
        made_of = moves.commands(path((1, (0, 0, 9)), (1, (5, 0, 9)), (5, (5, 0, 1)), (5, (0, 5, 1), 1, (0, 0, 1), 0.25)),
                                 [("M6", {"T": 1.0})], 0.01)
        self.assertEqual([name for name, _ in made_of], ["M6", "G0", "G0", "G0", "G1", "G3"])
        self.assertEqual(made_of[4][1], {"X": 5.0, "Y": 0.0, "Z": 1.0, "F": 10.0})
        self.assertEqual(made_of[5][1], {"X": 0.0, "Y": 5.0, "Z": 1.0, "I": -5.0, "J": 0.0, "F": 10.0})

    def test_a_helix_of_two_turns_and_a_half(self):
        made_of = moves.commands(path((1, (5, 0, 5)), (5, (-5, 0, 0), 1, (0, 0, 0), -2.5)), [], 0.01)[2:]
        self.assertEqual([name for name, _ in made_of], ["G2"] * 3)
        np.testing.assert_allclose([words["Z"] for _, words in made_of], [5 - 5 / 3, 5 - 10 / 3, 0], atol=1e-12)
        here = np.array([5.0, 0.0])
        for _, words in made_of:
            np.testing.assert_allclose(here + [words["I"], words["J"]], [0, 0], atol=1e-12)
            here = np.array([words["X"], words["Y"]])
            self.assertAlmostEqual(float(np.hypot(*here)), 5.0)
        np.testing.assert_allclose(here, [-5, 0], atol=1e-12)

    def test_arcs_in_other_planes_are_chords_within_their_tolerance(self):
        # From +Z towards +X is counter-clockwise in ZX.
        for plane, start, end, turns in ((2, (0, 7, 5), (5, 7, 0), 0.25), (3, (7, 5, 0), (7, 0, 5), 0.25),
                                         (2, (5, 7, 0), (0, 7, 5), -0.25)):
            center = (0, 7, 0) if plane == 2 else (7, 0, 0)
            made_of = moves.commands(path((1, start), (5, end, plane, center, turns)), [], 0.001)[2:]
            self.assertEqual({name for name, _ in made_of}, {"G1"})
            places = np.array([start] + [[words[axis] for axis in "XYZ"] for _, words in made_of], dtype=float)
            np.testing.assert_allclose(places[-1], end, atol=1e-12)
            np.testing.assert_allclose(np.linalg.norm(places - center, axis=1), 5.0, atol=1e-9)
            middles = np.linalg.norm(0.5 * (places[1:] + places[:-1]) - center, axis=1)
            self.assertLessEqual(5.0 - middles.min(), 0.001)
            self.assertLess(len(places), 60)
            self.assertTrue((places @ np.eye(3)[[0, 2] if plane == 2 else [1, 2]].T >= -1e-9).all())  # it is the shorter way

    def test_an_empty_path(self):
        self.assertEqual(moves.commands(path(), [], 0.01), [])


class Frame(unittest.TestCase):
    def test_points_return_to_the_document(self):
        for up, name in (("Z", "Z"), ("Y", "Y"), ("X", "X"), ("-Z", "NEG_Z"), ("-Y", "NEG_Y"), ("-X", "NEG_X")):
            setup = pm.Setup(up=pm.UpAxis[name], program_zero=pm.Point3(1, 2, 3))
            net = np.array([[[0, 0, 0], [0, 9, 1]], [[7, 0, 2], [7, 9, 4]]], dtype=float)
            placed = CLIENT.evaluate(pm.Model.from_patches([net]), [0, 0], [[0, 0], [1, 1]], setup=setup).points_mm
            matrix = np.array(frame.matrix_values(up, (1, 2, 3))).reshape(4, 4)
            back = np.c_[placed, np.ones(2)] @ matrix.T
            np.testing.assert_allclose(back[:, :3], [[0, 0, 0], [7, 9, 4]], atol=1e-12, err_msg=up)


class Files(unittest.TestCase):
    def test_the_package_states_the_version_of_the_project(self):
        text = (ROOT / "clients/freecad/package.xml").read_text()
        version = (ROOT / "CMakeLists.txt").read_text().split("project(patchmill VERSION ")[1].split()[0]
        self.assertIn(f"<version>{version}</version>", text)

    def test_every_command_has_its_icon(self):
        icons = {file.stem for file in pathlib.Path(ROOT / "clients/freecad/patchmill_freecad/icons").glob("*.svg")}
        text = (ROOT / "clients/freecad/patchmill_freecad/commands.py").read_text()
        for name in ("mill", "check", "verify", "regions", "fair"):
            self.assertIn(f'"{name}", {name})', text)
            self.assertIn(name, icons)


class Output(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_an_earlier_result_is_replaced_behind_its_link(self):
        part = self.folder / "part.ngc"
        part.write_bytes(b"(made by Patchmill)")
        part.chmod(0o640)
        (self.folder / "link").symlink_to("part.ngc")
        output.write(self.folder / "link", b"new", "ProgramFile")
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertEqual((part.read_bytes(), stat.S_IMODE(part.stat().st_mode)), (b"new", 0o640))

    def test_other_files_and_what_is_no_file_stay(self):
        """A pipe without a reader would keep FreeCAD waiting for ever, and a document may name any device."""
        other, pipe = self.folder / "notes.txt", self.folder / "pipe"
        other.write_bytes(b"mine")
        os.mkfifo(pipe)
        for file, why in ((other, "no result of Patchmill"), (pipe, "a pipe"), (self.folder, "a folder"),
                          (self.folder / "none/part.ngc", "cannot be written")):
            with self.assertRaisesRegex(Problem, f"ProgramFile '{file}'.*{why}.*choose"):
                output.write(file, b"new", "ProgramFile")
        self.assertEqual(other.read_bytes(), b"mine")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["notes.txt", "pipe"])


if __name__ == "__main__":
    unittest.main()

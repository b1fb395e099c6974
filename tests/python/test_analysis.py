"""The other calls: regions, reach, lines, evaluate, check, convert, build, edit, fair, posts."""
import pathlib
import tempfile
import unittest

import numpy as np
import patchmill as pm
from support import CLIENT, DOME, HILLS, ROOT, operation

SPHERE = ROOT / "tests/models/sphere.bv"


class Regions(unittest.TestCase):
    def test_regions_and_an_override_by_id(self):
        job = operation(0.2, 0.05)
        split = CLIENT.regions(HILLS, job)
        self.assertLessEqual({pm.RegionKind.MOUNTAIN, pm.RegionKind.BASIN}, {r.kind for r in split.regions})
        self.assertEqual(split[2].id, 2)
        self.assertIn("2 basin, gentle", str(split))
        self.assertEqual(set(np.unique(split.mesh.region_id)), set(range(len(split))))
        job.regions_sha256 = split.regions_sha256
        job.region_overrides = [pm.RegionOverride(region_id=2, skip=True)]
        again = CLIENT.regions(HILLS, job, outputs=[pm.Output.REGIONS, pm.Output.PICTURE])
        self.assertTrue(again[2].skipped)
        self.assertIsNone(again.mesh)
        self.assertIn(b"<svg", again.picture)

    def test_reach_falls_with_the_ball(self):
        table = CLIENT.reach(ROOT / "tests/models/cad/dome.step", operation(), [2.0, 4.0, 8.0])
        areas = [e.unreachable_area_mm2 for e in table.entries]
        self.assertEqual(areas, sorted(areas))
        self.assertLess(areas[-1], table.area_mm2)
        self.assertIn("D 4 mm", str(table))


class Surface(unittest.TestCase):
    def test_a_contour_lies_at_its_level(self):
        traced = CLIENT.lines(pm.Model.from_patches(DOME), pm.LineFamily(kind=pm.LineKind.CONTOUR, levels=[5.0, 10.0]), tolerance_mm=0.01,
                              picture=True)
        self.assertEqual([s.level for s in traced.sets], [5.0, 10.0])
        for level in traced.sets:
            for line in level.lines:
                np.testing.assert_allclose(line.points_mm[:, 2], level.level, atol=1e-6)
                self.assertEqual(line.uv.shape, (len(line.points_mm), 2))
        self.assertIn(b"<svg", traced.picture.data)

    def test_a_sphere_is_evaluated(self):
        checked = CLIENT.check(SPHERE, setup=pm.Setup(scale=20))
        places = np.arange(checked.patch_count)
        values = CLIENT.evaluate(SPHERE, places, np.full((len(places), 2), 0.3), setup=pm.Setup(scale=20))
        radii = np.linalg.norm(values.points_mm, axis=1)
        self.assertLess(np.ptp(radii), 1e-6 * radii.mean())
        np.testing.assert_allclose(np.abs(values.principal_curvatures_per_mm), 1 / radii.mean(), rtol=1e-6)
        e, f, g = values.first_form_mm2.T
        np.testing.assert_allclose(np.linalg.norm(np.cross(values.du_mm, values.dv_mm), axis=1), np.sqrt(e * g - f * f))
        self.assertIn("normal", str(values))

    def test_check_with_faces_and_joints(self):
        part = ROOT / "tests/models/cad/dome.step"
        checked = CLIENT.check(part, tool=pm.Tool(ball_end=pm.BallEnd(diameter_mm=8)), continuity_steps=4, with_faces=True,
                               with_faces_picture=True)
        self.assertEqual(len(checked.faces), checked.face_count)
        self.assertEqual(sum(not joint.part for joint in checked.joints), checked.joined_edge_count)
        self.assertIn(b"<svg", checked.picture.data)
        self.assertIn("usable", str(checked))


class Models(unittest.TestCase):
    def test_convert_and_save_for_the_command_line(self):
        part = ROOT / "tests/models/cad/dome.step"
        converted = CLIENT.convert(part)
        self.assertEqual(converted.model_sha256, CLIENT.check(part).model_sha256)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("dome.json", "dome.pb"):
                file = pathlib.Path(folder) / name
                converted.save(file)
                self.assertEqual(CLIENT.check(file).model_sha256, converted.model_sha256, name)

    def test_edit_changes_what_it_says(self):
        bonnet = ROOT / "examples/bonnet.json"
        edited = CLIENT.edit(bonnet, pm.ModelEdit(bend_section=pm.BendSection(start=5, end=6, face=4, curvature=-0.03)), with_patches=True)
        self.assertEqual(len(edited.changed_faces), 2)
        self.assertEqual(len(edited.patches.patches), 9)
        self.assertTrue(CLIENT.check(edited.model).is_usable)

    def test_edit_by_goals(self):
        edited = CLIENT.edit(ROOT / "examples/bonnet.json",
                             pm.ModelEdit(reach_goals=pm.ReachGoals(points=[pm.PointGoal(face=4, u=0.2, v=0.8, distance=1.0)])))
        self.assertEqual(list(edited.changed_faces), [4])
        self.assertLess(edited.goals[0].distance, 1e-9)
        self.assertEqual(edited.goals[0].field, "edits[0].reach_goals.points[0]")

    def test_build_a_skin(self):
        heights = (0.0, 3.0, 0.0)
        curves = [pm.OutlineCurve(bezier=pm.BezierCurve(points=[[0, y, 0], [15, y, z + 4], [30, y, 0]]))
                  for y, z in zip((0, 10, 20), heights)]
        built = CLIENT.build(pm.SectionCurves(curves=curves))
        self.assertEqual(built.model.patches[0].id, "outline")
        middle = CLIENT.evaluate(built.model, [0], [[0.5, 0.5]]).points_mm[0]
        self.assertAlmostEqual(middle[2], 0.5 * (heights[1] + 4), places=6)

    def test_build_a_network_of_curves_of_a_surface_and_of_a_mesh(self):
        strokes = [pm.OutlineCurve(points=pm.PointList(points=[[a, -1, 2], [a, 11, 2]])) for a in (0, 10)]
        strokes += [pm.OutlineCurve(points=pm.PointList(points=[[-1, a, 2], [11, a, 2]])) for a in (0, 10)]
        square = CLIENT.build(pm.CrossingCurves(curves=strokes, tolerance_mm=0.01))
        self.assertEqual(len(square.network_model.network.faces), 1)
        self.assertEqual(sum(d.code == "CURVE_END_TRIMMED" for d in square.diagnostics), 8)
        self.assertTrue(CLIENT.check(square.network_model).is_usable)
        # A bilinear surface divided into 2 x 3 parts: its middle stays where it is.
        points = [[0, 0, 0], [0, 10, 4], [10, 0, 4], [10, 10, 0]]
        bilinear = pm.BsplinePatch(degree_u=1, degree_v=1, knots_u=[0, 0, 1, 1], knots_v=[0, 0, 1, 1], points=points)
        divided = CLIENT.build(bilinear, division=pm.SurfaceDivision(parts_u=2, parts_v=3))
        self.assertEqual(len(divided.network_model.network.faces), 6)
        self.assertLess(divided.max_distance_mm, 1e-9)
        cage = CLIENT.build(pm.ControlMesh(content=b"v 0 0 0\nv 10 0 1\nv 10 10 0\nv 0 10 1\nf 1 2 3 4\n"))
        self.assertEqual(len(cage.network_model.network.vertices), 4)

    def test_a_post_file_is_checked(self):
        shop = next(p for p in CLIENT.posts() if p.name == "fanuc").post_file.replace("name = fanuc", "name = shop")
        good = CLIENT.check_post(shop)
        self.assertEqual((good.name, good.base, list(good.faults)), ("shop", "fanuc", []))
        self.assertEqual([line.text for line in good.own_lines], ["name = shop"])
        bad = CLIENT.check_post(shop.replace("T{tool} M6", "T{tol} M6"))
        self.assertEqual(len(bad.faults), 1)
        self.assertIn("{tol} is not a placeholder", bad.faults[0].message)

    def test_posts(self):
        names = [p.name for p in CLIENT.posts()]
        self.assertIn("heidenhain", names)
        self.assertEqual(names, sorted(names))


class Fairing(unittest.TestCase):
    def test_a_noisy_circle_becomes_smoother(self):
        angle = np.linspace(0, 1.5, 25)
        noise = np.where(np.arange(25) % 2, 0.02, -0.02)
        points = np.column_stack([(10 + noise) * np.cos(angle), (10 + noise) * np.sin(angle)])
        faired = CLIENT.fair(points, band=pm.FairingBand(x_mm=0.1, y_mm=0.1), polyline_tolerance_mm=0.001, picture=True)
        self.assertLess(faired.energies[-1], 0.5 * faired.energies[0])
        self.assertLess(faired.max_moved_mm, 0.15)
        self.assertEqual(faired.points_mm.shape, (25, 3))
        self.assertGreater(len(faired.polyline_mm), 25)
        self.assertEqual(faired.curvatures_after.shape, (25, 3))
        self.assertLess(np.ptp(faired.curvatures_after[3:-3, 0]), np.ptp(faired.curvatures_before[3:-3, 0]))

    def test_a_file(self):
        faired = CLIENT.fair(ROOT / "tests/models/curves/clarky.dat", max_iterations=3)
        self.assertTrue(faired.planar)
        self.assertLessEqual(faired.iteration_count, 3)

    def test_a_net_keeps_its_border(self):
        x, y = np.meshgrid(np.arange(6.0), np.arange(5.0), indexing="ij")
        bumps = 0.05 * np.where((x + y) % 2, 1, -1)
        net = np.stack([x, y, bumps], axis=-1)
        faired = CLIENT.fair_net(net, axes=[pm.Axis.Z])
        moved = faired.points_mm.reshape(net.shape)
        np.testing.assert_array_equal(moved[0], net[0])
        np.testing.assert_array_equal(moved[..., :2], net[..., :2])
        self.assertLess(np.ptp(moved[1:-1, 1:-1, 2]), np.ptp(bumps[1:-1, 1:-1]))

    def test_wrong_points(self):
        with self.assertRaisesRegex(pm.OptionError, "curve has the shape"):
            CLIENT.fair(np.zeros(7))
        with self.assertRaisesRegex(pm.OptionError, "line_count"):
            CLIENT.fair_net(np.zeros((12, 3)))


if __name__ == "__main__":
    unittest.main()

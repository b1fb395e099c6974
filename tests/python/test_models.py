"""Models from arrays, networks, bytes, and parts of CAD programs (stand-ins with their interface)."""
import pathlib
import shutil
import tempfile
import unittest

import numpy as np
import patchmill as pm
from support import CLIENT, DOME, DOME_JSON, HILLS, ROOT, operation

STEP = ROOT / "tests/models/cad/dome.step"


def read_bicubic(path: pathlib.Path) -> np.ndarray:
    """Control nets of a .bpt file of bicubic patches: (patch, u, v, 3)."""
    words = path.read_text().split()
    count, nets, at = int(words[0]), [], 1
    for _ in range(count):
        assert words[at:at + 2] == ["3", "3"]
        nets.append(np.array(words[at + 2:at + 50], dtype=float).reshape(4, 4, 3))
        at += 50
    return np.array(nets)


class Shape:
    """As a shape of CadQuery: exportStep(fileName)."""

    def exportStep(self, fileName: str) -> None:  # noqa: N802, N803
        shutil.copy(STEP, fileName)


class Part:
    """As a part of build123d or a shape of pythonocc: a function writes it."""


def export_step(part: Part, path: str) -> bool:
    assert isinstance(part, Part)
    shutil.copy(STEP, path)
    return True


class FromArrays(unittest.TestCase):
    def test_nets_are_the_same_model_as_their_file(self):
        file = ROOT / "examples/teapot.bpt"
        nets = read_bicubic(file)
        self.assertEqual(nets.shape, (28, 4, 4, 3))
        of_file = CLIENT.check(file)
        of_nets = CLIENT.check(pm.Model.from_patches(nets))
        self.assertEqual(of_nets.model_sha256, of_file.model_sha256)

    def test_nets_give_the_bytes_of_their_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "dome.json"
            file.write_text(DOME_JSON)
            of_file = CLIENT.mill(file, operation(), outputs=())
        of_net = CLIENT.mill(pm.Model.from_patches(DOME, name="dome.json"), operation(), outputs=())
        self.assertEqual(of_net.program_bytes, of_file.program_bytes)

    def test_u_is_the_first_index(self):
        uneven = np.array([[[0, 0, 0], [0, 9, 0]], [[5, 0, 2], [5, 9, 2]], [[8, 0, 0], [8, 9, 1]]], dtype=float)
        values = CLIENT.evaluate(pm.Model.from_patches(uneven), [0, 0, 0], [[0, 0], [1, 0], [0, 1]])
        np.testing.assert_allclose(values.points_mm, [[0, 0, 0], [8, 0, 0], [0, 9, 0]], atol=1e-12)

    def test_weights_make_an_exact_quarter_of_a_cylinder(self):
        radius, half = 10.0, np.sqrt(0.5)
        row = np.array([[radius, 0, 0], [radius, 0, radius], [0, 0, radius]])
        net = np.stack([row, row + [0, 30, 0]], axis=1)
        model = pm.Model.from_patches([net], weights=[np.array([[1, 1], [half, half], [1, 1]])], ids=["quarter"])
        u = np.linspace(0, 1, 9)
        values = CLIENT.evaluate(model, np.zeros(9, dtype=int), np.column_stack([u, np.full(9, 0.5)]))
        np.testing.assert_allclose(np.hypot(values.points_mm[:, 0], values.points_mm[:, 2]), radius, atol=1e-12)
        np.testing.assert_allclose(np.abs(values.principal_curvatures_per_mm).max(axis=1), 1 / radius, atol=1e-9)

    def test_inches(self):
        box = CLIENT.check(pm.Model.from_patches(DOME, length_unit=pm.LengthUnit.INCH)).box
        self.assertAlmostEqual(box.max.x_mm, 60 * 25.4)

    def test_wrong_shapes(self):
        for nets, part in (([np.zeros((4, 4, 2))], r"nets\[0\].*\(4, 4, 2\)"), ([np.zeros((4, 1, 3))], r"two points"), (["x"], "array")):
            with self.assertRaisesRegex(pm.OptionError, part):
                pm.Model.from_patches(nets)
        with self.assertRaisesRegex(pm.OptionError, "weights.*one for each of the 1"):
            pm.Model.from_patches(DOME, weights=[None, None])
        with self.assertRaisesRegex(pm.OptionError, r"weights\[0\] has the shape \(2, 2\)"):
            pm.Model.from_patches(DOME, weights=[np.ones((2, 2))])
        with self.assertRaisesRegex(pm.OptionError, "ids has 2"):
            pm.Model.from_patches(DOME, ids=["a", "b"])


class FromNetwork(unittest.TestCase):
    def test_a_network_of_dataclasses_is_that_of_its_file(self):
        file = ROOT / "docs/sheet.json"
        of_file = CLIENT.convert(file).model
        self.assertIsNotNone(of_file.network)
        again = CLIENT.check(pm.Model.from_network(of_file.network))
        self.assertEqual(again.model_sha256, CLIENT.check(file).model_sha256)
        self.assertEqual(CLIENT.check(of_file.network).model_sha256, again.model_sha256)

    def test_edges_and_normals_by_hand(self):
        corners = [(0, 0, 0), (40, 0, 3), (40, 40, 0), (0, 40, 3)]
        network = pm.CurveNetwork(vertices=[pm.NetworkVertex(position=p, normals=[pm.VertexNormal(direction=(0, 0, 1))]) for p in corners],
                                  faces=[pm.NetworkFace(id="lid", vertices=[0, 1, 2, 3])])
        checked = CLIENT.check(network)
        self.assertTrue(checked.is_usable, str(checked))
        self.assertEqual(checked.patch_count, 1)


class FromCad(unittest.TestCase):
    def test_a_part_that_exports_itself(self):
        of_part = CLIENT.check(Shape())
        self.assertEqual(of_part.model_sha256, CLIENT.check(STEP).model_sha256)
        self.assertEqual(pm.Model.from_cad(Shape()).name, "Shape")

    def test_a_part_with_a_function_that_writes_it(self):
        model = pm.Model.from_cad(Part(), export_step, name="lever", import_options=pm.ImportOptions(border_tolerance_mm=1e-3))
        self.assertEqual(model.name, "lever")
        self.assertTrue(CLIENT.check(model).is_usable)

    def test_what_is_no_part_is_refused(self):
        with self.assertRaisesRegex(pm.OptionError, "Part.*from_cad"):
            CLIENT.check(Part())
        with self.assertRaisesRegex(pm.OptionError, "write"):
            pm.Model.from_cad(Part())
        with self.assertRaisesRegex(pm.OptionError, "made no file"):
            pm.Model.from_cad(Part(), lambda part, path: None)


class FromBytes(unittest.TestCase):
    def test_bytes_with_their_format(self):
        self.assertEqual(CLIENT.check(pm.Model.from_bytes(HILLS.read_bytes(), "bv")).model_sha256, CLIENT.check(HILLS).model_sha256)

    def test_a_digest_is_followed_by_the_model(self):
        sha256 = CLIENT.check(HILLS).model_sha256
        model = pm.Model.from_digest(sha256, HILLS)
        self.assertEqual(CLIENT.check(model).model_sha256, sha256)
        programs = [CLIENT.mill(m, operation(1.0), outputs=()).program_bytes for m in (model, HILLS)]
        self.assertEqual(programs[0], programs[1])
        with self.assertRaises(pm.ModelNotCachedError):
            CLIENT.check(pm.Model(pm.ModelSource(model_sha256=bytes(32))))

    def test_an_uploaded_model_stands_for_the_model(self):
        kept = CLIENT.upload(HILLS)
        self.assertEqual(kept.sha256, CLIENT.check(HILLS).model_sha256)
        self.assertIn("patches, kept as", str(kept))
        for _ in range(2):  # the second time the client uploads it again
            self.assertEqual(CLIENT.mill(kept.model, operation(1.0), outputs=()).program_bytes,
                             CLIENT.mill(HILLS, operation(1.0), outputs=()).program_bytes)
            self.assertTrue(CLIENT.forget(kept.model))
            self.assertFalse(CLIENT.forget(kept.sha256))
        with self.assertRaisesRegex(pm.OptionError, "is a whole model"):
            CLIENT.forget(pm.Model.from_file(HILLS))

    def test_models_of_all_kinds_can_be_uploaded(self):
        for model in (pm.Model.from_patches(DOME), HILLS, ROOT / "examples/mouse.json"):
            kept = CLIENT.upload(model)
            self.assertEqual(CLIENT.check(kept.model).model_sha256, CLIENT.check(model).model_sha256)
        broken = CLIENT.upload(pm.Model.from_bytes(b'{"length_unit":"LENGTH_UNIT_MILLIMETER","patches":[{"bezier":{"degree_u":99}}]}'))
        self.assertFalse(broken.is_usable)
        self.assertIsNone(broken.model)
        self.assertIn("cannot be used", str(broken))

    def test_names_are_cut_to_what_the_contract_allows(self):
        result = CLIENT.resolve(pm.Model.from_bytes(HILLS.read_bytes(), "bv", name="ü" * 80), operation())
        self.assertEqual(result.resolved_job.name, "ü" * 50)


if __name__ == "__main__":
    unittest.main()

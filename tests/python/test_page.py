"""The 3-D page: its scene is the one that the command line writes, and a notebook shows it."""
import base64
import gzip
import html
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import patchmill as pm
from support import BIN, CLIENT, DOME_JSON, HILLS, ROOT, command_line, operation


def scene_of(page: str) -> tuple[dict, dict]:
    """Header and buffers of a page."""
    header = json.loads(re.search(r'id="patchmill-scene">(.*?)</script>', page, re.DOTALL)[1])
    block = gzip.decompress(base64.b64decode(re.search(r'id="patchmill-data">(.*?)</script>', page, re.DOTALL)[1]))
    types = {"f32": "<f4", "u32": "<u4", "i32": "<i4", "u8": "u1"}
    buffers = {name: np.frombuffer(block, types[b["type"]], b["count"], b["offset"]) for name, b in header.pop("buffers").items()}
    return header, buffers


class Page(unittest.TestCase):
    def assert_same_scene(self, ours: str, theirs: str):
        (header, buffers), (their_header, their_buffers) = scene_of(ours), scene_of(theirs)
        self.maxDiff = 2000
        self.assertEqual(header, their_header)
        self.assertEqual(set(buffers), set(their_buffers))
        for name in buffers:
            np.testing.assert_array_equal(buffers[name], their_buffers[name], err_msg=name)

    def test_a_job_with_stock_clamp_and_holder(self):
        holder = [pm.HolderSegment(length_mm=20, lower_diameter_mm=28, upper_diameter_mm=40)]
        job = pm.Operation(tool=pm.ball(6, stickout_mm=60, flute_length_mm=20, holder=holder), scallop_mm=0.2, tolerance_mm=0.05,
                           accept_depth_mm=30)
        setup = pm.Setup(stock=pm.Stock(allowance_mm=0.5, cylinder=pm.CylinderStock(diameter_mm=100)),
                         obstacles=[pm.Obstacle(id="</script><b>vice", top_z_mm=1, outline_xy_mm=[[-30, -20], [-25, -20], [-25, 90]])])
        with tempfile.TemporaryDirectory() as folder:
            part, page = pathlib.Path(folder) / "dome.json", pathlib.Path(folder) / "dome.html"
            part.write_text(DOME_JSON)
            ours = CLIENT.mill(part, job, setup=setup)
            command_line(part, "--scallop", 0.2, "--tolerance", 0.05, "--accept-depth", 30, "--allowance", 0.5, "--stock", "cylinder,100",
                         "--stickout", 60, "--flute-length", 20, "--holder", "20,28,40", "--obstacle",
                         "</script><b>vice=1: -30,-20 -25,-20 -25,90", "--preview", page)
            self.assert_same_scene(ours.page(), page.read_text())
            ours.save_page(page)
            self.assertEqual(page.read_text(), ours.page())

    def test_regions_alone_and_a_program_that_is_verified(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.html"
            subprocess.run([BIN / "patchmill", "regions", HILLS, "-o", page, "--scallop", "0.2", "--quiet"], check=True,
                           capture_output=True)
            header, _ = scene_of(page.read_text())
            split = CLIENT.regions(HILLS, operation(0.2, 0.01), setup=pm.Setup(scale=1))
            self.assert_same_scene(split.page().replace('"made_by": "patchmill"', f'"made_by": "{header["made_by"]}"'), page.read_text())
        result = CLIENT.mill(HILLS, operation(1.0))
        verified = CLIENT.verify(HILLS, result, pm.ball(6), tolerance_mm=0.05, scallop_mm=1.0)
        header, buffers = scene_of(verified.page())
        self.assertEqual(header["outcome"], result.outcome.name)
        self.assertEqual(header["passes"], [])
        self.assertIn("path.tip", buffers)

    def test_a_result_without_triangles_says_what_to_ask(self):
        result = CLIENT.mill(HILLS, operation(1.0), outputs=())
        with self.assertRaisesRegex(pm.PatchmillError, "Output.TESSELLATION"):
            result.page()
        self.assertEqual(result._repr_html_(), f"<pre>{html.escape(str(result))}</pre>")

    def test_a_notebook_shows_it(self):
        result = CLIENT.mill(HILLS, operation(1.0))
        with tempfile.TemporaryDirectory() as folder:
            notebook = pathlib.Path(folder) / "notebook.html"
            # What a notebook does: it puts the text into its own document.
            notebook.write_text(f"<!doctype html><meta charset=utf-8><body>{result._repr_html_()}</body>")
            run = subprocess.run([shutil.which("node"), ROOT / "tests/python/notebook.mjs", notebook], capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stderr)
            seen = json.loads(run.stdout)
        self.assertEqual(seen["complaints"], [])
        self.assertIn(result.outcome.name, seen["text"])
        self.assertAlmostEqual(seen["total"], result.report.estimated_time_s, delta=1)


if __name__ == "__main__":
    unittest.main()

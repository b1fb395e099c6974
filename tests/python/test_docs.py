"""What README and docs say: every example answers as shown by a real server; the front end works."""
import doctest
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.error
import urllib.request

from support import CLIENT, HILLS, ROOT, operation


def examples_of(page: pathlib.Path) -> str:
    """The examples of a page, without its prose."""
    return "\n\n".join(re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL))


class Examples(unittest.TestCase):
    def run_page(self, page: pathlib.Path, least: int):
        text, here = examples_of(page), os.getcwd()
        test = doctest.DocTestParser().get_doctest(text, {}, page.name, str(page), 0)
        self.assertGreaterEqual(len(test.examples), least)
        written = []
        with tempfile.TemporaryDirectory() as folder:
            for name in ("examples", "docs", "tests"):
                os.symlink(ROOT / name, pathlib.Path(folder) / name)
            os.chdir(folder)
            try:
                doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE).run(test, out=written.append)
            finally:
                os.chdir(here)
        self.assertFalse(written, "".join(written))

    def test_readme(self):
        self.run_page(ROOT / "clients/python/README.md", 5)

    def test_guide(self):
        self.run_page(ROOT / "docs/python.md", 25)

    def test_every_error_and_method_has_a_row_in_the_guide(self):
        import patchmill as pm
        from patchmill import errors

        guide = (ROOT / "docs/python.md").read_text()
        names = [name for name in errors.__all__ if name not in ("PatchmillError", "CallError", "TemporaryError", "WrongField")]
        names += [name for name in vars(pm.Client) if not name.startswith("_")]
        self.assertEqual([name for name in names if f"`{name}" not in guide], [])


class FrontEnd(unittest.TestCase):
    def setUp(self):
        self.process = subprocess.Popen([sys.executable, ROOT / "docs/front_end.py", "0"], stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(self.stop)
        self.url = self.process.stdout.readline().strip()

    def stop(self):
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()

    def test_a_part_is_milled_in_a_browser(self):
        run = subprocess.run([shutil.which("node"), ROOT / "tests/python/front_end.mjs", self.url, HILLS], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        seen = json.loads(run.stdout)
        self.assertEqual(seen["complaints"], [])
        self.assertIn("0 mountain, gentle", seen["regions"])
        self.assertIn("scallop_mm = 9; must be in (0, ball radius = 3)", seen["error"])
        self.assertIn("cancelled", seen["cancelled"])
        self.assertEqual(seen["program"], CLIENT.mill(HILLS, operation(1.0, 0.01), outputs=()).program)

    def test_it_answers_only_to_who_knows_its_address(self):
        base = self.url.rsplit("/", 2)[0]
        for path, data in (("/", None), ("/wrong/regions?name=a.bv&scallop=1", b"x"), ("/mill", b"x")):
            with self.assertRaises(urllib.error.HTTPError) as caught:
                urllib.request.urlopen(base + path, data, timeout=10)
            self.assertEqual(caught.exception.code, 404)
            caught.exception.close()

    def test_it_is_as_short_as_it_says(self):
        lines = (ROOT / "docs/front_end.py").read_text().splitlines()
        self.assertLessEqual(len([line for line in lines if line.strip()]), 80)


if __name__ == "__main__":
    unittest.main()

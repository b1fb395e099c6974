"""Runs the test module that PATCHMILL_TEST names inside FreeCAD, and writes how it ended."""
import os
import pathlib
import sys
import traceback
import unittest

sys.path.insert(0, os.environ["PATCHMILL_FREECAD_TESTS"])
RESULT = pathlib.Path(os.environ["PATCHMILL_TEST_RESULT"])


def main() -> None:
    try:
        suite = unittest.defaultTestLoader.loadTestsFromName(os.environ["PATCHMILL_TEST"])
        with open(RESULT.with_suffix(".text"), "w") as text:
            ran = unittest.TextTestRunner(text, verbosity=2).run(suite)
        said = RESULT.with_suffix(".text").read_text()
        is_good = ran.wasSuccessful() and ran.testsRun > 0 and not ran.skipped
        RESULT.write_text(f"passed {ran.testsRun} tests\n" if is_good else f"failed\n{said}")
    except BaseException:
        RESULT.write_text(f"failed\n{traceback.format_exc()}")
    sys.stdout.flush()
    # FreeCAD would wait for more commands, or ask whether documents are saved.
    from patchmill_freecad import service

    service.close()
    os._exit(0)


main()

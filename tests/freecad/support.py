"""What the tests in FreeCAD share: parts, the command line, the package, and what was written to the report
view."""
import contextlib
import os
import pathlib
import subprocess
import tempfile
import unittest
from collections.abc import Iterator
from typing import Any

import FreeCAD as App
import Part
import patchmill_freecad  # noqa: F401: it finds the package
import patchmill as pm
from patchmill_freecad import operation

BIN = pathlib.Path(os.environ["PATCHMILL_BIN"])


def command_line(command: str, *words: object, status: int = 0) -> str:
    run = subprocess.run([BIN / "patchmill", command, *map(str, words)], capture_output=True, text=True)
    assert run.returncode == status, f"status {run.returncode}: {run.stderr}{run.stdout}"
    return run.stdout + run.stderr


class Report:
    """What was written while it ran: `out` has messages, `err` warnings and errors, as FreeCAD's own
    observer of the console prints them."""

    out = err = ""

    @property
    def text(self) -> str:
        return self.out + self.err


@contextlib.contextmanager
def report_view() -> Iterator[Report]:
    """Catches the standard output and error of the process: FreeCAD writes there from C++."""
    report, saved = Report(), [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        try:
            yield report
        finally:
            for number, kept in zip((1, 2), saved):
                os.dup2(kept, number)
                os.close(kept)
            out.seek(0)
            err.seek(0)
            report.out, report.err = out.read().decode(), err.read().decode()


class InDocument(unittest.TestCase):
    """A saved document in a folder of its own."""

    def setUp(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)
        self.document = App.newDocument("test")
        self.addCleanup(self._close)
        self.document.saveAs(str(self.folder / "test.FCStd"))

    def _close(self) -> None:
        for name in list(App.listDocuments()):
            App.closeDocument(name)

    def filleted_box(self) -> Any:
        """A box of 50 x 40 x 12 mm whose upper edges have a radius of 4 mm."""
        box = self.document.addObject("Part::Box", "Box")
        box.Length, box.Width, box.Height = 50, 40, 12
        self.document.recompute()
        upper = [k + 1 for k, edge in enumerate(box.Shape.Edges) if edge.BoundBox.ZMin > 11.9]
        part = self.document.addObject("Part::Fillet", "Part")
        part.Base, part.Edges = box, [(k, 4.0, 4.0) for k in upper]
        part.Label = "part"
        self.document.recompute()
        assert part.Shape.isValid()
        return part

    def loft(self) -> Any:
        """A surface through three curves, about 40 x 40 mm."""
        wires = []
        for k, height in enumerate((3.0, 9.0, 4.0)):
            points = [App.Vector(x, 20.0 * k, z) for x, z in ((0, 0), (12, height), (28, height - 2), (40, 1))]
            curve = Part.BSplineCurve()
            curve.interpolate(points)
            wires.append(Part.Wire(curve.toShape()))
        surface = self.document.addObject("Part::Feature", "Sheet")
        surface.Shape, surface.Label = Part.makeLoft(wires), "sheet"
        self.document.recompute()
        return surface

    def operation(self, part: Any, faces: list[str] | tuple[str, ...] = (), **values: Any) -> Any:
        """An operation that is quick."""
        made = operation.create(part, faces)
        made.Scallop, made.Tolerance, made.ProgramZero = 0.2, 0.05, "Origin"
        made.ModelFile = str(self.folder / f"{part.Label}.step")
        for name, value in values.items():
            setattr(made, name, value)
        self.document.recompute()
        return made

    def program(self, made: Any) -> bytes:
        self.assertTrue(made.WrittenFile, made.Outcome)
        return pathlib.Path(made.WrittenFile).read_bytes()

    def of_command_line(self, model: str, *words: object) -> bytes:
        file = self.folder / "command_line.ngc"
        command_line("mill", model, "-o", file, "--quiet", *words)
        return file.read_bytes()


QUICK = ("--scallop", 0.2, "--tolerance", 0.05, "--zero", "origin")


def quick() -> pm.Operation:
    return pm.Operation(tool=pm.ball(6), scallop_mm=0.2, tolerance_mm=0.05)

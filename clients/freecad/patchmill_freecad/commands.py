"""The commands of the workbench. Each ends with a message, whatever goes wrong."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui

from . import ICONS, analysis, console, fairing, operation, selection, verification
from .problem import Problem

PROGRAMS = "Programs (*.ngc *.nc *.gcode *.tap *.cnc *.h *.mpf *.txt);;All files (*)"


def ask_file(title: str) -> str:
    from PySide import QtGui

    return str(QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), title, "", PROGRAMS)[0])


def mill() -> None:
    """Adds an operation for the selected body or faces, and computes it."""
    found = selection.selected(Gui.Selection.getSelectionEx())
    body, faces = selection.one_body(found)
    operation.create(body, faces, App.ActiveDocument, found.job)
    App.ActiveDocument.recompute()


def check() -> None:
    found = selection.selected(Gui.Selection.getSelectionEx())
    if not found.bodies:
        raise Problem("Nothing with surfaces is selected; select bodies in the tree or in the 3-D view.")
    for body, _ in found.bodies:
        analysis.check(body)


def verify() -> None:
    body, faces = selection.one_body(selection.selected(Gui.Selection.getSelectionEx()))
    program = ask_file("Program to verify")
    if program:
        verification.create(body, program, faces, App.ActiveDocument)
        App.ActiveDocument.recompute()


def regions() -> None:
    chosen = [one.Object for one in Gui.Selection.getSelectionEx() if isinstance(getattr(one.Object, "Proxy", None), operation.Operation)]
    if len(chosen) != 1:
        raise Problem(f"{len(chosen)} Patchmill operations are selected; it must be one: select the operation in the tree. Mill adds one.")
    analysis.regions(chosen[0])
    App.ActiveDocument.recompute()


def fair() -> None:
    chosen = [one.Object for one in Gui.Selection.getSelectionEx()]
    if len(chosen) != 1:
        raise Problem(f"{len(chosen)} objects are selected; it must be one wire, sketch or point cloud.")
    fairing.create(chosen[0], App.ActiveDocument)
    App.ActiveDocument.recompute()


class Command:
    """A command of FreeCAD around a function."""

    def __init__(self, title: str, tip: str, icon: str, run: Callable[[], None]) -> None:
        self._title, self._tip, self._icon, self._run = title, tip, icon, run

    def GetResources(self) -> dict[str, Any]:  # noqa: N802: FreeCAD's name
        return {"MenuText": self._title, "ToolTip": self._tip, "Pixmap": str(ICONS / f"{self._icon}.svg")}

    def IsActive(self) -> bool:  # noqa: N802: FreeCAD's name
        return App.ActiveDocument is not None

    def Activated(self) -> None:  # noqa: N802: FreeCAD's name
        App.ActiveDocument.openTransaction(self._title)
        try:
            self._run()
            App.ActiveDocument.commitTransaction()
        except Exception as problem:
            App.ActiveDocument.abortTransaction()
            console.error(f"{self._title}: {console.text_of(problem)}")


COMMANDS = {
    "Patchmill_Mill": Command("Mill", "Make a verified finishing program for the selected body or faces", "mill", mill),
    "Patchmill_Check": Command("Check surfaces", "Find gaps, sharp edges and narrow places of the selected bodies", "check", check),
    "Patchmill_Verify": Command("Verify program", "Measure a program of any post processor against the selected body", "verify", verify),
    "Patchmill_Regions": Command("Regions", "Show how the surface of the selected operation is divided", "regions", regions),
    "Patchmill_Fair": Command("Fair curve", "Fair the points of the selected wire or sketch", "fair", fair),
}


def register() -> list[str]:
    for name, command in COMMANDS.items():
        Gui.addCommand(name, command)
    return list(COMMANDS)

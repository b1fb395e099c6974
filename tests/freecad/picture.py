"""Draws docs/freecad.png: a part with its path, the tree, and the report view. It is no test: picture.sh
runs it."""
import os

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtCore, QtGui
from support import InDocument


class Picture(InDocument):
    def wait(self, seconds):
        end = QtCore.QTime.currentTime().addMSecs(int(1000 * seconds))
        while QtCore.QTime.currentTime() < end:
            QtGui.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 50)

    def test_picture(self):
        Gui.activateWorkbench("PatchmillWorkbench")
        window = Gui.getMainWindow()
        window.showMaximized()
        for name, shown in (("Python console", False), ("Report view", True), ("Combo View", True), ("Selection view", False)):
            dock = window.findChild(QtGui.QDockWidget, name)
            if dock is not None:
                dock.setVisible(shown)
        sheet = self.loft()
        sheet.ViewObject.Visibility = False
        part = self.document.addObject("Part::Feature", "Part")
        part.Shape, part.Label = sheet.Shape.extrude(App.Vector(0, 0, -12)), "part"
        self.document.recompute()
        Gui.Selection.addSelection(self.document.Name, part.Name)
        Gui.runCommand("Patchmill_Mill")
        made = self.document.getObject("PatchmillOperation")
        made.Scallop, made.Tolerance, made.ProgramZero, made.ToolNumber = 0.05, 0.02, "Origin", 1
        window.findChild(QtGui.QTextEdit, "Report view").clear()
        self.document.recompute()
        part.ViewObject.Transparency = 20
        view = Gui.activeDocument().activeView()
        view.setAnimationEnabled(False)
        view.viewIsometric()
        view.fitAll()
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(self.document.Name, made.Name)
        self.wait(3)
        QtGui.QApplication.primaryScreen().grabWindow(0).save(os.environ["PATCHMILL_FREECAD_PICTURE"])  # a file
        App.closeDocument(self.document.Name)

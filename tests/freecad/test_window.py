"""The workbench in FreeCAD's window: commands, report view, icons, preferences, undo."""
import pathlib
import time

import FreeCAD as App
import FreeCADGui as Gui
from patchmill_freecad import ICONS, commands, service
from PySide import QtCore, QtGui
from support import InDocument


def wait():
    for _ in range(20):
        QtGui.QApplication.processEvents()


class Window(InDocument):
    @classmethod
    def setUpClass(cls):
        Gui.activateWorkbench("PatchmillWorkbench")
        wait()

    def setUp(self):
        super().setUp()
        Gui.Selection.clearSelection()
        self.report = Gui.getMainWindow().findChild(QtGui.QTextEdit, "Report view")
        self.report.clear()

    def said(self):
        wait()
        return self.report.toPlainText()

    def colors(self, word):
        """The colours of the lines of the report view that have this word."""
        wait()
        found, block = set(), self.report.document().begin()
        while block.isValid():
            if word in block.text():
                ranges = block.layout().formats()  # they end with this list
                for one in ranges:
                    style = one.format
                    found.add(style.foreground().color().name())
            block = block.next()
        return found

    def milled(self, faces=()):
        part = self.filleted_box()
        for name in faces or ("",):
            Gui.Selection.addSelection(self.document.Name, part.Name, name)
        Gui.runCommand("Patchmill_Mill")
        return part, self.document.getObject("PatchmillOperation")

    def test_the_workbench_has_its_commands(self):
        self.assertIn("PatchmillWorkbench", Gui.listWorkbenches())
        self.assertEqual(set(commands.COMMANDS), set(Gui.listCommands()) & set(commands.COMMANDS))
        titles = [bar.windowTitle() for bar in Gui.getMainWindow().findChildren(QtGui.QToolBar)]
        self.assertIn("Patchmill", titles)
        for command in commands.COMMANDS.values():
            self.assertFalse(QtGui.QIcon(command.GetResources()["Pixmap"]).pixmap(32, 32).isNull())

    def test_mill(self):
        part, made = self.milled()
        self.assertTrue(made.Outcome.startswith("COMPLETE"), made.Outcome)
        self.assertTrue((self.folder / "Mill part.ngc").is_file())
        said = self.said()
        self.assertIn("Patchmill: Mill part: WARNING DEFAULT_CUTTING_DATA", said)
        self.assertIn("largest gouge", said)
        self.assertEqual(made.ViewObject.Proxy.getIcon(), str(ICONS / "mill.svg"))
        self.assertTrue(self.colors("WARNING DEFAULT_CUTTING_DATA"))
        self.assertNotEqual(self.colors("WARNING DEFAULT_CUTTING_DATA"), self.colors("largest gouge"))
        self.document.undo()
        self.assertIsNone(self.document.getObject("PatchmillOperation"))

    def test_mill_of_selected_faces(self):
        _, made = self.milled(("Face10", "Face3"))
        self.assertEqual(sorted(made.Part[1]), ["Face10", "Face3"])

    def test_nothing_selected(self):
        for name, words in (("Patchmill_Mill", "nothing is selected"), ("Patchmill_Check", "Nothing with surfaces"),
                            ("Patchmill_Verify", "nothing is selected"), ("Patchmill_Regions", "0 Patchmill operations"),
                            ("Patchmill_Fair", "0 objects")):
            Gui.runCommand(name)
            self.assertIn(words, self.said())
        self.assertNotIn("Traceback", self.said())
        self.assertEqual(len(self.document.Objects), 0)

    def test_check_regions_and_fair(self):
        part, made = self.milled()
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(self.document.Name, part.Name)
        Gui.runCommand("Patchmill_Check")
        self.assertIn("part: usable", self.said())
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(self.document.Name, made.Name)
        Gui.runCommand("Patchmill_Regions")
        self.assertIn(" regions: part", self.said())
        self.assertIsNotNone(self.document.getObject("PatchmillRegions"))
        import Part

        wire = self.document.addObject("Part::Feature", "Measured")
        wire.Shape = Part.makePolygon([App.Vector(k, (k % 2) * 0.1, 0) for k in range(8)])
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(self.document.Name, wire.Name)
        Gui.runCommand("Patchmill_Fair")
        self.assertEqual(len(self.document.getObject("PatchmillFairedCurve").Shape.Edges), 1)

    def test_escape_ends_a_job(self):
        part, made = self.milled()
        file = pathlib.Path(made.WrittenFile)
        written = file.read_bytes()
        shown = []

        def press():
            """Esc in the dialog of the progress."""
            dialog = QtGui.QApplication.activeModalWidget()
            if isinstance(dialog, QtGui.QProgressDialog):
                shown.append(dialog.labelText())
                QtGui.QApplication.postEvent(dialog, QtGui.QKeyEvent(QtCore.QEvent.KeyPress, QtCore.Qt.Key_Escape, QtCore.Qt.NoModifier))

        timer = QtCore.QTimer()
        timer.timeout.connect(press)
        timer.start(300)
        began = time.monotonic()
        made.Scallop, made.Tolerance = 0.0003, 0.0005  # takes minutes
        self.document.recompute()
        took = time.monotonic() - began
        timer.stop()
        self.assertTrue(shown and shown[0].startswith("Mill part: "), shown)
        self.assertIn("cancelled", made.Outcome)
        self.assertLess(took, 30)
        self.assertEqual(file.read_bytes(), written)
        self.assertNotIn("Traceback", self.said())

    def test_verify(self):
        part, made = self.milled()
        asked, commands.ask_file = commands.ask_file, lambda title: made.WrittenFile
        try:
            Gui.Selection.clearSelection()
            Gui.Selection.addSelection(self.document.Name, part.Name)
            Gui.runCommand("Patchmill_Verify")
        finally:
            commands.ask_file = asked
        self.assertEqual(self.document.getObject("PatchmillVerification").Outcome, made.Outcome)

    def test_preferences(self):
        preferences = App.ParamGet(service.PREFERENCES)
        preferences.SetString("Program", "/nowhere/patchmilld")
        service.close()
        try:
            _, made = self.milled()
        finally:
            preferences.RemString("Program")
        self.assertIn("/nowhere/patchmilld", made.Outcome)
        self.assertNotIn("Traceback", self.said())
        page = QtGui.QWidget
        loaded = Gui.PySideUic.loadUi(str(pathlib.Path(service.FOLDER) / "preferences.ui"))
        self.assertIsInstance(loaded, page)
        self.assertEqual({w.objectName() for w in loaded.findChildren(QtGui.QLineEdit)}, {"program", "server", "authority"})

"""FreeCAD runs this at the start of its window: workbench and preferences of Patchmill."""
import FreeCADGui as Gui


class PatchmillWorkbench(Gui.Workbench):
    MenuText = "Patchmill"
    ToolTip = "Verified finishing programs for ball-end mills"

    def __init__(self):
        import patchmill_freecad

        self.__class__.Icon = str(patchmill_freecad.ICONS / "patchmill.svg")

    def Initialize(self):  # noqa: N802: FreeCAD's name
        try:
            import Path  # noqa: F401: the type of the operations
            from patchmill_freecad import commands
        except ImportError as problem:
            import FreeCAD

            FreeCAD.Console.PrintError(f"Patchmill: {problem}. FreeCAD's Python needs patchmill, grpcio, protobuf and numpy: "
                                       "clients/freecad/README.md says how to install them.\n")
            return
        names = commands.register()
        self.appendToolbar("Patchmill", names)
        self.appendMenu("Patchmill", names)

    def GetClassName(self):  # noqa: N802: FreeCAD's name
        return "Gui::PythonWorkbench"


def _add_preferences():
    import patchmill_freecad

    Gui.addPreferencePage(str(patchmill_freecad.FOLDER / "preferences.ui"), "Patchmill")


Gui.addWorkbench(PatchmillWorkbench())
_add_preferences()

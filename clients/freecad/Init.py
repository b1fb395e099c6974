"""FreeCAD runs this at its start, with or without a window."""
import patchmill_freecad  # noqa: F401: macros may import patchmill from then on

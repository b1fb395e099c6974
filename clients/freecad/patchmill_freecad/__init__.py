"""Patchmill in FreeCAD: operations, verification and checks on the Python package `patchmill`."""
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
ICONS = FOLDER / "icons"

# install.sh puts the wheel of clients/python there; FreeCAD's own Python need not have the package.
_PACKAGES = FOLDER.parent / "packages"
if _PACKAGES.is_dir() and str(_PACKAGES) not in sys.path:
    sys.path.append(str(_PACKAGES))

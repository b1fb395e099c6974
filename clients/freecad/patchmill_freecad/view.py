"""How the objects show in the tree."""
from __future__ import annotations

from typing import Any

from . import ICONS

NAMES = {"Operation": "mill", "Verification": "verify", "FairedCurve": "fair"}


class ViewProvider:
    def __init__(self, view_object: Any) -> None:
        view_object.Proxy = self
        self.attach(view_object)

    def attach(self, view_object: Any) -> None:
        self._document_object = view_object.Object

    def getIcon(self) -> str:  # noqa: N802: FreeCAD's name
        name = NAMES.get(type(self._document_object.Proxy).__name__, "patchmill")
        return str(ICONS / f"{name}.svg")

    def dumps(self) -> None:
        return None

    def loads(self, state: Any) -> None:
        return None

    __getstate__ = dumps
    __setstate__ = loads

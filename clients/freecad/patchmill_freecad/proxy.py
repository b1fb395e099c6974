"""What the proxies of all document objects have in common."""
from __future__ import annotations

from typing import Any


class Proxy:
    """Keeps nothing: all is in the properties of the object. The names of the methods are those that FreeCAD
    0.20 and 1.0 call."""

    def __init__(self, document_object: Any) -> None:
        document_object.Proxy = self
        self._add_properties(document_object)

    def _add_properties(self, document_object: Any) -> None:
        raise NotImplementedError

    def onDocumentRestored(self, document_object: Any) -> None:  # noqa: N802: FreeCAD's name
        document_object.Proxy = self
        self._add_properties(document_object)

    def dumps(self) -> None:
        return None

    def loads(self, state: Any) -> None:
        return None

    __getstate__ = dumps
    __setstate__ = loads

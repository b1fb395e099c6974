"""The properties of a document object: made from the table of options, and read as plain values."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from .options import RESULT, Option

_READ_ONLY = 1


def add(document_object: Any, options: Sequence[Option]) -> None:
    """Adds the properties that the object does not have yet: all of a new one, new ones of an older
    document."""
    for option in options:
        if option.name in document_object.PropertiesList:
            continue
        document_object.addProperty(f"App::Property{option.kind}", option.name, option.group, option.text)
        if option.choices:
            setattr(document_object, option.name, [label for label, _ in option.choices])
        if option.kind == "Vector":
            setattr(document_object, option.name, App.Vector(*option.default))
        elif option.kind == "StringList":
            setattr(document_object, option.name, list(option.default))
        elif option.default is not None and "Link" not in option.kind:
            setattr(document_object, option.name, option.default)
        if option.group == RESULT:
            document_object.setEditorMode(option.name, _READ_ONLY)


def _plain(value: Any) -> Any:
    if hasattr(value, "Value"):  # a Quantity
        return float(value.Value)
    if isinstance(value, App.Vector):
        return (value.x, value.y, value.z)
    return value


def values(document_object: Any, options: Sequence[Option]) -> dict[str, Any]:
    """Quantities as numbers in mm, mm/s and degrees."""
    return {option.name: _plain(getattr(document_object, option.name)) for option in options if "Link" not in option.kind}

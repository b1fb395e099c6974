"""Findings and messages in the report view, each with its severity."""
from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

import FreeCAD as App
import patchmill as pm

from .options import property_of, with_properties
from .problem import Cancelled, Problem

_PRINT = {pm.Severity.ERROR: "PrintError", pm.Severity.WARNING: "PrintWarning"}


def message(text: str) -> None:
    App.Console.PrintMessage(f"Patchmill: {text}\n")


def warning(text: str) -> None:
    App.Console.PrintWarning(f"Patchmill: {text}\n")


def error(text: str) -> None:
    App.Console.PrintError(f"Patchmill: {text}\n")


def place_of(where: Any) -> str:
    """'face f12 at X 1.000 Y 2.000 Z 3.000', 'line 7'; empty if the place is not known."""
    if where is None:
        return ""
    words = []
    for name, value in (("face", where.face_id), ("patch", where.patch_id), ("line", where.line)):
        if value not in ("", None):
            words.append(f"{name} {value}")
            break
    if where.point is not None:
        words.append(f"at X {where.point.x_mm:.3f} Y {where.point.y_mm:.3f} Z {where.point.z_mm:.3f}")
    return " ".join(words)


def line_of(finding: pm.Diagnostic) -> str:
    """'WARNING NO_ZERO (face f12): The text.'"""
    place = place_of(finding.where)
    return f"{finding.severity.name} {finding.code}{f' ({place})' if place else ''}: {with_properties(finding.message)}"


def findings(label: str, listed: Iterable[pm.Diagnostic]) -> list[str]:
    """Writes findings to the report view, and returns the lines of all, errors first. In the view errors
    stand last, where it ends, and informations of one code are one line."""
    ordered = sorted(listed, key=lambda f: -f.severity)
    counts = Counter(finding.code for finding in ordered)
    shown: set[str] = set()
    for finding in reversed(ordered):
        more = ""
        if finding.severity == pm.Severity.INFO:
            if finding.code in shown:
                continue
            shown.add(finding.code)
            more = f" (and {counts[finding.code] - 1} more in Findings)" if counts[finding.code] > 1 else ""
        getattr(App.Console, _PRINT.get(finding.severity, "PrintMessage"))(f"Patchmill: {label}: {line_of(finding)}{more}\n")
    return [line_of(finding) for finding in ordered]


def text_of(problem: BaseException) -> str:
    """What an error means to the user: wrong fields by the names of their properties."""
    if isinstance(problem, (Problem, Cancelled)):
        return with_properties(str(problem))
    if isinstance(problem, pm.CallError) and problem.wrong_fields:
        wrong = [f"{property_of(field.field) or field.field} {field.description}" for field in problem.wrong_fields]
        return "; ".join(wrong)
    if isinstance(problem, pm.OptionError) and property_of(problem.field):
        return f"{property_of(problem.field)} {str(problem).removeprefix(problem.field).strip()}"
    if isinstance(problem, (pm.StartError, pm.ServerUnreachableError)):
        return (f"{problem} In FreeCAD: Edit > Preferences > Patchmill names the program patchmilld, or the address of a server.")
    if isinstance(problem, (pm.PatchmillError, OSError)):
        return str(problem)
    return f"{type(problem).__name__}: {problem}. This is a fault of the add-on; please report it with the document."

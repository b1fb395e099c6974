"""What the user has selected: bodies, and faces of them. It takes what Gui.Selection.getSelectionEx
returns."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from . import cam_job
from .problem import Problem


@dataclass
class Selected:
    """bodies: each with the names of its selected faces. job: the job of FreeCAD that is selected, or that
    of a body."""

    bodies: list[tuple[Any, list[str]]] = field(default_factory=list)
    job: Any = None


def selected(selection: Sequence[Any]) -> Selected:
    """Jobs count as jobs, anything with a shape as a body. A job alone stands for its model."""
    found = Selected()
    for one in selection:
        chosen = one.Object
        if cam_job.is_job(chosen):
            found.job = chosen
        elif hasattr(chosen, "Shape"):
            found.bodies.append((chosen, [name for name in one.SubElementNames if name.rsplit(".", 1)[-1].startswith("Face")]))
    if not found.bodies and found.job is not None:
        found.bodies = [(model, []) for model in found.job.Model.Group]
    if found.job is None and found.bodies:
        found.job = cam_job.job_of(found.bodies[0][0])
    return found


def one_body(found: Selected) -> tuple[Any, list[str]]:
    if len(found.bodies) != 1:
        names = ", ".join(f"'{body.Label}'" for body, _ in found.bodies) or "nothing"
        raise Problem(f"{names} is selected; it must be one body, or faces of one body: select it in the tree or in the 3-D view.")
    return found.bodies[0]

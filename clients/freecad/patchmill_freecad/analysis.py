"""Findings about the surfaces of bodies, and the regions of an operation."""
from __future__ import annotations

from typing import Any

import FreeCAD as App
import Part
import patchmill as pm

from . import console, frame, model, properties, service
from .job import job_request
from .options import OPERATION

CONTINUITY_STEPS = 8  # places along each joint at which it is measured


def check(source: Any, tool_diameter_mm: float | None = None) -> pm.CheckResult:
    """Checks the surfaces of a body: gaps, sharp edges, curvature against the ball. Findings go to the
    report view."""
    body = model.body_of(source, "The selection")
    tool = pm.ball(tool_diameter_mm) if tool_diameter_mm else None
    result = service.client().check(body.model(f"{source.Label}.step", None), tool=tool, continuity_steps=CONTINUITY_STEPS)
    console.findings(source.Label, result.findings)
    for line in str(result).splitlines():
        if not line.strip().startswith(("ERROR", "WARNING", "and ")):
            console.message(f"{source.Label}: {line.strip()}")
    return result


def zero_of(body: model.Body, request: Any) -> tuple[float, float, float]:
    """The program zero of a job, in the placed frame: where the box of the part lies with it and without
    it."""
    lower = []
    for setup in (pm.Setup(up=request.setup.up), request.setup):
        box = service.client().check(body.model("part.step", request.import_options), setup=setup).box
        lower.append((box.min.x_mm, box.min.y_mm, box.min.z_mm))
    return (lower[0][0] - lower[1][0], lower[0][1] - lower[1][1], lower[0][2] - lower[1][2])


def regions(operation: Any) -> Any:
    """Splits the surface of an operation into regions, lists them in the report view, and adds their borders
    to the tree."""
    values = properties.values(operation, OPERATION)
    body = model.body_of(operation.Part[0])
    request = job_request(values, operation.Proxy.links(operation))
    result = service.client().regions(body.model(f"{operation.Part[0].Label}.step", request.import_options), request.operation,
                                      setup=request.setup, outputs=(pm.Output.REGIONS,))
    console.findings(operation.Label, result.findings)
    for line in str(result).splitlines():
        if not line.strip().startswith(("ERROR", "WARNING", "and ")):
            console.message(f"{operation.Label}: {line.strip()}")
    wires = [Part.makePolygon([App.Vector(*point) for point in _points(line)]) for line in result.region_map.border_lines
             if len(_points(line)) > 1]
    made = operation.Document.addObject("Part::Feature", "PatchmillRegions")
    made.Label = f"Regions of {operation.Label}"
    made.Shape = Part.makeCompound(wires)
    made.Placement = App.Placement(App.Matrix(*frame.matrix_values(values["UpAxis"], zero_of(body, request))))
    if App.GuiUp:
        made.ViewObject.LineColor, made.ViewObject.LineWidth = (0.85, 0.2, 0.1), 3.0
    return made


def _points(line: pm.BorderLine) -> list[list[float]]:
    points = [list(map(float, point)) for point in line.points_mm]
    return points + points[:1] if line.closed and points[0] != points[-1] else points

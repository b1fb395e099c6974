"""Jobs of FreeCAD's own workbench, "Path" until 0.21 and "CAM" since 1.0: tool, stock, and the list of
operations.

The modules behind them have other names in each version, and the objects in the document have the same
properties. So everything here goes by properties, and imports nothing of the workbench.

| | 0.18 | 0.19 to 0.21 (Path) | 1.0 (CAM) | 1.1 (CAM) |
|---|---|---|---|---|
| tool controllers | job.ToolController, a list or a group | job.Tools.Group | as before | as before |
| tool | Path.Tool with ToolType and numbers | tool bit with ShapeName, BitShape | as before | ShapeType,
ShapeID |
"""
from __future__ import annotations

from typing import Any

from .job import ClampData, StockData, ToolData
from .problem import Problem

MM_PER_S = 60.0


def is_job(candidate: Any) -> bool:
    return all(hasattr(candidate, name) for name in ("Operations", "Stock", "SetupSheet"))


def job_of(document_object: Any) -> Any:
    """The job that an object is, or is a part of: as model, stock, tool controller or operation; else
    None."""
    if document_object is None:
        return None
    if is_job(document_object):
        return document_object
    return next((above for above in getattr(document_object, "InListRecursive", ()) if is_job(above)), None)


def tool_controllers(job: Any) -> list[Any]:
    for name in ("Tools", "ToolController"):
        found = getattr(job, name, None)
        if found is not None:
            return list(getattr(found, "Group", found))
    return []


def is_tool_controller(candidate: Any) -> bool:
    return all(hasattr(candidate, name) for name in ("Tool", "HorizFeed", "SpindleSpeed"))


def number_of(quantity: Any) -> float:
    """The number of a Quantity in FreeCAD's own unit (mm, mm/s, degrees), or a plain number."""
    return float(getattr(quantity, "Value", quantity))


def shape_of(tool: Any) -> str:
    """What kind of cutter a tool is: "ballend", "endmill" and others."""
    for name in ("ShapeType", "ShapeID", "ShapeName", "BitShape", "ToolType"):
        text = str(getattr(tool, name, "") or "")
        if text:
            return text.replace("\\", "/").rsplit("/", 1)[-1].lower().removesuffix(".fcstd")
    return ""


def is_ball(tool: Any) -> bool:
    shape = shape_of(tool)
    return "ball" in shape and "taper" not in shape


def ball_controller(job: Any) -> Any:
    """The first tool controller of a job whose tool has a ball end; None if there is none."""
    return next((controller for controller in tool_controllers(job) if is_ball(controller.Tool)), None)


def tool_of(controller: Any) -> ToolData:
    """Diameter, lengths, number, feeds and speed of a tool controller. What is 0 there is not stated."""
    if not is_tool_controller(controller):
        raise Problem(f"ToolController is '{getattr(controller, 'Label', controller)}'; it must be a tool controller of a job of FreeCAD, "
                      "or empty: then the properties of the group Tool count.")
    tool, label = controller.Tool, controller.Label
    if not is_ball(tool):
        raise Problem(f"ToolController is '{label}' with a tool of the shape '{shape_of(tool) or 'unknown'}'; it must have a ball end: "
                      "choose a tool bit of the shape ballend, or empty ToolController and give ToolDiameter.")
    if getattr(controller, "SpindleDir", "Forward") == "Reverse":
        raise Problem(f"SpindleDir of '{label}' is Reverse; programs start the spindle clockwise (M3): set it to Forward.")

    def length(name: str) -> float:
        return number_of(getattr(tool, name, 0.0))

    return ToolData(
        name=str(getattr(tool, "Label", "") or getattr(tool, "Name", "") or label), diameter_mm=length("Diameter"),
        number=int(getattr(controller, "ToolNumber", 0)), flute_length_mm=length("CuttingEdgeHeight"),
        shank_diameter_mm=length("ShankDiameter"), spindle_rpm=float(controller.SpindleSpeed),
        feed_mm_per_min=number_of(controller.HorizFeed) * MM_PER_S, plunge_feed_mm_per_min=number_of(controller.VertFeed) * MM_PER_S)


Offset = tuple[float, float, float]


def _plan(box: Any, zero: Offset) -> tuple[float, float, float, float]:
    return (box.XMin - zero[0], box.YMin - zero[1], box.XMax - zero[0], box.YMax - zero[1])


def stock_of(job: Any, zero: Offset) -> StockData | None:
    """The stock of a job: a cylinder as such, anything else by the box around it."""
    stock = getattr(job, "Stock", None)
    if stock is None or stock.Shape.isNull():
        return None
    box = stock.Shape.BoundBox
    diameter = 2.0 * number_of(stock.Radius) if hasattr(stock, "Radius") else 0.0
    upright = abs((box.XMax - box.XMin) - diameter) < 1e-3 and abs((box.YMax - box.YMin) - diameter) < 1e-3
    return StockData(_plan(box, zero), box.ZMax - zero[2], diameter if upright else 0.0)


def clamp_of(body: Any, zero: Offset) -> ClampData:
    if not hasattr(body, "Shape") or body.Shape.isNull():
        raise Problem(f"Clamps has '{body.Label}', which has no shape; give solid bodies.")
    box = body.Shape.BoundBox
    return ClampData(body.Label, _plan(box, zero), box.ZMax - zero[2])


def add_operation(job: Any, operation: Any) -> None:
    """Adds an operation at the end of a job."""
    proxy = getattr(job, "Proxy", None)
    if hasattr(proxy, "addOperation"):
        proxy.addOperation(operation)
    else:
        job.Operations.Group = [*job.Operations.Group, operation]

"""Makes the request of a job from the values of its properties. It needs the package, and not FreeCAD."""
from __future__ import annotations

import math
import pathlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import patchmill as pm

from .options import MM_PER_MIN, OPERATION, VERIFICATION, Option
from .problem import Problem

Values = Mapping[str, Any]
Rectangle = tuple[float, float, float, float]  # x and y of the lower corner, x and y of the upper one, mm


@dataclass(frozen=True)
class ToolData:
    """A tool as a tool controller states it. None or 0: not stated."""

    name: str
    diameter_mm: float
    number: int = 0
    flute_length_mm: float = 0.0
    shank_diameter_mm: float = 0.0
    spindle_rpm: float = 0.0
    feed_mm_per_min: float = 0.0
    plunge_feed_mm_per_min: float = 0.0


@dataclass(frozen=True)
class StockData:
    """The stock of a job of FreeCAD, mm, program frame; a cylinder if it has a diameter."""

    box: Rectangle
    top_mm: float
    diameter_mm: float = 0.0


@dataclass(frozen=True)
class ClampData:
    name: str
    box: Rectangle
    top_mm: float


@dataclass(frozen=True)
class Links:
    """What the links of the properties lead to."""

    patch_ids: Sequence[str] = ()
    avoid_ids: Sequence[str] = ()
    tool: ToolData | None = None
    stock: StockData | None = None
    clamps: Sequence[ClampData] = ()
    boundary: Sequence[Sequence[tuple[float, float]]] = ()


@dataclass
class JobRequest:
    operation: pm.Operation
    setup: pm.Setup
    post: pm.Post
    import_options: pm.ImportOptions | None = None


ENUMS = {"setup.up": pm.UpAxis, "tool.coolant": pm.Coolant, "operation.strategy": pm.Strategy, "operation.edge_rule": pm.EdgeRule,
         "operation.contour_direction": pm.CutDirection}
NESTED = {"selection": pm.Selection, "heights": pm.Heights, "leads": pm.Leads, "feeds": pm.Feeds}


def _or_none(value: float) -> float | None:
    return value if value else None


def _ball(values: Values, found: ToolData | None) -> pm.Tool:
    if found is None:
        found = ToolData(values["ToolName"], values["ToolDiameter"], values["ToolNumber"], 0.0, 0.0, values["SpindleSpeed"],
                         values["Feed"] * MM_PER_MIN, values["PlungeFeed"] * MM_PER_MIN)
    if not found.diameter_mm > 0.0:
        raise Problem(f"ToolDiameter is {found.diameter_mm:g} mm; it must be above 0: give the diameter of the ball.")
    return pm.ball(found.diameter_mm, number=found.number or None, name=wire_name(found.name), spindle_rpm=_or_none(found.spindle_rpm),
                   feed_mm_per_min=_or_none(_round(found.feed_mm_per_min)),
                   plunge_feed_mm_per_min=_or_none(_round(found.plunge_feed_mm_per_min)),
                   flute_length_mm=_or_none(found.flute_length_mm), shank_diameter_mm=_or_none(found.shank_diameter_mm))


def wire_name(name: str) -> str:
    """A name as the contract allows it: at most 100 bytes."""
    return name.encode()[:100].decode(errors="ignore")


def _round(value: float) -> float:
    """1000 mm/min is not a whole number of mm/s: the ninth digit is not meant."""
    return round(value, 6)


def _holder(lines: Sequence[str]) -> list[pm.HolderSegment]:
    segments = []
    for k, line in enumerate(lines):
        try:
            numbers = [float(word) for word in line.split(",")]
        except ValueError:
            numbers = []
        if len(numbers) not in (2, 3):
            raise Problem(f"Holder[{k}] is '{line}'; it must be LENGTH,DIAMETER or LENGTH,LOWER,UPPER in mm, such as 20,28.")
        segments.append(pm.HolderSegment(length_mm=numbers[0], lower_diameter_mm=numbers[1], upper_diameter_mm=numbers[-1]))
    return segments


def _rectangle(box: Rectangle) -> list[list[float]]:
    x0, y0, x1, y1 = box
    return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]


def _stock(values: Values, found: StockData | None) -> pm.Stock | None:
    kind, fields = values["StockKind"], {}
    top = values["StockTop"] if values["StateStockTop"] else None
    if kind == "Block":
        fields["block"] = pm.BlockStock(margin_mm=values["BlockMargin"])
    elif kind == "Cylinder":
        fields["cylinder"] = pm.CylinderStock(diameter_mm=values["CylinderDiameter"])
    elif kind == "Job":
        if found is None:
            raise Problem("StockKind is Job; the operation must then be in a job of FreeCAD with a stock: add it to a job, or choose "
                          "another StockKind.")
        top = found.top_mm if top is None else top
        if found.diameter_mm:
            x0, y0, x1, y1 = found.box
            fields["cylinder"] = pm.CylinderStock(diameter_mm=found.diameter_mm, center_xy_mm=[0.5 * (x0 + x1), 0.5 * (y0 + y1)])
        else:
            fields["outline"] = pm.OutlineStock(outline_xy_mm=_rectangle(found.box))
    if kind == "Allowance" or (kind != "Not stated" and not values["StockIsWhole"]):
        fields["allowance_mm"] = values["Allowance"]
        if values["FloorAllowance"]:
            fields["floor_allowance_mm"] = values["FloorAllowance"]
    if top is not None:
        fields["top_z_mm"] = top
    return pm.Stock(**fields) if fields else None


def _zero(values: Values) -> dict[str, Any]:
    kind = values["ProgramZero"]
    if kind == "Not stated":
        return {}
    if kind == "Point":
        return {"program_zero": pm.Point3(*values["ZeroPoint"])}
    return {"zero_anchor": pm.ZeroAnchor[{"Origin": "ORIGIN", "Top centre": "TOP_CENTER", "Bottom corner": "BOTTOM_CORNER"}[kind]]}


def _set(target: Any, path: list[str], value: Any) -> None:
    for name in path[:-1]:
        if getattr(target, name) is None:
            setattr(target, name, NESTED[name]())
        target = getattr(target, name)
    setattr(target, path[-1], value)


def _fill(roots: dict[str, Any], options: Sequence[Option], values: Values) -> None:
    for option in options:
        if not option.field:
            continue
        value = values[option.name]
        if isinstance(value, float) and not math.isfinite(value):
            raise Problem(f"{option.name} is {value}; it must be a number.")
        sent = option.sent(value)
        if sent is None:
            continue
        root, *path = option.field.split(".")
        _set(roots[root], path, ENUMS[option.field][sent] if option.field in ENUMS else sent)


def _selection(operation: pm.Operation, values: Values, links: Links) -> None:
    if links.patch_ids:
        _set(operation, ["selection", "patch_ids"], list(links.patch_ids))
    if links.avoid_ids:
        _set(operation, ["selection", "avoid_patch_ids"], list(links.avoid_ids))
    if links.boundary:
        rings = [[coordinate for point in ring for coordinate in point] for ring in links.boundary]
        _set(operation, ["selection", "boundary_xy_mm"], rings[0])
        if len(rings) > 1:
            _set(operation, ["selection", "more_boundary_rings"], [pm.Ring(xy_mm=ring) for ring in rings[1:]])
        mode = {"Centre": "CENTER", "Contact": "CONTACT", "Inside": "INSIDE", "Outside": "OUTSIDE"}[values["BoundaryMode"]]
        _set(operation, ["selection", "boundary_mode"], pm.BoundaryMode[mode])
        if values["BoundaryOffset"]:
            _set(operation, ["selection", "boundary_offset_mm"], values["BoundaryOffset"])
    for limit, value, name in (("LimitFloor", "Floor", "floor_z_mm"), ("LimitTop", "Top", "top_z_mm")):
        if values[limit]:
            _set(operation, ["heights", name], values[value])


def _post_text(values: Values) -> str:
    if not values["PostFile"]:
        return ""
    try:
        return pathlib.Path(values["PostFile"]).read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise Problem(f"PostFile '{values['PostFile']}' cannot be read ({error}): give a post file, or leave PostFile empty.") from None


def job_request(values: Values, links: Links = Links(), options: Sequence[Option] = OPERATION) -> JobRequest:
    """The job that the properties state."""
    tool = _ball(values, links.tool)
    operation, setup, post = pm.Operation(tool=tool), pm.Setup(**_zero(values)), pm.Post()
    imported = pm.ImportOptions()
    _fill({"operation": operation, "setup": setup, "post": post, "tool": tool, "import": imported}, options, values)
    if values["Holder"]:
        tool.holder = _holder(values["Holder"])
    stock = _stock(values, links.stock)
    if stock is not None:
        setup.stock = stock
    if links.clamps:
        setup.obstacles = [pm.Obstacle(id=clamp.name, outline_xy_mm=_rectangle(clamp.box), top_z_mm=clamp.top_mm) for clamp in links.clamps]
    _selection(operation, values, links)
    text = _post_text(values)
    if text:
        post.post_file, post.dialect = text, ""
    if values.get("Inch"):
        post.unit = pm.LengthUnit.INCH
    return JobRequest(operation, setup, post, imported if values["BorderTolerance"] else None)


def verification_arguments(values: Values, links: Links = Links()) -> tuple[JobRequest, dict[str, Any]]:
    """The job of a program to verify, and the arguments of Client.verify besides model, program and tools."""
    request = job_request(values, links, VERIFICATION)
    operation, heights, feeds = request.operation, request.operation.heights or pm.Heights(), request.operation.feeds or pm.Feeds()
    fields = {
        "tolerance_mm": operation.tolerance_mm, "scallop_mm": operation.scallop_mm if values["CheckFinish"] else None,
        "setup": request.setup, "dialect": request.post.dialect or "", "post_file": request.post.post_file or "",
        "stock_to_leave_mm": operation.stock_to_leave_mm, "floor_z_mm": heights.floor_z_mm, "top_z_mm": heights.top_z_mm,
        "strategy": operation.strategy or pm.Strategy.UNSPECIFIED, "zigzag_angle_deg": operation.zigzag_angle_deg,
        "steep_angle_deg": operation.steep_angle_deg, "detail": operation.detail, "selection": operation.selection,
        "control_deviation_mm": request.post.control_deviation_mm, "assume_exact_path": values["AssumeExactPath"],
        "accept_depth_mm": operation.accept_depth_mm or 0.0, "keep_feed_on_passes": bool(feeds.keep_on_passes or values["KeepFeed"]),
    }
    return request, fields

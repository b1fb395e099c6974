"""The 3-D page: writes the scene that clients/viewer shows, in the format of its SCENE.md."""
from __future__ import annotations

import base64
import gzip
import html
import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._text import figures_of, region_name
from .errors import PatchmillError
from .messages import BorderKind, Diagnostic, Outcome, Region, RegionKind, RegionMap, Report, Setup, Severity, Slope, Tool
from .messages import UnreachableReason
from .meshes import Mesh
from .paths import Path

Json = dict[str, Any]
Rgb = tuple[int, int, int]
BETWEEN_PASSES = 255
CYLINDER_CORNERS = 96
PASS_NAMES = ["zig-zag", "contour", "border", "pencil", "rest"]
REGION_COLORS: dict[RegionKind, tuple[Rgb, Rgb]] = {  # steep, gentle
    RegionKind.MOUNTAIN: ((230, 120, 95), (250, 205, 175)),
    RegionKind.BASIN: ((95, 145, 225), (180, 212, 250)),
    RegionKind.NEUTRAL: ((120, 185, 110), (205, 232, 195)),
}
REASON_COLORS: dict[UnreachableReason, Rgb] = {
    UnreachableReason.CONCAVE: (150, 120, 165), UnreachableReason.FLOOR: (165, 150, 105), UnreachableReason.SHANK: (95, 145, 140),
    UnreachableReason.HOLDER: (70, 110, 150), UnreachableReason.OUTSIDE: (175, 175, 180),
}
BORDER_COLORS = {
    BorderKind.SLOPE: "#c2410c", BorderKind.CURVATURE: "#0f766e", BorderKind.SILHOUETTE: "#7c3aed", BorderKind.WATERSHED: "#1d4ed8",
    BorderKind.SEAM: "#be185d", BorderKind.STRATEGY: "#854d0e", BorderKind.OPEN_EDGE: "#808080",
}


@dataclass(frozen=True)
class Scene:
    """What a page shows."""

    title: str
    mesh: Mesh
    version: str = ""  # of the server; empty if it is not known
    setup: Setup | None = None
    tool: Tool | None = None
    tolerance_mm: float = 0.01
    scallop_mm: float | None = None
    steep_angle_deg: float = 45.0
    regions: RegionMap | None = None
    path: Path | None = None
    program: bytes = b""
    report: Report | None = None
    findings: Sequence[Diagnostic] = ()


@dataclass
class Buffers:
    """The binary block, and the table of what lies where in it."""

    table: Json = field(default_factory=dict)
    parts: list[bytes] = field(default_factory=list)
    size: int = 0

    def add(self, name: str, kind: str, values: Any) -> None:
        types = {"f32": "<f4", "u32": "<u4", "i32": "<i4", "u8": "u1"}
        data = np.ascontiguousarray(values, dtype=types[kind]).ravel()
        self.table[name] = {"type": kind, "offset": self.size, "count": data.size}
        part = data.tobytes()
        part += bytes(-len(part) % 4)
        self.parts.append(part)
        self.size += len(part)

    def base64(self) -> str:
        return base64.b64encode(gzip.compress(b"".join(self.parts), compresslevel=1, mtime=0)).decode("ascii")


def region_color(region: Region) -> str:
    steep, gentle = REGION_COLORS.get(region.kind, ((120, 120, 120), (120, 120, 120)))
    rgb = steep if region.slope == Slope.STEEP else gentle
    if region.kind == RegionKind.UNREACHABLE:
        rgb = REASON_COLORS.get(region.unreachable_reason, rgb)
    if region.unreachable_reason == UnreachableReason.STRATEGY:
        rgb = (245, 220, 90)
    shift = (region.id % 3 - 1) * 9
    return "#" + "".join(f"{min(255, max(0, c + shift)):02x}" for c in rgb)


def _region_items(regions: RegionMap | None) -> list[Json]:
    return [{"id": r.id, "name": f"{r.id} {region_name(r)}", "color": region_color(r),
             "unreachable": r.unreachable_reason.name if r.kind == RegionKind.UNREACHABLE else ""}
            for r in (regions.regions if regions else ())]


def _closed(points: NDArray[np.float64], is_closed: bool) -> NDArray[np.float64]:
    return np.concatenate([points, points[:1]]) if is_closed else points


def _borders(regions: RegionMap | None, buffers: Buffers) -> list[Json]:
    lines = [(line.kind, _closed(line.points_mm, line.closed)) for line in (regions.border_lines if regions else ())]
    lengths: dict[BorderKind, float] = {}
    for kind, points in lines:
        lengths[kind] = lengths.get(kind, 0.0) + float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    drawn = [(kind, points) for kind, points in lines if len(points) >= 2]
    items, first = [], 0
    for kind, points in drawn:
        name = kind.name.lower().replace("_", " ")
        items.append({"name": f"{name}: {lengths[kind]:.1f} mm", "color": BORDER_COLORS.get(kind, "#303030"), "first": first,
                      "count": len(points)})
        first += len(points)
    buffers.add("border.position", "f32", np.concatenate([points for _, points in drawn]) if drawn else [])
    return items


def _surfaces(mesh: Mesh, buffers: Buffers) -> list[str]:
    buffers.add("mesh.position", "f32", mesh.position_mm)
    buffers.add("mesh.normal", "f32", mesh.normal)
    buffers.add("mesh.slope", "f32", mesh.slope_deg)
    # The page counts outward bends as positive.
    buffers.add("mesh.curvature", "f32", -mesh.contour_curvature_per_mm)
    if mesh.leftover_mm is not None:
        buffers.add("mesh.leftover", "f32", mesh.leftover_mm)
    if mesh.gouge_mm is not None:
        buffers.add("mesh.gouge", "f32", mesh.gouge_mm)
    buffers.add("mesh.index", "u32", mesh.corners)
    buffers.add("mesh.region", "i32", mesh.region_id)
    buffers.add("mesh.surface", "u32", mesh.patch_index)
    count = max(len(mesh.patch_names), int(mesh.patch_index.max(initial=-1)) + 1)
    names = mesh.patch_names + [""] * (count - len(mesh.patch_names))
    return [name or f"patch {k}" for k, name in enumerate(names)]


def _sections(path: Path) -> list[Json]:
    """A section begins where the region or the kind of the passes changes."""
    moves = np.flatnonzero(path.pass_kind)
    kinds, regions = path.pass_kind[moves], path.region_id[moves]
    begins = np.ones(len(moves), dtype=bool)
    begins[1:] = (kinds[1:] != kinds[:-1]) | (regions[1:] != regions[:-1])
    sections = []
    for move, kind, region in zip(moves[begins].tolist(), kinds[begins].tolist(), regions[begins].tolist()):
        passes = f"{PASS_NAMES[kind - 1] if kind <= len(PASS_NAMES) else 'other'} passes"
        sections.append({"name": passes if region < 0 else f"region {region}: {passes}", "first_move": move})
    return sections


def _moves(path: Path, buffers: Buffers) -> None:
    buffers.add("path.tip", "f32", path.tip_mm)
    buffers.add("path.kind", "u8", path.kind)
    buffers.add("path.pass_kind", "u8", np.where(path.pass_kind > 0, path.pass_kind - 1, BETWEEN_PASSES))
    buffers.add("path.region", "i32", path.region_id)
    buffers.add("path.pass", "i32", path.pass_index)
    buffers.add("path.feed", "f32", path.feed_mm_per_min)
    buffers.add("path.seconds", "f32", path.seconds)
    buffers.add("path.line", "u32", path.line)
    arcs = np.flatnonzero(path.arc_plane)
    if arcs.size:
        buffers.add("arc.move", "u32", arcs)
        buffers.add("arc.plane", "u8", path.arc_plane[arcs])
        buffers.add("arc.center", "f32", path.arc_center_mm[arcs])
        buffers.add("arc.turns", "f32", path.arc_turns[arcs])


def _tool_item(tool: Tool | None) -> Json:
    diameter = tool.ball_end.diameter_mm if tool and tool.ball_end else 6.0
    profile: list[list[float]] = []
    height = 0.0
    for segment in tool.holder if tool else ():
        profile.append([height, segment.lower_diameter_mm / 2.0])
        height += segment.length_mm
        profile.append([height, segment.upper_diameter_mm / 2.0])
    shank = tool.shank_diameter_mm if tool else None
    return {"ball_diameter": diameter, "flute_length": tool.flute_length_mm if tool else None,
            "shank_diameter": diameter if shank is None else shank,
            "holder": {"stickout": tool.stickout_mm or 0.0, "profile": profile} if tool and profile else None}


def _outline(xy: Any) -> list[list[float]]:
    rows: list[list[float]] = np.asarray(xy, dtype=float).reshape(-1, 2).tolist()
    return rows


def _stock_outline(scene: Scene, setup: Setup, low: NDArray[Any], high: NDArray[Any]) -> list[list[float]] | None:
    stock = setup.stock
    if stock is not None and stock.model is not None:
        sheet = scene.report.setup_sheet if scene.report else None
        box = sheet.stock_model_box if sheet else None
        if box is None or box.min is None or box.max is None:
            return None
        (x0, y0), (x1, y1) = (box.min.x_mm, box.min.y_mm), (box.max.x_mm, box.max.y_mm)
        return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    if stock is not None and stock.block is not None:
        m = stock.block.margin_mm
        (x0, y0), (x1, y1) = (low[:2] - m).tolist(), (high[:2] + m).tolist()
        return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    if stock is not None and stock.outline is not None:
        return _outline(stock.outline.outline_xy_mm)
    if stock is not None and stock.cylinder is not None:
        stated = _outline(stock.cylinder.center_xy_mm)
        x, y = stated[0] if stated else (0.5 * (low + high))[:2].tolist()
        r = 0.5 * stock.cylinder.diameter_mm
        angles = [2.0 * math.pi * k / CYLINDER_CORNERS for k in range(CYLINDER_CORNERS)]
        return [[x + r * math.cos(a), y + r * math.sin(a)] for a in angles]
    return None


def _stock_item(scene: Scene, low: NDArray[Any], high: NDArray[Any]) -> Json | None:
    """The stock has no lower end; it is drawn down to the lowest point of the part.

    A stock with a model of its own is drawn as the box of that.
    """
    outline = _stock_outline(scene, scene.setup, low, high) if scene.setup else None
    if outline is None or scene.setup is None or scene.setup.stock is None:
        return None
    sheet = scene.report.setup_sheet if scene.report else None
    stated = scene.setup.stock.top_z_mm
    top = sheet.stock_top_z_mm if sheet else (float(high[2]) if stated is None else stated)
    return {"bottom": float(low[2]), "top": top, "outline": outline}


def _clamp_items(setup: Setup | None) -> list[Json]:
    return [{"name": o.id or f"obstacle #{k}", "outline": _outline(o.outline_xy_mm), "top": o.top_z_mm}
            for k, o in enumerate(setup.obstacles if setup else ())]


def _finding_item(finding: Diagnostic) -> Json:
    point = finding.where.point if finding.where else None
    severity = finding.severity.name if finding.severity in (Severity.ERROR, Severity.WARNING) else "INFO"
    return {"severity": severity, "code": finding.code, "message": finding.message,
            "point": [point.x_mm, point.y_mm, point.z_mm] if point else None}


def pack(scene: Scene) -> tuple[Json, Buffers]:
    """The header and the block of a scene."""
    buffers = Buffers()
    low, high = (np.asarray(f(scene.mesh.position_mm, axis=0), dtype=float) for f in (np.min, np.max))
    surfaces = _surfaces(scene.mesh, buffers)
    borders = _borders(scene.regions, buffers)
    if scene.path is not None:
        _moves(scene.path, buffers)
    if scene.program:
        buffers.add("program.text", "u8", np.frombuffer(scene.program, dtype=np.uint8))
    report = scene.report if scene.report and scene.report.outcome != Outcome.UNSPECIFIED else None
    is_known = scene.path is not None and bool(scene.path.pass_kind.any())
    header = {
        "version": 1, "title": scene.title, "made_by": f"patchmill {scene.version}".strip(), "data_encoding": "gzip",
        "outcome": report.outcome.name if report else "", "time_basis": report.time_basis if report else "",
        "figures": figures_of(report) if report else [], "findings": [_finding_item(f) for f in scene.findings],
        "box": {"min": low.tolist(), "max": high.tolist()}, "tolerance": scene.tolerance_mm, "scallop": scene.scallop_mm,
        "steep_angle": scene.steep_angle_deg, "tool": _tool_item(scene.tool), "stock": _stock_item(scene, low, high),
        "clamps": _clamp_items(scene.setup), "regions": _region_items(scene.regions), "surfaces": surfaces, "borders": borders,
        "passes": PASS_NAMES if is_known else [], "sections": _sections(scene.path) if scene.path is not None else [],
        "buffers": buffers.table,
    }
    return header, buffers


def make_page(scene: Scene) -> str:
    """The page as one HTML file that needs no network."""
    template = resources.files("patchmill") / "viewer.html"
    if not template.is_file():
        raise PatchmillError("This patchmill was built without the 3-D page; build the wheel with Node.js (clients/python/README.md).")
    header, buffers = pack(scene)
    # No text of a client may end the script that holds the header.
    text = json.dumps(header, allow_nan=False).replace("<", "\\u003c")
    before, _, rest = template.read_text(encoding="utf-8").partition("@PATCHMILL_SCENE@")
    between, _, after = rest.partition("@PATCHMILL_DATA@")
    return "".join((before, text, between, buffers.base64(), after))


def in_frame(page: str, height_px: int = 640) -> str:
    """The page for a notebook: in a frame of its own, which may run its own script and nothing else."""
    return (f'<iframe sandbox="allow-scripts" style="width: 100%; height: {height_px}px; border: 1px solid #8888" '
            f'title="Part and program in 3-D" srcdoc="{html.escape(page, quote=True)}"></iframe>')

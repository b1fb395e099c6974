"""The properties of an operation: name, group, type, default, and the field of the contract that each
becomes.

This file knows neither FreeCAD nor the package: types and enumerators are names. A property is sent if it
differs from its default, which is the default of the service. So a job has the same bytes as that of the
command line in which the same options are left out.
"""
from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

PART, TOOL, FINISH, STOCK, MOTION, PROGRAM, RESULT = "Part", "Tool", "Finish", "Stock", "Motion", "Program", "Result"
MM_PER_MIN = 60.0  # FreeCAD has speeds in mm/s


@dataclass(frozen=True)
class Option:
    """A property.

    name, group, kind, text: of the property in FreeCAD; `kind` is its type without "App::Property".
    default: its first value. For an enumeration: the first of the choices.
    field: the field of the contract, "" if job.py treats the property by itself.
    choices: of an enumeration: what the user reads, and the enumerator of the contract.
    factor: from FreeCAD's unit to that of the contract.
    required: it is sent even if it is as before.
    """

    name: str
    group: str
    kind: str
    default: Any
    text: str
    field: str = ""
    choices: tuple[tuple[str, str], ...] = ()
    factor: float = 1.0
    required: bool = False

    def sent(self, value: Any) -> Any:
        """The value on the wire, enumerators by their names; None if it is left out."""
        if self.choices:
            chosen = dict(self.choices)[value]
            return None if value == self.choices[0][0] and not self.required else chosen
        if value == self.default and not self.required:
            return None
        return value * self.factor if self.factor != 1.0 else value


def _same(*names: str) -> tuple[tuple[str, str], ...]:
    return tuple((name, name) for name in names)


PART_OPTIONS = (
    Option("Part", PART, "LinkSubGlobal", None, "Body to mill. With faces: only these faces are milled, the others are kept"),
    Option("Avoid", PART, "LinkSubGlobal", None, "Faces of the same body that the tool keeps off"),
    Option("AvoidMargin", PART, "Length", 0.0, "Distance between the tool and the faces of Avoid", "operation.selection.avoid_margin_mm"),
    Option("UpAxis", PART, "Enumeration", "Z", "Axis of the document that points up on the machine", "setup.up",
           (("Z", "Z"), ("Y", "Y"), ("X", "X"), ("-Z", "NEG_Z"), ("-Y", "NEG_Y"), ("-X", "NEG_X"))),
    Option("ProgramZero", PART, "Enumeration", "Not stated", "Where X0 Y0 Z0 of the program lies. Not stated: the origin, with a warning",
           "", (("Not stated", ""), ("Origin", "ORIGIN"), ("Top centre", "TOP_CENTER"), ("Bottom corner", "BOTTOM_CORNER"), ("Point", ""))),
    Option("ZeroPoint", PART, "Vector", (0.0, 0.0, 0.0), "Place of X0 Y0 Z0, turned by UpAxis, if ProgramZero is Point"),
    Option("BorderTolerance", PART, "Length", 0.0, "How far borders of patches may lie from the edges of faces. 0: 0.0001 mm",
           "import.border_tolerance_mm"),
    Option("CapHoles", PART, "Length", 0.0, "Round holes of at most this diameter are closed, and the finish runs over them. 0: none",
           "setup.cap_holes_mm"),
    Option("MillOutside", PART, "Bool", False, "Mill upright walls on the outer border, too", "operation.selection.mill_outside"),
)

TOOL_OPTIONS = (
    Option("ToolController", TOOL, "LinkGlobal", None, "Tool controller of a job: its tool and feeds"),
    Option("ToolDiameter", TOOL, "Length", 6.0, "Diameter of the ball"),
    Option("ToolNumber", TOOL, "Integer", 0, "Number of the tool in the program. 0: T1, with a warning"),
    Option("ToolName", TOOL, "String", "", "Name of the tool in the header of the program"),
    Option("Feed", TOOL, "Speed", 0.0, "Cutting feed. 0: 1200 mm/min at D 6, with a warning"),
    Option("PlungeFeed", TOOL, "Speed", 0.0, "Feed of steep descents. 0: a third of Feed, with a warning"),
    Option("SpindleSpeed", TOOL, "Float", 0.0, "Spindle speed, rpm. 0: 12000 at D 6, with a warning"),
    Option("CoolantMode", TOOL, "Enumeration", "None", "Coolant while cutting", "tool.coolant",
           (("None", "OFF"), ("Flood", "FLOOD"), ("Mist", "MIST"), ("Air", "AIR"))),
    Option("FluteLength", TOOL, "Length", 0.0, "Length of the flutes from the tip. 0: unknown, and not checked", "tool.flute_length_mm"),
    Option("ShankDiameter", TOOL, "Length", 0.0, "Diameter above the flutes. 0: as wide as the ball", "tool.shank_diameter_mm"),
    Option("Stickout", TOOL, "Length", 0.0, "Length from tip to holder. 0: unknown", "tool.stickout_mm"),
    Option("Holder", TOOL, "StringList", (), "Segments of the holder from below, mm: LENGTH,DIAMETER or LENGTH,LOWER,UPPER"),
    Option("HolderClearance", TOOL, "Length", 0.0, "Distance kept around the holder. 0: 0.5 mm, or the allowance if that is more",
           "tool.holder_clearance_mm"),
)

FINISH_OPTIONS = (
    Option("Scallop", FINISH, "Length", 0.01, "Height of the ridges between passes", "operation.scallop_mm", required=True),
    Option("Tolerance", FINISH, "Length", 0.01, "Whole error budget", "operation.tolerance_mm", required=True),
    Option("StockToLeave", FINISH, "Length", 0.0, "Material that stays, along the normal", "operation.stock_to_leave_mm"),
    Option("SteepAngle", FINISH, "Angle", 45.0, "Slope from which on contours (waterlines) cut", "operation.steep_angle_deg"),
    Option("Detail", FINISH, "Float", 0.5, "How finely the surface is divided into regions, 0 to 1", "operation.detail"),
    Option("Strategy", FINISH, "Enumeration", "Auto", "Contours on steep and zig-zag lines on gentle areas, or one of them everywhere",
           "operation.strategy", (("Auto", "AUTO"), ("Contour", "CONTOUR"), ("Zig-zag", "ZIGZAG"))),
    Option("ZigzagAngle", FINISH, "Angle", 0.0, "Direction of zig-zag lines from X, counter-clockwise", "operation.zigzag_angle_deg"),
    Option("ZigzagAngleAuto", FINISH, "Bool", False, "Lines of each region run in the direction that takes the least time",
           "operation.zigzag_angle_auto"),
    Option("Bend", FINISH, "Angle", 20.0, "How far lines may turn from that direction, 0 to 30 degrees", "operation.zigzag_bend_deg"),
    Option("OneWay", FINISH, "Bool", False, "Cut all lines in one direction", "operation.one_way_lines"),
    Option("Spirals", FINISH, "Bool", False, "Wind closed contours into one helical pass", "operation.contour_spirals"),
    Option("CircularLines", FINISH, "Bool", True, "Circular lines on rims and shoulders where they are shorter", "operation.round_lines"),
    Option("BorderPasses", FINISH, "Bool", True, "Passes along borders where zig-zag lines end", "operation.border_passes"),
    Option("OpenEdges", FINISH, "Enumeration", "Stop", "Stop at open edges, roll over them, or extend passes beyond them",
           "operation.edge_rule", (("Stop", "STOP"), ("Roll", "ROLL"), ("Extend", "EXTEND"))),
    Option("Direction", FINISH, "Enumeration", "Climb", "Direction of contours", "operation.contour_direction",
           (("Climb", "CLIMB"), ("Conventional", "CONVENTIONAL"), ("Either", "EITHER"))),
    Option("MaxUnreached", FINISH, "Float", 50.0, "Largest share of what looks up that may stay uncut, percent",
           "operation.max_unreached_fraction", factor=0.01),
    Option("LimitFloor", FINISH, "Bool", False, "The tip stays above Floor. Else: above the lowest point of the part"),
    Option("Floor", FINISH, "Distance", 0.0, "Lowest tip, if LimitFloor is set"),
    Option("LimitTop", FINISH, "Bool", False, "The tip stays below Top while it cuts"),
    Option("Top", FINISH, "Distance", 0.0, "Highest tip of a cutting ball, if LimitTop is set"),
    Option("Boundary", FINISH, "LinkGlobal", None, "Sketch or closed wires that limit the operation in plan"),
    Option("BoundaryMode", FINISH, "Enumeration", "Centre", "What the boundary limits: tool axis, contacts, or the ball seen from above",
           "", (("Centre", "CENTER"), ("Contact", "CONTACT"), ("Inside", "INSIDE"), ("Outside", "OUTSIDE"))),
    Option("BoundaryOffset", FINISH, "Distance", 0.0, "Offset of the boundary; above 0 widens it"),
)

STOCK_OPTIONS = (
    Option("StockKind", STOCK, "Enumeration", "Not stated",
           "Material before the operation. Allowance: a layer on the part. Job: the stock of the job of FreeCAD", "",
           _same("Not stated", "Allowance", "Block", "Cylinder", "Job")),
    Option("StockIsWhole", STOCK, "Bool", False, "Nothing has been cut from the stock yet. Else: it has been roughed to Allowance"),
    Option("Allowance", STOCK, "Length", 0.5, "Material on the part, along the normal"),
    Option("FloorAllowance", STOCK, "Length", 0.0, "Material on floors where it differs; Allowance is then that of walls. 0: Allowance"),
    Option("BlockMargin", STOCK, "Length", 0.0, "Margin of the block around the part"),
    Option("CylinderDiameter", STOCK, "Length", 100.0, "Diameter of the cylinder around the part"),
    Option("StateStockTop", STOCK, "Bool", False, "Nothing lies above StockTop. Else: above the top of the part and the allowance"),
    Option("StockTop", STOCK, "Distance", 0.0, "Top of the stock, if StateStockTop is set"),
    Option("AcceptDepth", STOCK, "Length", 0.0, "How deep passes may cut into stated stock where that is more than the allowance",
           "operation.accept_depth_mm"),
    Option("Clamps", STOCK, "LinkListGlobal", (), "Bodies that the tool keeps off: the box around each, from its top down"),
)

MOTION_OPTIONS = (
    Option("Clearance", MOTION, "Length", 5.0, "Height of the clearance plane above part, stock and clamps",
           "operation.heights.clearance_above_mm"),
    Option("HighRapids", MOTION, "Bool", False, "All rapids at the clearance plane", "operation.heights.high_rapids"),
    Option("ApproachGap", MOTION, "Length", 0.0, "Distance from the stock at which rapids change to feed. 0: 1 mm",
           "operation.heights.approach_gap_mm"),
    Option("LeadRadius", MOTION, "Length", 0.0, "Radius of the arcs onto passes. 0: half that of the ball", "operation.leads.radius_mm"),
    Option("LeadSweep", MOTION, "Angle", 90.0, "Sweep of these arcs, 10 to 90 degrees", "operation.leads.sweep_deg"),
    Option("LeadFeed", MOTION, "Speed", 0.0, "Feed of leads. 0: the cutting feed", "operation.feeds.lead_mm_per_min", factor=MM_PER_MIN),
    Option("LinkFeed", MOTION, "Speed", 0.0, "Feed of links between passes. 0: the cutting feed", "operation.feeds.link_mm_per_min",
           factor=MM_PER_MIN),
    Option("CornerFeed", MOTION, "Speed", 0.0, "Lowest feed in inner corners of passes. 0: the cutting feed",
           "operation.feeds.corner_mm_per_min", factor=MM_PER_MIN),
    Option("KeepFeed", MOTION, "Bool", False, "Passes keep the feed on steep descents; needs stock", "operation.feeds.keep_on_passes"),
    Option("PlungeAngle", MOTION, "Angle", 30.0, "Descents steeper than this run at plunge feed, 1 to 30 degrees",
           "operation.feeds.plunge_angle_deg"),
)

DIALECTS = {"linuxcnc": ".ngc", "grbl": ".gcode", "fanuc": ".nc", "haas": ".nc", "heidenhain": ".h", "siemens": ".mpf", "mach3": ".tap"}

DIALECT_OPTIONS = (
    Option("Dialect", PROGRAM, "Enumeration", "linuxcnc", "Control that the program is for", "post.dialect", _same(*DIALECTS)),
    Option("PostFile", PROGRAM, "File", "", "Post file of your own; Dialect is not used then"),
    Option("ControlDeviation", PROGRAM, "Length", 0.0, "By how much the control leaves the path. 0: exact stop where it cannot be stated",
           "post.control_deviation_mm"),
)

PROGRAM_OPTIONS = DIALECT_OPTIONS + (
    Option("WorkOffset", PROGRAM, "Enumeration", "G54", "Work offset", "post.work_offset", _same("G54", "G55", "G56", "G57", "G58", "G59")),
    Option("Arcs", PROGRAM, "Bool", True, "Write arcs (G2, G3) where the control has them", "post.arcs"),
    Option("Inch", PROGRAM, "Bool", False, "Write the program in inches"),
    Option("RestartPoints", PROGRAM, "Bool", False, "Write places where the control may be started again", "post.restart_points"),
    Option("LineNumbers", PROGRAM, "Integer", -1, "Step of line numbers. 0: none. -1: as the control has them", "post.line_number_step"),
    Option("ProgramNumber", PROGRAM, "Integer", 1, "Number of the program, for controls that number their programs", "post.program_number"),
    Option("ProgramFile", PROGRAM, "File", "", "File of the program. Empty: beside the document, with the label of the operation"),
    Option("ReportFile", PROGRAM, "File", "", "File of the report (.json). Empty: none"),
    Option("PageFile", PROGRAM, "File", "", "File of a page that shows part and program in 3-D (.html). Empty: none"),
    Option("ModelFile", PROGRAM, "File", "", "File of the part as it was sent (.step), for the command line. Empty: none"),
)

RESULT_OPTIONS = (
    Option("Outcome", RESULT, "String", "", "What has become of the job"),
    Option("Findings", RESULT, "StringList", (), "Assumptions, warnings and errors"),
    Option("LargestGouge", RESULT, "Length", 0.0, "How deep the tool cuts into the part at most"),
    Option("LargestLeftover", RESULT, "Length", 0.0, "How much stays at most where the ball reaches"),
    Option("NotReached", RESULT, "String", "", "Area that the ball does not reach"),
    Option("CycleTime", RESULT, "String", "", "Time of the program"),
    Option("WrittenFile", RESULT, "String", "", "File of the program that was written last"),
)

# `Active` and `ToolController` are what FreeCAD's own post processors look for.
COMMON = (Option("Active", PART, "Bool", True, "Inactive operations are neither computed nor post-processed"),)
OPERATION = COMMON + PART_OPTIONS + TOOL_OPTIONS + FINISH_OPTIONS + STOCK_OPTIONS + MOTION_OPTIONS + PROGRAM_OPTIONS + RESULT_OPTIONS

VERIFICATION = COMMON + PART_OPTIONS + TOOL_OPTIONS + FINISH_OPTIONS + STOCK_OPTIONS + DIALECT_OPTIONS + (
    Option("CheckFinish", FINISH, "Bool", True, "Compare what is left with Scallop. Else: gouges and unsafe motion only"),
    Option("KeepFeed", MOTION, "Bool", False, "Feeds may descend steeply at any feed; needs stated stock"),
    Option("AssumeExactPath", PROGRAM, "Bool", False, "Take a program that states no path mode as one with exact path"),
    Option("ProgramFile", PROGRAM, "File", "", "Program to verify, of any post processor"),
    Option("ReportFile", PROGRAM, "File", "", "File of the report (.json). Empty: none"),
    Option("PageFile", PROGRAM, "File", "", "File of a page that shows part and program in 3-D (.html). Empty: none"),
) + tuple(option for option in RESULT_OPTIONS if option.name != "WrittenFile")


def property_of(field: str) -> str:
    """The name of the property that becomes a field of the contract; "" if none does."""
    path = field.replace("job.operations[0].", "operation.").replace("job.setup.", "setup.").replace("operation.tool.", "tool.")
    path = path.replace("tools[0].", "tool.")
    by_hand = {
        "tool.ball_end.diameter_mm": "ToolDiameter", "tool.number": "ToolNumber", "tool.spindle_rpm": "SpindleSpeed",
        "tool.feed_mm_per_min": "Feed", "tool.plunge_feed_mm_per_min": "PlungeFeed", "tool.holder": "Holder",
        "setup.stock.allowance_mm": "Allowance", "setup.stock.wall_allowance_mm": "Allowance",
        "setup.stock.floor_allowance_mm": "FloorAllowance",
        "setup.stock.top_z_mm": "StockTop", "setup.stock.block.margin_mm": "BlockMargin",
        "setup.stock.cylinder.diameter_mm": "CylinderDiameter", "setup.program_zero": "ZeroPoint", "setup.obstacles": "Clamps",
        "operation.heights.floor_z_mm": "Floor", "operation.heights.top_z_mm": "Top", "post.post_file": "PostFile",
        "operation.selection.boundary_xy_mm": "Boundary", "operation.selection.boundary_offset_mm": "BoundaryOffset",
        "operation.selection.patch_ids": "Part", "operation.selection.avoid_patch_ids": "Avoid",
        # verify names the same fields without the operation
        "floor_z_mm": "Floor", "top_z_mm": "Top",
    }
    by_hand.update({option.field: option.name for option in OPERATION if option.field})
    for candidate in (path, f"operation.{path}", f"post.{path}"):
        if candidate in by_hand:
            return by_hand[candidate]
        for known, name in by_hand.items():
            if candidate.startswith((f"{known}[", f"{known}.")):
                return name
    return ""


_OPTIONS = {"leave": "StockToLeave", "zero": "ProgramZero", "up": "UpAxis", "stock": "StockKind", "post": "Dialect", "edges": "OpenEdges",
            "outside": "MillOutside", "spindle": "SpindleSpeed", "coolant": "CoolantMode", "only": "Part", "auto-angle": "ZigzagAngleAuto",
            "no-round-lines": "CircularLines", "no-border-passes": "BorderPasses", "no-arcs": "Arcs", "obstacle": "Clamps"}
_NAMES = {option.name for option in OPERATION + VERIFICATION}
_OPTION = re.compile(r"--([a-z]+(?:-[a-z]+)*)")


def with_properties(text: str) -> str:
    """A message with the names of properties where it names options of the command line."""

    def name(option: re.Match[str]) -> str:
        camel = "".join(word.capitalize() for word in option[1].split("-"))
        found = _OPTIONS.get(option[1], camel)
        return found if found in _NAMES else option[0]

    return _OPTION.sub(name, text)

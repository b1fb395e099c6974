"""Numbers and names as the command line writes them."""
from __future__ import annotations

from collections.abc import Sequence

from .messages import Diagnostic, Region, RegionKind, Report, Severity, Where


def fixed(value: float, digits: int) -> str:
    """A number with so many digits after the point, and no -0."""
    return f"{0.0 if abs(value) < 0.5 * 10.0**-digits else value:.{digits}f}"


def uncut_share(report: Report) -> str:
    """'2.1 % of the area (CONCAVE 2.0 %, UNDERCUT 0.1 %)'."""
    total = report.total_area_mm2
    if not report.unreachable or not total > 0.0:
        return "nothing"

    def share(area_mm2: float) -> str:
        percent = 100.0 * area_mm2 / total
        return "less than 0.1 %" if percent < 0.1 else f"{percent:.1f} %"

    reasons = ", ".join(f"{part.reason.name} {share(part.area_mm2)}" for part in report.unreachable)
    return f"{share(report.unreachable_area_mm2)} of the area ({reasons})"


def figures_of(report: Report) -> list[tuple[str, str]]:
    """The figures of the summary of `mill`, in its words."""
    rows = [
        ("largest gouge", f"{fixed(report.max_gouge_mm, 4)} mm"),
        ("largest leftover", f"{fixed(report.max_leftover_mm, 4)} mm"),
        ("not reached", uncut_share(report)),
        ("lowest tip", f"Z {fixed(report.tip_z_min_mm, 4)}"),
        ("feed length", f"{fixed(report.cut_length_mm / 1000.0, 2)} m"),
        ("rapid length", f"{fixed(report.rapid_length_mm / 1000.0, 2)} m"),
    ]
    if report.estimated_time_s > 0.0:
        rows.append(("time", f"{fixed(report.estimated_time_s / 60.0, 1)} min ({report.time_basis})"))
    rows += [("retracts", str(report.retract_count)), ("stick-out at least", f"{fixed(report.required_stickout_mm, 1)} mm")]
    sheet = report.setup_sheet
    if sheet is not None and sheet.work_offset:
        rows.append(("work offset", sheet.work_offset))
    return rows


def place_of(where: Where | None) -> str:
    """'face f12', 'patch lid', 'line 7'; empty if the place is not known."""
    if where is None:
        return ""
    for name, value in (("face", where.face_id), ("patch", where.patch_id), ("patch", where.patch_index), ("line", where.line)):
        if value not in ("", None):
            return f"{name} {value}"
    return where.field


def finding_line(finding: Diagnostic) -> str:
    place = place_of(finding.where)
    return f"{finding.severity.name} {finding.code}{f' ({place})' if place else ''}: {finding.message}"


def finding_lines(findings: Sequence[Diagnostic], most: int = 5) -> list[str]:
    """Errors first, then warnings; informations are counted only."""
    shown = sorted((f for f in findings if f.severity >= Severity.WARNING), key=lambda f: -f.severity)
    lines = [finding_line(f) for f in shown[:most]]
    rest = len(shown) - len(lines)
    return lines + ([f"and {rest} more in .findings"] if rest > 0 else [])


def region_name(region: Region) -> str:
    if region.kind == RegionKind.UNREACHABLE:
        return (f"{region.unreachable_reason.name}: {fixed(region.area_mm2, 1)} mm2, "
                f"{fixed(region.deepest_leftover_mm, 2)} mm stays")
    return f"{region.kind.name}, {region.slope.name}".lower() + f": {fixed(region.area_mm2, 1)} mm2"

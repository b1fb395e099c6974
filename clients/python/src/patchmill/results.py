"""What the calls return. Results print well; in a notebook those with triangles show the 3-D page."""
from __future__ import annotations

import html
import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from google.protobuf import json_format

from ._file import write_file
from ._scene import Scene, in_frame, make_page
from ._text import figures_of, finding_lines, region_name, uncut_share
from .errors import NoProgramError, PatchmillError
from .messages import Accepted, ArcMove, BuildModelResponse, CheckModelResponse, CheckState, ConvertModelResponse, Diagnostic
from .messages import EditModelResponse, EvaluateSurfaceResponse, FairCurveResponse, FairNetResponse, Job, Outcome, PathChunk
from .messages import PreviewResponse, Region, RegionMap, Report, Setup, Severity, TabulateReachResponse, Tool, TraceLinesResponse
from .meshes import Mesh
from .paths import Path


def _lines(head: str, *groups: Sequence[str]) -> str:
    return "\n  ".join([head, *(line for group in groups for line in group)])


def has_errors(findings: Sequence[Diagnostic]) -> bool:
    return any(f.severity == Severity.ERROR for f in findings)


class HasPage(ABC):
    """A result that the 3-D page can show."""

    @abstractmethod
    def _scene(self) -> Scene | None:
        """What the page shows; None without triangles."""

    def page(self) -> str:
        """The 3-D page as one HTML file that needs no network."""
        scene = self._scene()
        if scene is None:
            raise PatchmillError("The answer has no triangles for the page; ask for them with Output.TESSELLATION in `outputs`.")
        return make_page(scene)

    def save_page(self, path: str | os.PathLike[str]) -> None:
        """Writes the 3-D page."""
        write_file(path, self.page().encode())

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>" + (in_frame(self.page()) if self._scene() is not None else "")


@dataclass(eq=False, repr=False)
class Judged(HasPage):
    """A report, and how its motion looks.

    report: the report.
    report_message: the same as the message of protobuf.
    """

    name: str
    report: Report
    report_message: Any = field(repr=False)
    path: Path | None = None
    mesh: Mesh | None = None

    @property
    def outcome(self) -> Outcome:
        return self.report.outcome

    @property
    def findings(self) -> Sequence[Diagnostic]:
        """Assumptions, warnings and findings."""
        return self.report.diagnostics

    @property
    def figures(self) -> dict[str, str]:
        """The figures of the summary of `mill`, in its words."""
        return dict(figures_of(self.report))

    def report_json(self) -> str:
        """The report as JSON, as the command line writes it."""
        return str(json_format.MessageToJson(self.report_message, including_default_value_fields=True,
                                             preserving_proto_field_name=True))

    def __str__(self) -> str:
        figures = [f"{name}: {value}" for name, value in self.figures.items()]
        return _lines(f"{self.outcome.name}: {self.name or 'part'}", figures, finding_lines(self.findings))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.outcome.name}: gouge {self.report.max_gouge_mm:.4f} mm, leftover " \
               f"{self.report.max_leftover_mm:.4f} mm, not reached {uncut_share(self.report)}>"


@dataclass(eq=False, repr=False)
class MillResult(Judged):
    """A job and its verified program.

    program_bytes: the program; empty if there is none: the outcome and the findings say why.
    accepted: the job as the server understood it, with its defaults.
    regions: the regions with their borders, if `outputs` has Output.REGIONS.
    path, mesh: moves and triangles as arrays, if `outputs` has Output.PATH_BLOCKS and Output.TESSELLATION.
    picture: an SVG, if `outputs` has Output.PICTURE.
    path_chunks, arcs: the moves as objects, if `outputs` has Output.PATHS or Output.ARCS.
    """

    program_bytes: bytes = b""
    accepted: Accepted = field(default_factory=Accepted)
    regions: RegionMap | None = None
    picture: bytes = b""
    path_chunks: Sequence[PathChunk] = ()
    arcs: Sequence[ArcMove] = ()

    @property
    def has_program(self) -> bool:
        return bool(self.program_bytes)

    @property
    def program(self) -> str:
        """The program as text. NoProgramError if there is none."""
        return self.must_have_program().decode()

    def must_have_program(self) -> bytes:
        """The bytes of the program. NoProgramError if there is none."""
        if not self.program_bytes:
            reasons = [f for f in self.findings if f.severity == Severity.ERROR or f.code == self.outcome.name]
            raise NoProgramError(_lines(f"The job has no program: {self.outcome.name}", finding_lines(reasons)))
        return self.program_bytes

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the program, byte for byte. NoProgramError if there is none."""
        write_file(path, self.must_have_program())

    def _scene(self) -> Scene | None:
        if self.mesh is None:
            return None
        job = self.accepted.resolved_job or Job()
        operation = job.operations[0] if job.operations else None
        return Scene(self.name, self.mesh, self.accepted.server_version, job.setup, operation.tool if operation else None,
                     operation.tolerance_mm if operation else 0.01, operation.scallop_mm if operation else None,
                     (operation.steep_angle_deg if operation else None) or 45.0, self.regions, self.path, self.program_bytes,
                     self.report, self.findings)


@dataclass(eq=False, repr=False)
class VerifyResult(Judged):
    """A program, judged.

    leftover_csv, leftover_png: what is left over the part, if `leftover_map` was set.
    """

    program_bytes: bytes = b""
    setup: Setup | None = None
    tools: Sequence[Tool] = ()
    tolerance_mm: float = 0.01
    scallop_mm: float | None = None
    leftover_csv: bytes = b""
    leftover_png: bytes = b""

    @property
    def is_good(self) -> bool:
        """No promise is broken. Whether the part is finished is the outcome's to say."""
        checks = (self.report.gouge_check, self.report.finish_check, self.report.motion_check)
        return CheckState.FAILED not in checks and self.outcome != Outcome.VERIFICATION_FAILED

    def _scene(self) -> Scene | None:
        if self.mesh is None:
            return None
        return Scene(self.name, self.mesh, setup=self.setup, tool=self.tools[0] if self.tools else None, tolerance_mm=self.tolerance_mm,
                     scallop_mm=self.scallop_mm, path=self.path, program=self.program_bytes, report=self.report, findings=self.findings)


@dataclass(eq=False, repr=False)
class RegionsResult(HasPage):
    """The regions of a job. Iterate over it, or index it by the id of a region.

    region_map: regions, borders and nodes.
    mesh: triangles as arrays, if `outputs` has Output.TESSELLATION.
    picture: an SVG, if `outputs` has Output.PICTURE.
    """

    name: str
    region_map: RegionMap
    findings: Sequence[Diagnostic]
    patch_ids: Sequence[str]
    mesh: Mesh | None
    picture: bytes
    job: Job

    @property
    def regions(self) -> Sequence[Region]:
        return self.region_map.regions

    @property
    def regions_sha256(self) -> bytes:
        """For Operation.regions_sha256: overrides by id hold for this map only."""
        return self.region_map.regions_sha256

    def __len__(self) -> int:
        return len(self.regions)

    def __getitem__(self, region_id: int) -> Region:
        return self.regions[region_id]

    def __str__(self) -> str:
        return _lines(f"{len(self)} regions: {self.name or 'part'}", [f"{r.id} {region_name(r)}" for r in self.regions],
                      finding_lines(self.findings))

    def __repr__(self) -> str:
        return f"<RegionsResult: {len(self)} regions, {len(self.findings)} findings>"

    def _scene(self) -> Scene | None:
        if self.mesh is None:
            return None
        operation = self.job.operations[0]
        steep = 45.0 if operation.steep_angle_deg is None else operation.steep_angle_deg
        return Scene(self.name, self.mesh, setup=self.job.setup, tool=operation.tool, tolerance_mm=operation.tolerance_mm,
                     scallop_mm=operation.scallop_mm, steep_angle_deg=steep, regions=self.region_map, findings=self.findings)


class CheckResult(CheckModelResponse):
    """A model, checked."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    @property
    def is_usable(self) -> bool:
        """No finding is an error."""
        return not has_errors(self.diagnostics)

    def __str__(self) -> str:
        radius = self.min_concave_radius_mm
        return _lines(f"{'usable' if self.is_usable else 'not usable'}: {self.patch_count} patches, {self.face_count} faces",
                      [f"{self.joined_edge_count} joined edges, gap {self.max_gap_mm:.4g} mm, angle {self.max_angle_deg:.3g} degrees; "
                       f"{self.open_edge_count} open edges",
                       "no concave place" if radius is None else f"smallest concave radius: {radius:.4g} mm"],
                      [f"concave faces ({g.kind.name.removeprefix('SURFACE_KIND_').lower()}): R {g.min_radius_mm:.5g} mm on "
                       f"{len(g.face_ids)}, first {g.face_ids[0]}" for g in self.concave_faces],
                      [f"hole {h.face_ids[0]}: diameter {h.diameter_mm:.6g} mm, depth {h.depth_mm:.5g} mm" for h in self.holes],
                      finding_lines(self.diagnostics))


class ReachResult(TabulateReachResponse):
    """What each ball does not reach."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def __str__(self) -> str:
        rows = [f"D {e.tool_diameter_mm:g} mm: {e.unreachable_area_mm2:.2f} mm2 not reached, largest ball for "
                f"{e.largest_tool_area_mm2:.2f} mm2" for e in self.entries]
        return _lines(f"area {self.area_mm2:.2f} mm2", rows, finding_lines(self.diagnostics))


class LinesResult(TraceLinesResponse):
    """Characteristic lines."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def __str__(self) -> str:
        rows = [f"{s.kind.name} level {s.level:g}: {len(s.lines)} lines, {s.length_mm:.2f} mm" for s in self.sets]
        return _lines(f"{sum(len(s.lines) for s in self.sets)} lines", rows, finding_lines(self.diagnostics))


class SurfaceValues(EvaluateSurfaceResponse):
    """Points, derivatives, fundamental forms and curvatures as arrays, in the order of the places."""

    def __str__(self) -> str:
        rows = [f"{point.tolist()}: normal {normal.tolist()}, curvatures {curvatures.tolist()} 1/mm" for point, normal, curvatures
                in zip(self.points_mm[:5], self.normals, self.principal_curvatures_per_mm)]
        return _lines(f"{len(self.points_mm)} points", rows)


class PreviewResult(PreviewResponse):
    """What a picture replaces after edits."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def __str__(self) -> str:
        head = f"{len(self.changed_faces)} of {self.face_count} faces changed"
        rows = [f"face {patch.face}: {len(patch.corners) // 3} triangles" for patch in self.patches[:10]]
        return _lines(head, rows, finding_lines(self.diagnostics))


class _ModelResult:
    """A result whose model the command line reads, too."""

    def _message(self) -> Any:
        raise NotImplementedError

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model: .pb as bytes, anything else as JSON."""
        message = self._message()
        is_binary = os.fspath(path).endswith(".pb")
        content = message.SerializeToString() if is_binary else json_format.MessageToJson(
            message, preserving_proto_field_name=True, indent=0).encode()
        write_file(path, content)


def _to_model_message(model: Any) -> Any:
    from ._message import to_message
    from .v1 import model_pb2

    if model is None:
        raise PatchmillError("There is no model to save: the findings say why.")
    return to_message(model, model_pb2.PatchModel(), "model")


class ConvertResult(ConvertModelResponse, _ModelResult):
    """A model of any format as a PatchModel."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def _message(self) -> Any:
        return _to_model_message(self.model)

    def __str__(self) -> str:
        what = f"{len(self.model.patches)} patches, {len(self.model.faces)} faces" if self.model else "no model"
        return _lines(what, finding_lines(self.diagnostics))


class BuildResult(BuildModelResponse, _ModelResult):
    """A first surface, and the network on it."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def _message(self) -> Any:
        return _to_model_message(self.network_model or self.model)

    def __str__(self) -> str:
        return _lines("a surface" if self.model else "no surface", finding_lines(self.diagnostics))


class EditResult(EditModelResponse, _ModelResult):
    """A curve network after its edits."""

    @property
    def findings(self) -> Sequence[Diagnostic]:
        return self.diagnostics

    def _message(self) -> Any:
        return _to_model_message(self.model)

    def __str__(self) -> str:
        return _lines(f"{len(self.changed_faces)} faces changed", finding_lines(self.diagnostics))


def _faired(energies: Any, iterations: int, moved_mm: float, at: int) -> str:
    before, after = (float(energies[0]), float(energies[-1])) if len(energies) else (0.0, 0.0)
    return f"energy {before:.6g} to {after:.6g} 1/mm in {iterations} iterations; point {at} moved most: {moved_mm:.4g} mm"


class FairCurveResult(FairCurveResponse):
    """A curve, faired."""

    def __str__(self) -> str:
        return _faired(self.energies, self.iteration_count, self.max_moved_mm, self.max_moved_point_index)


class FairNetResult(FairNetResponse):
    """A net, faired."""

    def __str__(self) -> str:
        return _faired(self.energies, self.iteration_count, self.max_moved_mm, self.max_moved_point_index)

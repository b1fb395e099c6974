"""The calls of ToolpathService: mill, resolve, verify, posts."""
from __future__ import annotations

import hashlib
import os
import pathlib
from collections.abc import Sequence
from typing import Any

from ._call import RPCS, Call, Canceller, Inline, One, ProgressCallback
from ._message import from_message, set_fields
from .errors import IncompleteAnswerError
from .meshes import mesh_of
from .messages import Accepted, ArcMove, ListPostsResponse, Operation, Outcome, Output, PathChunk, Post, PostCheck, PostInfo
from .messages import RegionMap, RegionOverride, Report, Selection, Setup, Strategy, Tool
from .models import ModelLike, Model, model_of, set_name, set_source
from .paths import path_of
from .results import MillResult, VerifyResult
from .uploading import upload
from .v1 import toolpath_service_pb2

VIEW = (Output.REGIONS, Output.PATH_BLOCKS, Output.TESSELLATION)
"""What the 3-D page needs, and what makes regions, path and mesh of a result."""
_ALWAYS = (Output.PROGRESS, Output.PROGRAM, Output.REPORT)


class _MillCollector:
    """Collects the stream of GenerateProgram. Without a report all of it is void."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._program, self._picture = bytearray(), bytearray()
        self._kept: dict[str, list[Any]] = {}
        self._one: dict[str, Any] = {}

    def take(self, event: Any) -> None:
        kind = event.WhichOneof("event")
        if kind == "program":
            self._program += event.program.data
        elif kind == "artifact":
            self._picture += event.artifact.data
        elif kind in ("paths", "arc", "path_block", "mesh"):
            self._kept.setdefault(kind, []).append(getattr(event, kind))
        elif kind in ("accepted", "regions", "report"):
            self._one[kind] = getattr(event, kind)

    def finish(self) -> MillResult:
        report, program = self._one.get("report"), bytes(self._program)
        if report is None:
            raise IncompleteAnswerError("The answer ended without a report. Nothing of it is valid.")
        if len(program) != report.program_size_bytes or (program and hashlib.sha256(program).digest() != report.program_sha256):
            raise IncompleteAnswerError("The program did not arrive whole. Nothing of it is valid.")
        if report.outcome not in (Outcome.COMPLETE, Outcome.COMPLETE_WHERE_REACHABLE):
            program = b""
        regions = self._one.get("regions")
        return MillResult(
            name=self._name, report=from_message(Report, report), report_message=report, program_bytes=program,
            accepted=from_message(Accepted, self._one["accepted"]), picture=bytes(self._picture),
            regions=None if regions is None else from_message(RegionMap, regions),
            path=path_of(self._kept.get("path_block", [])), mesh=mesh_of(self._kept.get("mesh", [])),
            path_chunks=[from_message(PathChunk, c) for c in self._kept.get("paths", [])],
            arcs=[from_message(ArcMove, a) for a in self._kept.get("arc", [])])


class _AcceptedCollector:
    """Collects the stream of a job that is checked only."""

    def __init__(self) -> None:
        self._accepted: Any = None

    def take(self, event: Any) -> None:
        if event.HasField("accepted"):
            self._accepted = event.accepted

    def finish(self) -> Accepted:
        if self._accepted is None:
            raise IncompleteAnswerError("The answer ended before the server had accepted the job.")
        return from_message(Accepted, self._accepted)


def set_job(request: Any, model: Model, operation: Operation, setup: Setup | None, name: str | None) -> Any:
    """Puts the job into a request that has one."""
    set_source(request.job, model)
    set_name(request.job, model, name)
    set_fields(request.job, "job", setup=setup, operations=[operation])
    return request


def _job_request(model: Model, operation: Operation, setup: Setup | None, post: Post | None, name: str | None, **fields: Any) -> Any:
    request = toolpath_service_pb2.GenerateProgramRequest()
    set_job(request, model, operation, setup, name)
    return set_fields(request, post=post, **fields)


def mill(model: ModelLike, operation: Operation, *, setup: Setup | None = None, post: Post | None = None, name: str | None = None,
         outputs: Sequence[Output] = VIEW, tessellation_chord_mm: float | None = None, request_id: str = "", max_threads: int = 0,
         progress: ProgressCallback | None = None, cancel: Canceller | None = None, timeout_s: float | None = None,
         ) -> Call[MillResult]:
    """Plans the passes, writes the program and verifies it.

    model: path of a file, Model, PatchModel, CurveNetwork, or a part with exportStep(path).
    operation: what is cut: tool, scallop, tolerance and all that has a default.
    setup: how the model lies, its zero, stock, clamps and machine.
    post: dialect and form of the program.
    name: name of the part in the program header. Default: that of the file.
    outputs: what the answer carries besides program and report. Default: what regions, path, mesh and the 3-D
        page need; () for the program alone.
    tessellation_chord_mm: distance between the triangles and the surface.
    request_id: name of the request in the server's log.
    max_threads: threads of this call; 0: the server chooses. The program does not depend on it.
    progress: called with the Progress of the job, at least twice a second. An error that it raises cancels
        the job.
    cancel: a Canceller; calling it ends the job with JobCancelledError.
    timeout_s: longest time of the call, all its tries together; then DeadlineError.
    """
    chosen = model_of(model)
    fields = {"outputs": [*_ALWAYS, *outputs], "tessellation_chord_mm": tessellation_chord_mm, "request_id": request_id,
              "max_threads": max_threads}
    part = chosen.name if name is None else name
    return Call(RPCS["GenerateProgram"], _job_request(chosen, operation, setup, post, name, **fields),
                lambda: _MillCollector(part), inline(chosen, lambda m: _job_request(m, operation, setup, post, name, **fields)),
                progress, cancel, timeout_s)


def resolve(model: ModelLike, operation: Operation, *, setup: Setup | None = None, post: Post | None = None, name: str | None = None,
            timeout_s: float | None = None) -> Call[Accepted]:
    """Checks a job as far as it can be checked without planning, and returns it with its defaults filled in
    (`validate_only` of the contract). The arguments are those of mill."""
    chosen = model_of(model)

    def make(m: Model) -> Any:
        return _job_request(m, operation, setup, post, name, validate_only=True)

    return Call(RPCS["GenerateProgram"], make(chosen), _AcceptedCollector, inline(chosen, make), timeout_s=timeout_s)


def inline(model: Model, make: Any) -> Inline | None:
    if model.inline is None:
        return None
    whole: Model = model.inline
    return Inline(lambda: upload(whole), lambda: make(whole))


class _VerifyCollector:
    """Collects the stream of VerifyProgram."""

    def __init__(self, name: str, request: Any, program: bytes, setup: Setup | None, tools: Sequence[Tool]) -> None:
        self._name, self._request, self._program, self._setup, self._tools = name, request, program, setup, tools
        self._report: Any = None
        self._files: dict[str, bytearray] = {}
        self._paths: list[Any] = []
        self._mesh: list[Any] = []

    def take(self, event: Any) -> None:
        kind = event.WhichOneof("event")
        if kind == "artifact":
            self._files.setdefault(event.artifact.name, bytearray()).extend(event.artifact.data)
        elif kind == "path_block":
            self._paths.append(event.path_block)
        elif kind == "mesh":
            self._mesh.append(event.mesh)
        elif kind == "report":
            self._report = event.report

    def finish(self) -> VerifyResult:
        if self._report is None:
            raise IncompleteAnswerError("The answer ended without a report. Nothing of it is valid.")
        return VerifyResult(
            name=self._name, report=from_message(Report, self._report), report_message=self._report, path=path_of(self._paths),
            mesh=mesh_of(self._mesh), program_bytes=self._program, setup=self._setup, tools=self._tools,
            tolerance_mm=self._request.tolerance_mm,
            scallop_mm=self._request.scallop_mm if self._request.HasField("scallop_mm") else None,
            leftover_csv=bytes(self._files.get("leftover.csv", b"")), leftover_png=bytes(self._files.get("leftover.png", b"")))


def _program_bytes(program: str | bytes | os.PathLike[str] | MillResult) -> bytes:
    if isinstance(program, MillResult):
        return program.must_have_program()
    if isinstance(program, bytes):
        return program
    if isinstance(program, str):
        # A program has more than one line, and a path has one.
        if "\n" in program:
            return program.encode()
    return pathlib.Path(program).read_bytes()


def verify(model: ModelLike, program: str | bytes | os.PathLike[str] | MillResult, tools: Tool | Sequence[Tool], *, tolerance_mm: float,
           scallop_mm: float | None = None, setup: Setup | None = None, dialect: str = "", post_file: str = "",
           stock_to_leave_mm: float | None = None, floor_z_mm: float | None = None, top_z_mm: float | None = None,
           strategy: Strategy = Strategy.UNSPECIFIED, zigzag_angle_deg: float | None = None, steep_angle_deg: float | None = None,
           detail: float | None = None, selection: Selection | None = None, regions_sha256: bytes = b"",
           region_overrides: Sequence[RegionOverride] = (), control_deviation_mm: float | None = None, assume_exact_path: bool = False,
           machine_z_safe_mm: float | None = None, leftover_map: bool = False, accept_depth_mm: float = 0.0,
           keep_feed_on_passes: bool = False, outputs: Sequence[Output] = (Output.PATH_BLOCKS, Output.TESSELLATION),
           tessellation_chord_mm: float | None = None, max_threads: int = 0, progress: ProgressCallback | None = None,
           cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[VerifyResult]:
    """Measures any program, of Patchmill or of another source, against the exact surface.

    program: path of the program, its bytes, its text (of two lines or more), or the MillResult that it came
        with.
    tools: the tool of the program, or each of its tools with its own number.
    tolerance_mm: the whole error budget.
    scallop_mm: scallop height that the finish is compared with. Default: the leftover is measured, not
        compared.

    All other arguments are the fields of VerifyProgramRequest in proto/patchmill/v1/toolpath_service.proto,
    or those of mill.
    """
    chosen, text = model_of(model), _program_bytes(program)
    listed = [tools] if isinstance(tools, Tool) else list(tools)

    def make(m: Model) -> Any:
        return set_fields(
            set_source(toolpath_service_pb2.VerifyProgramRequest(), m), program=text, tools=listed, tolerance_mm=tolerance_mm,
            scallop_mm=scallop_mm, setup=setup, dialect=dialect, post_file=post_file, stock_to_leave_mm=stock_to_leave_mm,
            floor_z_mm=floor_z_mm, top_z_mm=top_z_mm, strategy=strategy, zigzag_angle_deg=zigzag_angle_deg,
            steep_angle_deg=steep_angle_deg, detail=detail, selection=selection, regions_sha256=regions_sha256,
            region_overrides=region_overrides, control_deviation_mm=control_deviation_mm, assume_exact_path=assume_exact_path,
            machine_z_safe_mm=machine_z_safe_mm, leftover_map=leftover_map, accept_depth_mm=accept_depth_mm,
            keep_feed_on_passes=keep_feed_on_passes, outputs=outputs, tessellation_chord_mm=tessellation_chord_mm, max_threads=max_threads)

    request = make(chosen)
    return Call(RPCS["VerifyProgram"], request, lambda: _VerifyCollector(chosen.name, request, text, setup, listed),
                inline(chosen, make), progress, cancel, timeout_s)


def posts(*, timeout_s: float | None = None) -> Call[Sequence[PostInfo]]:
    """The dialects in which programs are written and read."""
    return Call(RPCS["ListPosts"], toolpath_service_pb2.ListPostsRequest(),
                lambda: One(lambda answer: from_message(ListPostsResponse, answer).posts), timeout_s=timeout_s)


def check_post(post_file: str, *, timeout_s: float | None = None) -> Call[PostCheck]:
    """What is to say of a post file: its faults, what it derives from, what it leaves to the control."""
    return Call(RPCS["ListPosts"], toolpath_service_pb2.ListPostsRequest(post_file=post_file),
                lambda: One(_check_of), timeout_s=timeout_s)


def _check_of(answer: toolpath_service_pb2.ListPostsResponse) -> PostCheck:
    check = from_message(ListPostsResponse, answer).check
    if check is None:
        raise IncompleteAnswerError("The server does not check post files; it is older than this package.")
    return check

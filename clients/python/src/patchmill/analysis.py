"""The calls of AnalysisService: regions, reach, lines, evaluate, preview."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike

from ._call import RPCS, Call, Canceller, One
from ._message import from_message, set_fields
from .meshes import mesh_of
from .messages import Diagnostic, Job, LineFamily, ModelEdit, Operation, Output, RegionMap, Setup
from .milling import inline, set_job
from .models import Model, ModelLike, model_of, set_name, set_source
from .results import LinesResult, PreviewResult, ReachResult, RegionsResult, SurfaceValues
from .v1 import analysis_service_pb2, lines_pb2, preview_pb2


def regions(model: ModelLike, operation: Operation, *, setup: Setup | None = None, name: str | None = None,
            outputs: Sequence[Output] = (Output.REGIONS, Output.TESSELLATION), tessellation_chord_mm: float | None = None,
            max_threads: int = 0, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[RegionsResult]:
    """Splits the surface of a job into regions, without planning any motion. The arguments are those of mill.

    outputs: Output.REGIONS, Output.PICTURE, Output.TESSELLATION.
    """
    chosen = model_of(model)

    def make(m: Model) -> Any:
        request = set_job(analysis_service_pb2.SplitRegionsRequest(), m, operation, setup, name)
        return set_fields(request, outputs=outputs, tessellation_chord_mm=tessellation_chord_mm, max_threads=max_threads)

    def result(answer: Any) -> RegionsResult:
        return RegionsResult(
            name=chosen.name if name is None else name, region_map=from_message(RegionMap, answer.regions),
            findings=[from_message(Diagnostic, d) for d in answer.diagnostics], patch_ids=list(answer.patch_ids),
            mesh=mesh_of(answer.mesh), picture=answer.picture.data, job=Job(setup=setup, operations=[operation]))

    return Call(RPCS["SplitRegions"], make(chosen), lambda: One(result), inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def reach(model: ModelLike, operation: Operation, tool_diameters_mm: ArrayLike, *, setup: Setup | None = None, name: str | None = None,
          max_threads: int = 0, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[ReachResult]:
    """States for each of several balls how much of the surface it does not reach.

    operation: its stock to leave, tolerance and floor have an effect; its tool has none.
    tool_diameters_mm: diameters of the balls, rising.
    """
    chosen = model_of(model)

    def make(m: Model) -> Any:
        request = set_job(analysis_service_pb2.TabulateReachRequest(), m, operation, setup, name)
        return set_fields(request, tool_diameters_mm=tool_diameters_mm, max_threads=max_threads)

    return Call(RPCS["TabulateReach"], make(chosen), lambda: One(lambda answer: from_message(ReachResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def lines(model: ModelLike, families: LineFamily | Sequence[LineFamily], *, setup: Setup | None = None, tolerance_mm: float | None = None,
          min_loop_mm: float | None = None, picture: bool = False, name: str | None = None, max_threads: int = 0,
          cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[LinesResult]:
    """Traces characteristic lines on the true surface: contours, equal slopes, silhouettes, highlights and
    others.

    families: which lines: LineFamily(kind=LineKind.CONTOUR, levels=[...]), or several of them.
    tolerance_mm: chord tolerance of the polylines. Default 0.01.
    min_loop_mm: every loop inside a patch that is wider than this is found. Default 0.1.
    picture: draw the lines, too: `result.picture.data` is an SVG.
    """
    chosen = model_of(model)
    listed = [families] if isinstance(families, LineFamily) else list(families)

    def make(m: Model) -> Any:
        request = set_source(lines_pb2.TraceLinesRequest(), m)
        set_name(request, m, name)
        return set_fields(request, setup=setup, families=listed, tolerance_mm=tolerance_mm, min_loop_mm=min_loop_mm, picture=picture,
                          max_threads=max_threads)

    return Call(RPCS["TraceLines"], make(chosen), lambda: One(lambda answer: from_message(LinesResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def evaluate(model: ModelLike, patch_index: ArrayLike, uv: ArrayLike, *, setup: Setup | None = None, max_threads: int = 0,
             cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[SurfaceValues]:
    """Points, derivatives, fundamental forms and curvatures of the placed surface, as arrays.

    patch_index: patch of each point: position in the model.
    uv: parameters of each point, shape (points, 2), in [0, 1].
    """
    chosen = model_of(model)

    def make(m: Model) -> Any:
        request = set_source(lines_pb2.EvaluateSurfaceRequest(), m)
        return set_fields(request, setup=setup, patch_index=patch_index, uv=uv, max_threads=max_threads)

    return Call(RPCS["EvaluateSurface"], make(chosen), lambda: One(lambda answer: from_message(SurfaceValues, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def preview(model: ModelLike, edits: ModelEdit | Sequence[ModelEdit] = (), *, all_faces: bool = False, cells: int | None = None,
            families: LineFamily | Sequence[LineFamily] = (), tolerance_mm: float | None = None, min_loop_mm: float | None = None,
            with_controls: bool = False, with_combs: bool = False, max_threads: int = 0, cancel: Canceller | None = None,
            timeout_s: float | None = None) -> Call[PreviewResult]:
    """What to draw of the faces that edits of a network change: triangles, edges, lines, controls, combs.

    model: name an uploaded model, and the server joins its network once only.
    edits: as for edit; all edits since the model, because the server remembers none.
    all_faces: answer with all faces.
    cells: steps along each side of a patch.
    families: lines on these faces.
    """
    chosen = model_of(model)
    listed = [edits] if isinstance(edits, ModelEdit) else list(edits)
    drawn = [families] if isinstance(families, LineFamily) else list(families)

    def make(m: Model) -> Any:
        return set_fields(set_source(preview_pb2.PreviewRequest(), m), edits=listed, all_faces=all_faces, cells=cells, families=drawn,
                          tolerance_mm=tolerance_mm, min_loop_mm=min_loop_mm, with_controls=with_controls, with_combs=with_combs,
                          max_threads=max_threads)

    return Call(RPCS["Preview"], make(chosen), lambda: One(lambda answer: from_message(PreviewResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)

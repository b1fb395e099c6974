"""The calls of ModelService: check, convert, build, edit, fair, fair_net."""
from __future__ import annotations

import os
import pathlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ._call import RPCS, Call, Canceller, One
from ._message import from_message, set_fields
from .errors import OptionError
from .messages import Axis, BandRule, BoundaryCurves, BsplinePatch, ControlMesh, CrossingCurves, CurveFile, CurveNetwork, CurvePoints
from .messages import FairingBand, FairingStop, LengthUnit, ModelEdit, PointLock, SectionCurves, Setup, SurfaceDivision, Tool
from .milling import inline
from .models import Model, ModelLike, model_of, set_source
from .results import BuildResult, CheckResult, ConvertResult, EditResult, FairCurveResult, FairNetResult
from .v1 import fairing_pb2, model_service_pb2

Curve = ArrayLike | CurveFile | CurvePoints | str | os.PathLike[str]


def check(model: ModelLike, *, setup: Setup | None = None, tool: Tool | None = None, continuity_steps: int = 0,
          with_faces: bool = False, with_faces_picture: bool = False, with_crossings: bool = False, max_threads: int = 0,
          cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[CheckResult]:
    """Checks a model: its patches, how they meet, and its curvature against the tool. Findings are data, not
    errors.

    tool: tool with which concave curvature is compared.
    continuity_steps: steps along each joint at which it is measured; 0: joints are not measured.
    with_faces: list the faces of the model.
    with_faces_picture: draw the faces, each with its id: `result.picture.data` is an SVG.
    with_crossings: name patches and bodies that cross each other.
    """
    chosen = model_of(model)

    def make(m: Model) -> Any:
        return set_fields(set_source(model_service_pb2.CheckModelRequest(), m), setup=setup, tool=tool, continuity_steps=continuity_steps,
                          with_faces=with_faces, with_faces_picture=with_faces_picture, with_crossings=with_crossings,
                          max_threads=max_threads)

    return Call(RPCS["CheckModel"], make(chosen), lambda: One(lambda answer: from_message(CheckResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def convert(model: ModelLike, *, scale: float | None = None, file_format: str = "", chord_mm: float | None = None,
            max_threads: int = 0, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[ConvertResult]:
    """Converts any model into a PatchModel that gives the same jobs, or into a file for other systems.

    scale: scale factor of the model. A curve network keeps its scale, unless it goes into a file.
    file_format: "iges" or "step" for B-spline surfaces, "stl" or "obj" for triangles: `file` of the result.
    chord_mm: distance of the triangles from the surface.
    """
    chosen = model_of(model)

    def make(m: Model) -> Any:
        return set_fields(set_source(model_service_pb2.ConvertModelRequest(), m), scale=scale, file_format=file_format,
                          chord_mm=chord_mm, max_threads=max_threads)

    return Call(RPCS["ConvertModel"], make(chosen), lambda: One(lambda answer: from_message(ConvertResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def build(outline: SectionCurves | BoundaryCurves | CrossingCurves | BsplinePatch | ControlMesh | None = None, *,
          length_unit: LengthUnit = LengthUnit.MILLIMETER, network: CurveNetwork | None = None, division: SurfaceDivision | None = None,
          max_threads: int = 0, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[BuildResult]:
    """Makes a first surface from outline curves: a skin through sections, or a surface between four boundary
    curves. Or makes a network from curves that cross, from a surface that it divides, or from a polygon mesh.

    outline: what the model is made from. Without one the network is checked, with the curves of its files.
    network: a network whose vertices without a normal take the normal of the surface.
    division: the surface is divided into a network.
    """
    names = {SectionCurves: "sections", BoundaryCurves: "boundary", CrossingCurves: "crossing", BsplinePatch: "surface",
             ControlMesh: "mesh"}
    fields = {} if outline is None else {names[type(outline)]: outline}
    request = set_fields(model_service_pb2.BuildModelRequest(), length_unit=length_unit, network=network, division=division,
                         max_threads=max_threads, **fields)
    return Call(RPCS["BuildModel"], request, lambda: One(lambda answer: from_message(BuildResult, answer)), cancel=cancel,
                timeout_s=timeout_s)


def edit(model: ModelLike, edits: ModelEdit | Sequence[ModelEdit], *, continuity_steps: int = 0, with_patches: bool = False,
         max_threads: int = 0, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[EditResult]:
    """Edits a curve network. Everything that no edit changes stays as it is, to the bit.

    edits: the edits in order: ModelEdit(push_face=PushFace(...)) and others.
    with_patches: the answer has the patches, too.
    """
    chosen = model_of(model)
    listed = [edits] if isinstance(edits, ModelEdit) else list(edits)

    def make(m: Model) -> Any:
        return set_fields(set_source(model_service_pb2.EditModelRequest(), m), edits=listed, continuity_steps=continuity_steps,
                          with_patches=with_patches, max_threads=max_threads)

    return Call(RPCS["EditModel"], make(chosen), lambda: One(lambda answer: from_message(EditResult, answer)),
                inline(chosen, make), cancel=cancel, timeout_s=timeout_s)


def _curve_fields(curve: Curve, what: str) -> dict[str, Any]:
    if isinstance(curve, CurvePoints):
        return {"points": curve}
    if isinstance(curve, CurveFile):
        return {"file": curve}
    if isinstance(curve, (str, os.PathLike)):
        path = pathlib.Path(curve)
        return {"file": CurveFile(format=path.suffix.lower().removeprefix("."), content=path.read_bytes())}
    points = np.asarray(curve, dtype=np.float64)
    if points.ndim < 2 or points.shape[-1] not in (2, 3):
        raise OptionError(what, f"has the shape {points.shape}; it must have two or three numbers for each point")
    if points.shape[-1] == 2:
        points = np.concatenate([points, np.zeros((*points.shape[:-1], 1))], axis=-1)
    return {"points": CurvePoints(points_mm=points)}


def fair(curve: Curve, *, axes: Sequence[Axis] = (), band: FairingBand | None = None, locks: Sequence[PointLock] = (),
         start_direction: ArrayLike = (), end_direction: ArrayLike = (), max_iterations: int | None = None,
         stop: FairingStop = FairingStop.UNSPECIFIED, band_rule: BandRule = BandRule.UNSPECIFIED,
         polyline_tolerance_mm: float | None = None, picture: bool = False, name: str = "", cancel: Canceller | None = None,
         timeout_s: float | None = None) -> Call[FairCurveResult]:
    """Fairs a measured curve as an elastic beam.

    curve: points as an array of the shape (points, 2 or 3), or the path of a .csv or .dat file.

    All other arguments are the fields of FairCurveRequest in proto/patchmill/v1/fairing.proto.
    """
    request = set_fields(
        fairing_pb2.FairCurveRequest(), axes=axes, band=band, locks=locks, start_direction=start_direction,
        end_direction=end_direction, max_iterations=max_iterations, stop=stop, band_rule=band_rule,
        polyline_tolerance_mm=polyline_tolerance_mm, picture=picture, name=name, **_curve_fields(curve, "curve"))
    return Call(RPCS["FairCurve"], request, lambda: One(lambda answer: from_message(FairCurveResult, answer)), cancel=cancel,
                timeout_s=timeout_s)


def fair_net(net: Curve, line_count: int | None = None, *, axes: Sequence[Axis] = (), band: FairingBand | None = None,
             locks: Sequence[PointLock] = (), max_iterations: int | None = None, stop: FairingStop = FairingStop.UNSPECIFIED,
             band_rule: BandRule = BandRule.UNSPECIFIED, cancel: Canceller | None = None,
             timeout_s: float | None = None) -> Call[FairNetResult]:
    """Fairs a net of measured points as two families of elastic beams. Its border does not move.

    net: points as an array of the shape (lines, points of a line, 2 or 3), or the path of a .csv or .dat
        file.
    line_count: number of lines. It may be left out for an array.

    All other arguments are the fields of FairNetRequest in proto/patchmill/v1/fairing.proto.
    """
    if line_count is None:
        shape = () if isinstance(net, (CurveFile, CurvePoints, str, os.PathLike)) else np.shape(net)
        if len(shape) != 3:
            raise OptionError("line_count", "is not given; it may be left out only for an array of the shape (lines, points, 2 or 3)")
        line_count = shape[0]
    request = set_fields(
        fairing_pb2.FairNetRequest(), line_count=line_count, axes=axes, band=band, locks=locks,
        max_iterations=max_iterations, stop=stop, band_rule=band_rule, **_curve_fields(net, "net"))
    return Call(RPCS["FairNet"], request, lambda: One(lambda answer: from_message(FairNetResult, answer)), cancel=cancel,
                timeout_s=timeout_s)

"""The selected body as a model: a STEP file of its shape where it lies in the document, and its faces by
their ids."""
from __future__ import annotations

import hashlib
import pathlib
import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import Part
import patchmill as pm

from . import service
from .problem import Problem

AREA_PART = 1e-3  # areas of a face in FreeCAD and in the service agree to this share
BOX_MM = 0.05  # and so do the centres of their boxes
# Open CASCADE writes the time, and counts the files of a session in the names of bodies. The same body is to
# give the same file, and so the same program.
_TIME = re.compile(rb"(FILE_NAME\('[^']*',)'[^']*'")
_NUMBER = re.compile(rb"-?\d+\.\d*(?:E[+-]?\d+)?")
_COUNT = re.compile(rb"'Open CASCADE STEP translator [\d.]+ \d+((?:\.\d+)*)'")


@dataclass(frozen=True)
class Body:
    """A body of the document. Its shape lies where the document shows it."""

    shape: Any
    step: bytes
    label: str

    @property
    def sha256(self) -> str:
        """The digest of the file with its numbers to 1e-9: a document that is saved and opened again has the
        same shape but for the last bits, and nothing is to be computed anew for them."""
        return hashlib.sha256(_NUMBER.sub(lambda number: b"%.9f" % (round(float(number[0]), 9) + 0.0), self.step)).hexdigest()

    def model(self, name: str, options: pm.ImportOptions | None) -> pm.Model:
        return pm.Model.from_bytes(self.step, "step", name=name, import_options=options)


def shape_of(source: Any, what: str = "Part") -> Any:
    """The shape of an object in the coordinates of the document."""
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise Problem(f"{what} is '{source.Label}', which has no shape; it must be a body or a surface. Meshes cannot be milled: make a "
                      "shape of them first.")
    placed = shape.copy()
    if hasattr(source, "getGlobalPlacement"):
        placed.Placement = source.getGlobalPlacement()
    return placed


def step_of(shape: Any) -> bytes:
    """The STEP file of a shape."""
    with tempfile.TemporaryDirectory(prefix="patchmill-") as folder:
        path = pathlib.Path(folder) / "part.step"
        shape.exportStep(str(path))
        if not path.is_file():
            raise Problem("FreeCAD wrote no STEP file of the part; check its geometry (Part > Check geometry).")
        return _COUNT.sub(rb"'Body\1'", _TIME.sub(rb"\1'2000-01-01T00:00:00'", path.read_bytes()))


def body_of(source: Any, what: str = "Part") -> Body:
    shape = shape_of(source, what)
    if not shape.Faces:
        raise Problem(f"{what} is '{source.Label}', which has no faces; it must be a body or a surface.")
    return Body(shape, step_of(shape), source.Label)


def _center(box: Any) -> tuple[float, float, float]:
    return ((box.XMin + box.XMax) / 2, (box.YMin + box.YMax) / 2, (box.ZMin + box.ZMax) / 2)


def _far(info: pm.FaceInfo, face: Any) -> float:
    box = face.optimalBoundingBox() if hasattr(face, "optimalBoundingBox") else face.BoundBox
    low, high = info.box.min, info.box.max
    ours = ((low.x_mm + high.x_mm) / 2, (low.y_mm + high.y_mm) / 2, (low.z_mm + high.z_mm) / 2)
    return max(abs(a - b) for a, b in zip(ours, _center(box)))


def _is_same(info: pm.FaceInfo, face: Any) -> bool:
    return abs(info.area_mm2 - face.Area) <= AREA_PART * face.Area and _far(info, face) <= BOX_MM + 1e-2 * face.BoundBox.DiagonalLength


def face_ids(body: Body, names: Sequence[str], options: pm.ImportOptions | None, what: str) -> list[str]:
    """The ids that the service gives to faces of FreeCAD ("Face12"). Both count alike as a rule; area and
    place decide."""
    wanted = [name.rsplit(".", 1)[-1] for name in names if name]
    if not wanted:
        return []
    for name in wanted:
        number = name.removeprefix("Face")
        if not name.startswith("Face") or not number.isdigit():
            raise Problem(f"{what} has '{name}'; it must have faces only: select faces of the body.")
        if int(number) > len(body.shape.Faces):
            raise Problem(f"{what} has {name}, and '{body.label}' has {len(body.shape.Faces)} faces: select the faces again.")
    infos = list(service.client().check(body.model(body.label, options), with_faces=True).faces)
    ids = []
    for name in wanted:
        index = int(name.removeprefix("Face")) - 1
        face = body.shape.Faces[index]
        if index < len(infos) and _is_same(infos[index], face):
            ids.append(infos[index].face.id)
            continue
        found = [info for info in infos if _is_same(info, face)]
        if len(found) != 1:
            raise Problem(f"{what} has {name}; {len(found)} faces of the STEP file have its area and place, and one must: check the "
                          "geometry of the body (Part > Check geometry), or mill a copy of it (Part > Create a copy > Refine shape).")
        ids.append(found[0].face.id)
    return ids


def boundary_of(source: Any, zero: tuple[float, float, float], chord_mm: float) -> list[list[tuple[float, float]]]:
    """The closed wires of a sketch or a wire, as outlines in plan."""
    shape = shape_of(source, "Boundary")
    rings = []
    for wire in shape.Wires:
        if not wire.isClosed():
            raise Problem(f"Boundary is '{source.Label}', which has an open wire; all its wires must be closed.")
        edges_are_straight = all(isinstance(edge.Curve, Part.Line) for edge in wire.Edges)
        points = [v.Point for v in wire.OrderedVertexes] if edges_are_straight else wire.discretize(Deflection=chord_mm)[:-1]
        rings.append([(p.x - zero[0], p.y - zero[1]) for p in points])
    if not rings:
        raise Problem(f"Boundary is '{source.Label}', which has no wires; it must be a sketch or closed wires.")
    return rings

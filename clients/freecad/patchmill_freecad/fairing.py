"""A measured curve, faired as an elastic beam: a document object that follows its source."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import numpy as np
import Part
import patchmill as pm

from . import console, properties, service
from .options import RESULT, Option
from .problem import Problem
from .proxy import Proxy

FAIR = "Fairing"
FEWEST_POINTS = 4
USUAL_BAND = 0.002  # of the diagonal of the points' box, as the command line has it
STOPS = (("Signs", "SIGNS"), ("Energy", "SIGNS_AND_ENERGY"), ("Iterations", "ITERATIONS"))
OPTIONS = (
    Option("Source", FAIR, "LinkGlobal", None, "Wire, sketch, or points that were measured"),
    Option("Band", FAIR, "Length", 0.0, "How far each coordinate of a point may move. 0: 0.2 % of the diagonal of the box of all points"),
    Option("Iterations", FAIR, "Integer", 50, "Largest number of iterations, 0 to 10000. 0: the curve through the points as they are"),
    Option("Stop", FAIR, "Enumeration", "Signs", "End when no curvature changes its sign, when the energy settles, too, or not earlier", "",
           STOPS),
    Option("Locked", FAIR, "IntegerList", (), "Points that do not move, from 0"),
    Option("LargestMove", RESULT, "Length", 0.0, "Distance by which a point has moved at most"),
    Option("Outcome", RESULT, "String", "", "What has become of the curve"),
)


def points_of(source: Any) -> list[Any]:
    """The points of a Draft wire, a point cloud, a sketch or a wire, in order, in the coordinates of the
    document."""
    listed = getattr(source, "Points", None)
    place = source.getGlobalPlacement() if hasattr(source, "getGlobalPlacement") else App.Placement()
    if listed is not None:
        return [place.multVec(App.Vector(point)) for point in getattr(listed, "Points", listed)]
    shape = getattr(source, "Shape", None)
    if shape is None or shape.isNull():
        raise Problem(f"Source is '{source.Label}', which has neither points nor a wire; it must be a wire, a sketch, or points.")
    placed = shape.copy()
    placed.Placement = place
    wires = placed.Wires or ([Part.Wire(Part.sortEdges(placed.Edges)[0])] if placed.Edges else [])
    if len(wires) > 1:
        raise Problem(f"Source is '{source.Label}' with {len(wires)} wires; it must have one: fair each by itself.")
    return [vertex.Point for vertex in (wires[0].OrderedVertexes if wires else placed.Vertexes)]


class FairedCurve(Proxy):
    """Proxy of PatchmillFairedCurve."""

    def _add_properties(self, document_object: Any) -> None:
        properties.add(document_object, OPTIONS)

    def execute(self, document_object: Any) -> None:
        try:
            self._execute(document_object)
        except Exception as problem:
            text = console.text_of(problem)
            console.error(f"{document_object.Label}: {text}")
            document_object.Shape, document_object.Outcome = Part.Shape(), f"FAILED: {text}"

    def _execute(self, document_object: Any) -> None:
        if document_object.Source is None:
            raise Problem("Source is empty; it must be a wire, a sketch, or points.")
        points = points_of(document_object.Source)
        if len(points) < FEWEST_POINTS:
            raise Problem(f"Source is '{document_object.Source.Label}' with {len(points)} points; it must have {FEWEST_POINTS} or more: "
                          "fairing moves the points that were measured, so give the wire through them, not a curve.")
        values = properties.values(document_object, OPTIONS)
        side = values["Band"]
        band = pm.FairingBand(x_mm=side, y_mm=side, z_mm=side) if side else pm.FairingBand(fraction=USUAL_BAND)
        locks = [pm.PointLock(point_index=index) for index in values["Locked"]]
        result = service.client().fair(np.array([list(point) for point in points]), band=band, locks=locks,
                                       max_iterations=values["Iterations"], stop=pm.FairingStop[dict(STOPS)[values["Stop"]]])
        faired = [App.Vector(*map(float, point)) for point in result.points_mm]
        curve = Part.BSplineCurve()
        curve.interpolate(faired)
        document_object.Shape = curve.toShape()
        document_object.LargestMove, document_object.Outcome = result.max_moved_mm, str(result)
        console.message(f"{document_object.Label}: {result}")


def create(source: Any, document: Any = None, locked: Sequence[int] = ()) -> Any:
    document = document or source.Document
    made = document.addObject("Part::FeaturePython", "PatchmillFairedCurve")
    FairedCurve(made)
    made.Label = f"Faired {source.Label}"
    made.Source, made.Locked = source, list(locked)
    if App.GuiUp:
        from .view import ViewProvider

        ViewProvider(made.ViewObject)
    return made

"""What operation and verification share: their properties, when they are computed, and what becomes of
errors."""
from __future__ import annotations

import hashlib
import json
import pathlib
from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import Path
import patchmill as pm

from . import cam_job, console, frame, model, progress, properties
from .job import Links, Values
from .moves import Command, commands
from .options import RESULT, Option
from .problem import Problem
from .proxy import Proxy

CHORD_PART = 0.05  # of the tolerance: how far chords in the tree leave the arcs of the program


class Feature(Proxy):
    """The proxy of a document object whose Path is that of a program."""

    OPTIONS: tuple[Option, ...] = ()

    def _add_properties(self, document_object: Any) -> None:
        properties.add(document_object, self.OPTIONS)
        if "Inputs" not in document_object.PropertiesList:
            document_object.addProperty("App::PropertyString", "Inputs", RESULT, "Digest of what the result was computed from")
            document_object.setEditorMode("Inputs", 2)

    def execute(self, document_object: Any) -> None:
        """Computes the object if anything has changed. Whatever goes wrong is a message, never a
        traceback."""
        try:
            self._execute(document_object)
        except Exception as problem:
            text = console.text_of(problem)
            console.error(f"{document_object.Label}: {text}")
            self._clear(document_object, f"FAILED: {text}")

    def _execute(self, document_object: Any) -> None:
        if not document_object.Active:
            self._clear(document_object, "INACTIVE")
            return
        if document_object.Part is None:
            self._clear(document_object, "NO PART")
            raise Problem("Part is empty; it must be a body, or faces of one: select them and choose the command, or set Part.")
        values = properties.values(document_object, self.OPTIONS)
        body = model.body_of(document_object.Part[0])
        links = self._links(document_object, values, body)
        inputs = self._digest(document_object, values, body, links)
        if inputs == document_object.Inputs and not self._is_missing(document_object):
            return
        with progress.progress_bar(document_object.Label) as bar:
            self._compute(document_object, values, body, links, bar)
        document_object.Inputs = inputs

    def _compute(self, document_object: Any, values: Values, body: model.Body, links: Links, bar: progress.Bar) -> None:
        raise NotImplementedError

    def _is_missing(self, document_object: Any) -> bool:
        """Whether a file of the result is gone or was never written."""
        return False

    def _digest(self, document_object: Any, values: Values, body: model.Body, links: Links) -> str:
        inputs = {name: value for name, value in values.items() if name not in self._results()}
        text = json.dumps([inputs, body.sha256, document_object.Label, repr(links)], default=str, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def _results(self) -> set[str]:
        return {option.name for option in self.OPTIONS if option.group == RESULT}

    def _clear(self, document_object: Any, outcome: str) -> None:
        """Without a valid result there is neither a path nor a figure."""
        document_object.Path = Path.Path()
        document_object.Outcome, document_object.Inputs = outcome, ""
        document_object.Findings, document_object.NotReached, document_object.CycleTime = [], "", ""
        document_object.LargestGouge = document_object.LargestLeftover = 0.0

    def _zero(self, values: Values, what: str) -> tuple[float, float, float]:
        """The program zero in the document, for places that the document states."""
        if values["UpAxis"] != "Z" or values["ProgramZero"] not in ("Not stated", "Origin", "Point"):
            raise Problem(f"{what} needs UpAxis Z and ProgramZero Origin or Point, and they are {values['UpAxis']} and "
                          f"{values['ProgramZero']}: its place in the program is not known else.")
        return values["ZeroPoint"] if values["ProgramZero"] == "Point" else (0.0, 0.0, 0.0)

    def links(self, document_object: Any) -> Links:
        """What the links of the object lead to."""
        return self._links(document_object, properties.values(document_object, self.OPTIONS), model.body_of(document_object.Part[0]))

    def _links(self, document_object: Any, values: Values, body: model.Body) -> Links:
        options = pm.ImportOptions(border_tolerance_mm=values["BorderTolerance"]) if values["BorderTolerance"] else None
        stock, clamps, boundary = None, [], []
        if values["StockKind"] == "Job":
            job = cam_job.job_of(document_object) or cam_job.job_of(document_object.Part[0])
            stock = None if job is None else cam_job.stock_of(job, self._zero(values, "StockKind Job"))
        if document_object.Clamps:
            zero = self._zero(values, "Clamps")
            clamps = [cam_job.clamp_of(clamp, zero) for clamp in document_object.Clamps]
        if document_object.Boundary is not None:
            boundary = model.boundary_of(document_object.Boundary, self._zero(values, "Boundary"), 0.5 * values["Tolerance"])
        return Links(
            patch_ids=model.face_ids(body, document_object.Part[1], options, "Part"),
            avoid_ids=self._avoided(document_object, body, options),
            tool=None if document_object.ToolController is None else cam_job.tool_of(document_object.ToolController),
            stock=stock, clamps=clamps, boundary=boundary)

    def _avoided(self, document_object: Any, body: model.Body, options: pm.ImportOptions | None) -> Sequence[str]:
        if document_object.Avoid is None:
            return ()
        avoided, names = document_object.Avoid
        if avoided != document_object.Part[0]:
            raise Problem(f"Avoid is '{avoided.Label}'; it must be faces of the body of Part, '{body.label}'.")
        if not any(names):
            raise Problem("Avoid names no face; select the faces, or empty Avoid.")
        return model.face_ids(body, names, options, "Avoid")

    def _show(self, document_object: Any, result: Any, values: Values, header: list[Command]) -> None:
        """Findings, figures and path of a result."""
        report = result.report
        document_object.Findings = console.findings(document_object.Label, result.findings)
        document_object.Outcome = result.outcome.name
        document_object.LargestGouge, document_object.LargestLeftover = report.max_gouge_mm, report.max_leftover_mm
        figures = result.figures
        document_object.NotReached, document_object.CycleTime = figures["not reached"], figures.get("time", "")
        moves = [] if result.path is None else path_commands(result.path, header, CHORD_PART * values["Tolerance"])
        document_object.Path = Path.Path(moves)
        sheet = report.setup_sheet
        zero = sheet.program_zero if sheet is not None else None
        place = (zero.x_mm, zero.y_mm, zero.z_mm) if zero is not None else (0.0, 0.0, 0.0)
        document_object.Placement = App.Placement(App.Matrix(*frame.matrix_values(values["UpAxis"], place)))
        console.message(f"{document_object.Label}: {result.outcome.name}: largest gouge {figures['largest gouge']}, largest leftover "
                        f"{figures['largest leftover']}, not reached {figures['not reached']}")


def path_commands(path: pm.Path, header: list[Command], chord_mm: float) -> list[Any]:
    return [Path.Command(name, words) for name, words in commands(path, header, chord_mm)]


def file_beside(document: Any, name: str) -> pathlib.Path | None:
    """A file of this name beside the document; None if the document was never saved."""
    return pathlib.Path(document.FileName).parent / name if document.FileName else None

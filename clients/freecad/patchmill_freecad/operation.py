"""The document object of an operation: from a body to a verified program."""
from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from . import cam_job, console, model, output, progress, service
from .feature import Feature, file_beside
from .job import JobRequest, Links, Values, job_request
from .moves import Command
from .options import DIALECTS, OPERATION
from .problem import Problem


class Operation(Feature):
    """Proxy of PatchmillOperation."""

    OPTIONS = OPERATION

    def _compute(self, document_object: Any, values: Values, body: model.Body, links: Links, bar: progress.Bar) -> None:
        request = job_request(values, links)
        name = model_name(document_object)
        result = service.client().mill(body.model(name, request.import_options), request.operation, setup=request.setup, post=request.post,
                                       progress=bar)
        self._show(document_object, result, values, _header(document_object, request))
        if values["ModelFile"]:
            output.write(pathlib.Path(values["ModelFile"]), body.step, "ModelFile")
        if values["ReportFile"]:
            output.write(pathlib.Path(values["ReportFile"]), result.report_json().encode(), "ReportFile")
        if values["PageFile"]:
            output.write(pathlib.Path(values["PageFile"]), result.page().encode(), "PageFile")
        file = program_file(document_object, values)
        if not result.has_program:
            self._say_stale(document_object, file)
            raise Problem(f"there is no program: {result.outcome.name}. " + " ".join(
                finding.message for finding in result.findings if finding.code == result.outcome.name or finding.severity.name == "ERROR"))
        if file is None:
            console.warning(f"{document_object.Label}: no program file was written: set ProgramFile, or save the document and "
                            "mark the operation to recompute.")
            document_object.WrittenFile = ""
            return
        output.write(file, result.program_bytes, "ProgramFile")
        document_object.WrittenFile = str(file)
        console.message(f"{document_object.Label}: program {file}")

    def _clear(self, document_object: Any, outcome: str) -> None:
        super()._clear(document_object, outcome)
        if document_object.WrittenFile:
            self._say_stale(document_object, pathlib.Path(document_object.WrittenFile))
            document_object.WrittenFile = ""

    def _say_stale(self, document_object: Any, file: pathlib.Path | None) -> None:
        if file is not None and file.is_file():
            console.warning(f"{document_object.Label}: {file} is of an earlier state of the operation: do not run it.")

    def _is_missing(self, document_object: Any) -> bool:
        file = program_file(document_object, {"ProgramFile": document_object.ProgramFile, "Dialect": document_object.Dialect})
        return file is not None and not (str(file) == document_object.WrittenFile and file.is_file())


def model_name(document_object: Any) -> str:
    """The name of the part in the header of the program: that of the model file, if there is one."""
    return pathlib.Path(document_object.ModelFile).name if document_object.ModelFile else f"{document_object.Part[0].Label}.step"


def program_file(document_object: Any, values: Values) -> pathlib.Path | None:
    if values["ProgramFile"]:
        return pathlib.Path(values["ProgramFile"])
    label = "".join("_" if letter in '/\\:*?"<>|' else letter for letter in document_object.Label)
    return file_beside(document_object.Document, label + DIALECTS.get(values["Dialect"], ".nc"))


def _header(document_object: Any, request: JobRequest) -> list[Command]:
    """Tool change and spindle, unless a tool controller of the job has them."""
    if document_object.ToolController is not None:
        return []
    tool = request.operation.tool
    return [("M6", {"T": float(tool.number)}), ("M3", {"S": float(tool.spindle_rpm)})]


def create(part: Any, faces: Sequence[str] = (), document: Any = None, job: Any = None) -> Any:
    """Adds an operation for a body, or for faces of it. In a job of FreeCAD it takes tool, feeds and stock
    from there. Nothing is computed before the document is."""
    document = document or part.Document
    made = document.addObject("Path::FeaturePython", "PatchmillOperation")
    Operation(made)
    made.Label = f"Mill {part.Label}"
    made.Part = (part, list(faces))
    take_from_job(made, job or cam_job.job_of(part))
    if App.GuiUp:
        from .view import ViewProvider

        ViewProvider(made.ViewObject)
    return made


def take_from_job(operation: Any, job: Any) -> None:
    """Tool controller, stock, work offset and place in the tree of a job."""
    if job is None:
        return
    controller = cam_job.ball_controller(job)
    if controller is None:
        console.warning(f"{operation.Label}: job '{job.Label}' has no tool with a ball end: add one, and set ToolController.")
    operation.ToolController = controller
    if getattr(job, "Stock", None) is not None:
        operation.StockKind, operation.ProgramZero = "Job", "Origin"
    fixtures = [fixture for fixture in getattr(job, "Fixtures", ()) if fixture in ("G54", "G55", "G56", "G57", "G58", "G59")]
    if fixtures:
        operation.WorkOffset = fixtures[0]
    cam_job.add_operation(job, operation)

"""The document object of a verification: any program against a body."""
from __future__ import annotations

import hashlib
import pathlib
from collections.abc import Sequence
from typing import Any

import FreeCAD as App

from . import cam_job, console, model, output, progress, service
from .feature import Feature
from .job import Links, Values, verification_arguments
from .options import VERIFICATION
from .problem import Problem


class Verification(Feature):
    """Proxy of PatchmillVerification. Its Path is the motion of the program as the control would run it."""

    OPTIONS = VERIFICATION

    def _program(self, values: Values) -> bytes:
        if not values["ProgramFile"]:
            raise Problem("ProgramFile is empty; it must be the file of the program to verify.")
        try:
            return pathlib.Path(values["ProgramFile"]).read_bytes()
        except OSError as error:
            raise Problem(f"ProgramFile '{values['ProgramFile']}' cannot be read ({error.strerror}): choose the file of the "
                          "program.") from None

    def _digest(self, document_object: Any, values: Values, body: model.Body, links: Links) -> str:
        return super()._digest(document_object, values, body, links) + hashlib.sha256(self._program(values)).hexdigest()

    def _compute(self, document_object: Any, values: Values, body: model.Body, links: Links, bar: progress.Bar) -> None:
        request, arguments = verification_arguments(values, links)
        program = self._program(values)
        name = f"{document_object.Part[0].Label}.step"
        # A feed that nobody stated is no limit.
        tool = request.operation.tool
        if tool.cutting_data_is_default and not (links.tool.plunge_feed_mm_per_min if links.tool else values["PlungeFeed"]):
            tool.plunge_feed_mm_per_min = 0.0
        result = service.client().verify(body.model(name, request.import_options), program, tool, progress=bar, **arguments)
        self._show(document_object, result, values, [])
        if values["ReportFile"]:
            output.write(pathlib.Path(values["ReportFile"]), result.report_json().encode(), "ReportFile")
        if values["PageFile"]:
            output.write(pathlib.Path(values["PageFile"]), result.page().encode(), "PageFile")
        if not result.is_good:
            console.error(f"{document_object.Label}: do not run {values['ProgramFile']}: {result.outcome.name}.")


def create(part: Any, program: str | pathlib.Path = "", faces: Sequence[str] = (), document: Any = None) -> Any:
    """Adds the verification of a program on a body. In a job of FreeCAD it takes the tool from there."""
    document = document or part.Document
    made = document.addObject("Path::FeaturePython", "PatchmillVerification")
    Verification(made)
    made.Label = f"Verify {part.Label}"
    made.Part = (part, list(faces))
    made.ProgramFile = str(program)
    job = cam_job.job_of(part)
    if job is not None:
        made.ToolController = cam_job.ball_controller(job)
    if App.GuiUp:
        from .view import ViewProvider

        ViewProvider(made.ViewObject)
    return made

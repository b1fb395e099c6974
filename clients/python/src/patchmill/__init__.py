"""Verified finishing programs for ball-end mills from free-form models: a client of the Patchmill service.

    import patchmill as pm

    with pm.Client() as client:
        result = client.mill("part.step", pm.Operation(tool=pm.ball(6), scallop_mm=0.02, tolerance_mm=0.01))
        result.save("part.ngc")
"""
from . import errors, messages
from ._call import Canceller
from ._connection import Tls
from .client import AsyncClient, Client
from .errors import *  # noqa: F401, F403
from .meshes import Mesh
from .messages import *  # noqa: F401, F403
from .milling import VIEW
from .models import Model
from .paths import Path
from .results import BuildResult, CheckResult, ConvertResult, EditResult, FairCurveResult, FairNetResult, LinesResult, MillResult
from .results import PreviewResult, ReachResult, RegionsResult, SurfaceValues, VerifyResult
from .retry import Retry
from .tools import ball
from .uploading import UploadResult

__all__ = [
    "AsyncClient", "BuildResult", "Canceller", "CheckResult", "Client", "ConvertResult", "EditResult", "FairCurveResult",
    "FairNetResult", "LinesResult", "Mesh", "MillResult", "Model", "Path", "PreviewResult", "ReachResult", "RegionsResult", "Retry",
    "SurfaceValues", "Tls", "UploadResult", "VIEW", "VerifyResult", "ball", *errors.__all__, *messages.__all__,
]

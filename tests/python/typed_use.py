"""What mypy must know about the package. It is checked, not run: assert_type states what a user gets, and an
error that is ignored must be one."""
from collections.abc import Sequence
from typing import assert_type

import numpy as np
import patchmill as pm
from numpy.typing import NDArray


def wait() -> None:
    with pm.Client("127.0.0.1:50051", tls=pm.Tls(ca="ca.pem"), token=lambda: "secret") as client:
        operation = pm.Operation(tool=pm.ball(6), scallop_mm=0.01, tolerance_mm=0.01,
                                 selection=pm.Selection(boundary_xy_mm=np.zeros((3, 2))))
        result = assert_type(client.mill("part.step", operation, setup=pm.Setup(up=pm.UpAxis.Y)), pm.MillResult)
        assert_type(result.report.max_gouge_mm, float)
        assert_type(result.program, str)
        if result.path is not None:
            assert_type(result.path.tip_mm, NDArray[np.float64])
        assert_type(client.evaluate("part.step", [0], [[0.5, 0.5]]).points_mm, NDArray[np.float64])
        assert_type(client.posts(), Sequence[pm.PostInfo])
        assert_type(client.check("part.step").findings, Sequence[pm.Diagnostic])
        client.mill("part.step", operation, scale=3)  # type: ignore[call-arg]
        client.mill(7, operation)  # type: ignore[arg-type]
        client.mill("part.step", pm.Operation(strategy="contour"))  # type: ignore[arg-type]
        operation.scalop_mm = 3  # type: ignore[attr-defined]


async def go_on() -> None:
    async with pm.AsyncClient() as client:
        assert_type(await client.regions("part.step", pm.Operation()), pm.RegionsResult)

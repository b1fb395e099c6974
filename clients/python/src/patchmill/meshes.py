"""The surface as triangles, for drawing."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._message import array_of


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """Triangles of the surface. Lengths in mm, program frame. Nothing is planned or verified on them.

    position_mm: vertices on the surface, x y z.
    normal: unit normal of each vertex, to the side from which the tool comes; 0 0 0 where the surface has
        none.
    slope_deg: angle between normal and +Z at each vertex.
    contour_curvature_per_mm: curvature of the contour at each vertex, > 0 where it bends inward (basin).
    leftover_mm: what stays at each vertex. None without a verified program.
    gouge_mm: gouge at each vertex, >= 0. None without a verified program.
    corners: the three vertices of each triangle.
    patch_index: patch of each triangle: position in the model.
    region_id: region of each triangle; -1 in none.
    chord_mm: distance between triangles and surface, estimated.
    patch_names: what each patch is called: face id, or the client's own id, or empty.
    """

    position_mm: NDArray[np.float32]
    normal: NDArray[np.float32]
    slope_deg: NDArray[np.float32]
    contour_curvature_per_mm: NDArray[np.float32]
    leftover_mm: NDArray[np.float32] | None
    gouge_mm: NDArray[np.float32] | None
    corners: NDArray[np.int32]
    patch_index: NDArray[np.int32]
    region_id: NDArray[np.int32]
    chord_mm: float
    patch_names: list[str]

    def __repr__(self) -> str:
        return f"<Mesh: {len(self.position_mm)} vertices, {len(self.corners)} triangles, within {self.chord_mm:.4g} mm>"


def mesh_of(blocks: Sequence[Any]) -> Mesh | None:
    """The mesh of MeshBlocks; None if there are none."""
    if not blocks:
        return None

    def joined(name: str, kind: Any, columns: int = 1) -> NDArray[Any]:
        return np.concatenate([array_of(getattr(block, name), kind, columns) for block in blocks])

    position = joined("position_mm", np.float32, 3)
    leftover, gouge = joined("leftover_mm", np.float32), joined("gouge_mm", np.float32)
    # The corners of each block count its own vertices.
    firsts = np.cumsum([0] + [len(block.position_mm) // 3 for block in blocks])
    corners = [array_of(block.corners, np.int32, 3) + np.int32(first) for block, first in zip(blocks, firsts)]
    return Mesh(
        position_mm=position,
        normal=joined("normal", np.float32, 3),
        slope_deg=joined("slope_deg", np.float32),
        contour_curvature_per_mm=joined("contour_curvature_per_mm", np.float32),
        leftover_mm=leftover if len(leftover) == len(position) else None,
        gouge_mm=gouge if len(gouge) == len(position) else None,
        corners=np.concatenate(corners),
        patch_index=joined("patch_index", np.int32),
        region_id=joined("region_id", np.int32),
        chord_mm=max(block.chord_mm for block in blocks),
        patch_names=[name for block in blocks for name in block.patch_names])

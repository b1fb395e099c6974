"""The moves of a program as arrays."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._message import array_of
from .messages import MoveKind

Blocks = Sequence[Any]


@dataclass(frozen=True, eq=False, repr=False)
class Path:
    """The moves of a program in order, one row or number each. Lengths in mm, program frame. The motion
    begins at the end of the first move.

    tip_mm: end of the move: tip of the tool, x y z.
    contact_mm: contact point at the end of the move, x y z; NaN where the ball does not touch.
    contact_patch_index: patch of the contact point: position in the model; -1 where the ball does not touch.
    kind: purpose, a MoveKind. From verify, every feed is MoveKind.CUT.
    pass_kind: kind of the pass, a PassKind; 0 between passes.
    region_id: region in which most of the pass lies; -1 between regions.
    pass_index: position of the pass in the order of cutting; -1 between passes.
    feed_mm_per_min: feed; 0 for rapids.
    seconds: time of the move.
    line: line of the program that makes the move, from 1; 0 for the first.
    arc_plane: ArcPlane of an arc; 0 where the move is straight.
    arc_center_mm: centre of an arc, x y z; NaN where the move is straight.
    arc_turns: turns of an arc, counter-clockwise (G3) > 0; 0 where the move is straight.
    """

    tip_mm: NDArray[np.float64]
    contact_mm: NDArray[np.float64]
    contact_patch_index: NDArray[np.int32]
    kind: NDArray[np.int32]
    pass_kind: NDArray[np.int32]
    region_id: NDArray[np.int32]
    pass_index: NDArray[np.int32]
    feed_mm_per_min: NDArray[np.float32]
    seconds: NDArray[np.float32]
    line: NDArray[np.int32]
    arc_plane: NDArray[np.int32]
    arc_center_mm: NDArray[np.float64]
    arc_turns: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.kind)

    def is_kind(self, kind: MoveKind) -> NDArray[np.bool_]:
        """Which moves are of this kind."""
        chosen: NDArray[np.bool_] = self.kind == int(kind)
        return chosen

    def __repr__(self) -> str:
        return f"<Path: {len(self)} moves, {int(np.count_nonzero(self.arc_plane))} of them arcs, {float(self.seconds.sum()):.1f} s>"


def _joined(blocks: Blocks, name: str, kind: Any, columns: int = 1) -> NDArray[Any]:
    return np.concatenate([array_of(getattr(block, name), kind, columns) for block in blocks])


def _or_fill(values: NDArray[Any], count: int, fill: int) -> NDArray[Any]:
    return values if len(values) == count else np.full(count, fill, dtype=values.dtype)


def _spread(values: NDArray[Any], where: NDArray[np.bool_], fill: float) -> NDArray[Any]:
    """The values in the rows that `where` names, `fill` in all others."""
    spread = np.full((len(where), *values.shape[1:]), fill, dtype=np.float64)
    spread[where] = values
    return spread


def path_of(blocks: Blocks) -> Path | None:
    """The path of PathBlocks; None if there are none."""
    if not blocks:
        return None
    line = _joined(blocks, "line", np.int32)
    count = len(line)
    patch = _or_fill(_joined(blocks, "contact_patch_index", np.int32), count, -1)
    plane = _joined(blocks, "arc_plane", np.int32)
    return Path(
        tip_mm=_joined(blocks, "tip_mm", np.float64, 3),
        contact_mm=_spread(_joined(blocks, "contact_mm", np.float64, 3), patch >= 0, np.nan),
        contact_patch_index=patch,
        kind=_joined(blocks, "kind", np.int32),
        pass_kind=_or_fill(_joined(blocks, "pass_kind", np.int32), count, 0),
        region_id=_or_fill(_joined(blocks, "region_id", np.int32), count, -1),
        pass_index=_or_fill(_joined(blocks, "pass_index", np.int32), count, -1),
        feed_mm_per_min=_joined(blocks, "feed_mm_per_min", np.float32),
        seconds=_joined(blocks, "seconds", np.float32),
        line=line,
        arc_plane=plane,
        arc_center_mm=_spread(_joined(blocks, "arc_center_mm", np.float64, 3), plane != 0, np.nan),
        arc_turns=_spread(_joined(blocks, "arc_turns", np.float64), plane != 0, 0.0))

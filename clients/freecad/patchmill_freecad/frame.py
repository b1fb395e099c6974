"""From the program frame back to the document: how UpAxis and the program zero lay the part."""
from __future__ import annotations

Row = tuple[float, float, float]

# Setup.up: what the point (x, y, z) of the model becomes.
ROWS: dict[str, tuple[Row, Row, Row]] = {
    "Z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "Y": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "X": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "-Z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "-Y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "-X": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
}


def to_document(up: str, zero: Row) -> tuple[tuple[Row, Row, Row], Row]:
    """Rotation (as rows) and translation that take a point of the program frame to the document."""
    rows = ROWS[up]
    back = tuple(tuple(rows[k][i] for k in range(3)) for i in range(3))  # the inverse of a rotation is its transpose
    moved = tuple(sum(back[i][k] * zero[k] for k in range(3)) for i in range(3))
    return back, moved  # type: ignore[return-value]


def matrix_values(up: str, zero: Row) -> list[float]:
    """The same as the sixteen numbers of FreeCAD's Matrix, row by row."""
    rotation, translation = to_document(up, zero)
    values: list[float] = []
    for row, move in zip(rotation, translation):
        values += [*map(float, row), float(move)]
    return [*values, 0.0, 0.0, 0.0, 1.0]

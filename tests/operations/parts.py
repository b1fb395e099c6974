"""Models for jobs that several servers share."""
import json
import math
import pathlib

from support import worked_request


def small_part(folder: pathlib.Path) -> str:
    """The dome of the worked request, as a file."""
    from google.protobuf import json_format
    model = worked_request("GenerateProgram")[0].job.source.model
    path = folder / "dome.json"
    path.write_text(json_format.MessageToJson(model, preserving_proto_field_name=True))
    return str(path)


def _height(x: float, y: float) -> float:
    return 3 + math.sin(x / 7) + math.cos(y / 9)


def _patch(at: tuple[float, float], width: float, degree: int) -> list[float]:
    """A bilinear patch between four heights, written in a higher degree: neighbours meet exactly."""
    heights = [[_height(at[0] + width * p, at[1] + width * q) for q in (0, 1)] for p in (0, 1)]
    points = []
    for i in range(degree + 1):
        for j in range(degree + 1):
            u, v = i / degree, j / degree
            z = (1 - u) * ((1 - v) * heights[0][0] + v * heights[0][1]) + u * ((1 - v) * heights[1][0] + v * heights[1][1])
            points += [at[0] + width * u, at[1] + width * v, z]
    return points


def large_part(folder: pathlib.Path) -> str:
    """A hilly square of 40 mm in 7,569 patches: more than 40 MB, as JSON often is, a number a line."""
    count, side, degree = 87, 40.0, 7
    width = side / count
    patches = [{"bezier": {"degree_u": degree, "degree_v": degree, "points": _patch((width * i, width * j), width, degree)}}
               for i in range(count) for j in range(count)]
    path = folder / "hills.json"
    path.write_text(json.dumps({"length_unit": "LENGTH_UNIT_MILLIMETER", "patches": patches}, indent=2))
    assert path.stat().st_size > 40_000_000
    return str(path)

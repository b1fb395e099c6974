"""Models: files, bytes, control nets, curve networks, and parts of CAD programs in Python."""
from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol, Union, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from ._message import set_fields, to_message
from .errors import OptionError
from .messages import BezierPatch, CurveNetwork, ImportOptions, LengthUnit, ModelFile, ModelSource, Patch, PatchModel
from .v1 import model_pb2

# Formats that the ending of a file states; others are known by their content.
STATED_FORMATS = frozenset({"bpt", "bv", "bez", "patches", "step", "stp", "p21", "iges", "igs"})


@runtime_checkable
class ExportsStep(Protocol):
    """A part that writes itself as STEP, as the shapes of CadQuery do."""

    def exportStep(self, fileName: str) -> Any: ...  # noqa: N802, N803: the name that CadQuery has


@dataclass(frozen=True)
class Model:
    """A model as it is sent. Make it by one of the functions from_...; wherever a model is wanted, the path
    of a file, a PatchModel, a CurveNetwork or a part with exportStep(path) will do, too.

    source: the model of the request.
    name: name of the part in the program header and in pictures.
    inline: the whole model, where `source` names it by its digest only.
    """

    source: ModelSource
    name: str = ""
    inline: Model | None = field(default=None, repr=False)

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], *, length_unit: LengthUnit = LengthUnit.UNSPECIFIED,
                  import_options: ImportOptions | None = None) -> Model:
        """A model file: .step, .stp, .iges, .igs, .json, .pb, .bpt, .bv, .bez or .patches."""
        file = pathlib.Path(path)
        ending = file.suffix.lower().removeprefix(".")
        return cls.from_bytes(file.read_bytes(), ending if ending in STATED_FORMATS else "", name=file.name, length_unit=length_unit,
                              import_options=import_options)

    @classmethod
    def from_bytes(cls, content: bytes, format: str = "", *, name: str = "", length_unit: LengthUnit = LengthUnit.UNSPECIFIED,
                   import_options: ImportOptions | None = None) -> Model:
        """The bytes of a model file. `format` is its ending; empty: a PatchModel in JSON or binary form."""
        stated = ModelFile(content=bytes(content), format=format, length_unit=length_unit, import_options=import_options)
        return cls(ModelSource(file=stated), name)

    @classmethod
    def from_patches(cls, nets: ArrayLike | Sequence[ArrayLike], *, length_unit: LengthUnit = LengthUnit.MILLIMETER,
                     ids: Sequence[str] = (), weights: Sequence[ArrayLike | None] = (), join_tolerance_mm: float | None = None,
                     name: str = "") -> Model:
        """Bezier patches. Each net is an array of control points with the shape (along u, along v, 3); one
        net alone will do, too.

        weights: for each net none, or an array of the shape (along u, along v): the patch is rational.
        """
        patches = [_bezier(net, f"nets[{k}]") for k, net in enumerate(_nets_of(nets))]
        for what, values in (("ids", ids), ("weights", weights)):
            if values and len(values) != len(patches):
                raise OptionError(what, f"has {len(values)} entries; it must have one for each of the {len(patches)} nets")
        for k, weight in enumerate(weights):
            if weight is not None:
                _set_weights(patches[k], weight, f"weights[{k}]")
        made = [Patch(id=ids[k] if ids else "", bezier=bezier) for k, bezier in enumerate(patches)]
        return cls.from_message(PatchModel(length_unit=length_unit, patches=made, join_tolerance_mm=join_tolerance_mm), name=name)

    @classmethod
    def from_network(cls, network: CurveNetwork, *, length_unit: LengthUnit = LengthUnit.MILLIMETER, name: str = "") -> Model:
        """A curve network: the server joins it into one patch for each face."""
        return cls.from_message(PatchModel(length_unit=length_unit, network=network), name=name)

    @classmethod
    def from_message(cls, model: PatchModel, *, name: str = "") -> Model:
        """Patches of any kind, or a curve network, as the contract states them."""
        return cls(ModelSource(model=model), name)

    @classmethod
    def from_cad(cls, part: Any, write: Callable[[Any, str], Any] | None = None, *, name: str = "",
                 import_options: ImportOptions | None = None) -> Model:
        """A part of a CAD program in Python, by way of a STEP file in a temporary folder.

        write: writes the part: write(part, path). That is `export_step` of build123d, `exporters.export` of
            CadQuery, and `write_step_file` of pythonocc. Default: the part has exportStep(path), as the
            shapes of CadQuery have.
        """
        if write is None and not isinstance(part, ExportsStep):
            raise OptionError("part", f"is a {type(part).__name__} without exportStep(path); give `write`, a function write(part, path) "
                              "that writes it as STEP")
        with tempfile.TemporaryDirectory(prefix="patchmill-") as folder:
            path = pathlib.Path(folder) / "part.step"
            part.exportStep(str(path)) if write is None else write(part, str(path))
            if not path.is_file():
                raise OptionError("part", f"was not written as STEP: {write or 'exportStep'} made no file")
            return cls.from_bytes(path.read_bytes(), "step", name=name or type(part).__name__, import_options=import_options)

    @classmethod
    def from_digest(cls, sha256: bytes, inline: ModelLike) -> Model:
        """A model that the server may hold, as `Client.upload` makes it: only its digest is sent. Where the
        server has forgotten the model it is uploaded again."""
        whole = model_of(inline)
        return cls(ModelSource(model_sha256=sha256), whole.name, whole)

    def message(self) -> model_pb2.ModelSource:
        """The model as a message of protobuf."""
        message: model_pb2.ModelSource = to_message(self.source, model_pb2.ModelSource(), "source")
        return message


ModelLike = Union[Model, PatchModel, CurveNetwork, ExportsStep, str, "os.PathLike[str]"]


def model_of(model: ModelLike) -> Model:
    """The model that a call was given."""
    if isinstance(model, Model):
        return model
    if isinstance(model, PatchModel):
        return Model.from_message(model)
    if isinstance(model, CurveNetwork):
        return Model.from_network(model)
    if isinstance(model, (str, os.PathLike)):
        return Model.from_file(model)
    if isinstance(model, ExportsStep):
        return Model.from_cad(model)
    raise OptionError("model", f"is of the type {type(model).__name__}; it must be the path of a file, a patchmill.Model, PatchModel or "
                      "CurveNetwork, or a part with exportStep(path). Model.from_patches takes arrays, Model.from_cad other parts.")


def name_on_wire(name: str, most_bytes: int = 100) -> str:
    """The name, cut to as many bytes as the contract allows."""
    return name.encode("utf-8", "replace")[:most_bytes].decode("utf-8", "ignore")


def _nets_of(nets: ArrayLike | Sequence[ArrayLike]) -> list[Any]:
    if isinstance(nets, np.ndarray):
        return [nets] if nets.ndim == 3 else list(nets)
    return list(nets)  # type: ignore[arg-type]


def _bezier(net: Any, path: str) -> BezierPatch:
    try:
        points = np.asarray(net, dtype=np.float64)
    except ValueError as error:
        raise OptionError(path, f"must be an array of numbers: {error}") from None
    if points.ndim != 3 or points.shape[2] != 3 or min(points.shape[:2]) < 2:
        raise OptionError(path, f"has the shape {points.shape}; it must be (along u, along v, 3) with two points each way or more")
    return BezierPatch(degree_u=points.shape[0] - 1, degree_v=points.shape[1] - 1, points=points)


def _set_weights(patch: BezierPatch, weights: Any, path: str) -> None:
    array = np.asarray(weights, dtype=np.float64)
    wanted = (patch.degree_u + 1, patch.degree_v + 1)
    if array.shape != wanted:
        raise OptionError(path, f"has the shape {array.shape}; it must be {wanted}, one weight for each point")
    patch.weights = array.ravel()


def set_source(request: Any, model: Model) -> Any:
    """Puts the model into a request that has a source."""
    request.source.CopyFrom(model.message())
    return request


def set_name(message: Any, model: Model, name: str | None) -> None:
    set_fields(message, name=name_on_wire(model.name if name is None else name))

"""The calls that keep a model on the server: upload, forget."""
from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ._call import RPCS, Call, Canceller, One
from ._message import from_message
from .errors import OptionError
from .messages import Diagnostic, ForgetModelResponse, Severity, UploadModelResponse
from .models import Model, ModelLike, model_of
from .v1 import model_service_pb2

CHUNK_BYTES = 1 << 20


@dataclass(frozen=True)
class UploadResult:
    """A model that the server keeps.

    model: the model by its digest, for all other calls; None if it cannot be used. It is uploaded again where
        the server has forgotten it.
    sha256: digest of the model, 32 bytes; empty if it cannot be used.
    patch_count: number of its patches.
    findings: what was found while it was read.
    """

    model: Model | None
    sha256: bytes
    patch_count: int
    findings: Sequence[Diagnostic]

    @property
    def is_usable(self) -> bool:
        """No finding is an error."""
        return self.model is not None

    def __str__(self) -> str:
        errors = [f.message for f in self.findings if f.severity == Severity.ERROR]
        if self.model is None:
            return "\n  ".join([f"The model cannot be used; {len(errors)} errors:", *errors[:10]])
        return f"{self.model.name or 'model'}: {self.patch_count} patches, kept as {self.sha256.hex()[:12]}..."


class UploadRequest:
    """The messages of an upload. They are made while they are sent, so that a large file is there once."""

    def __init__(self, model: Model) -> None:
        source = model.message()
        if source.WhichOneof("source") == "model":
            self._content, self._start = source.model.SerializeToString(), model_service_pb2.UploadStart(format="pb")
        elif source.WhichOneof("source") == "file":
            self._content = source.file.content
            self._start = model_service_pb2.UploadStart(format=source.file.format, length_unit=source.file.length_unit)
            if source.file.HasField("import_options"):
                self._start.import_options.CopyFrom(source.file.import_options)
        else:
            raise OptionError("model", "names a model by its digest only; it must be a whole model")
        self._start.size_bytes = len(self._content)
        self._start.content_sha256 = hashlib.sha256(self._content).digest()

    def __iter__(self) -> Iterator[model_service_pb2.UploadModelRequest]:
        yield model_service_pb2.UploadModelRequest(start=self._start)
        for at in range(0, len(self._content), CHUNK_BYTES):
            yield model_service_pb2.UploadModelRequest(chunk=self._content[at:at + CHUNK_BYTES])


def upload(model: ModelLike, *, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[UploadResult]:
    """Sends a model once, in pieces, up to 256 MiB. `result.model` then stands for it in all other calls.

        part = client.upload("die.step").model
        client.mill(part, operation)
    """
    whole = model_of(model)
    whole = whole.inline or whole

    def result(answer: model_service_pb2.UploadModelResponse) -> UploadResult:
        read = from_message(UploadModelResponse, answer)
        kept = Model.from_digest(read.model_sha256, whole) if read.model_sha256 else None
        return UploadResult(kept, read.model_sha256, read.patch_count, read.diagnostics)

    return Call(RPCS["UploadModel"], UploadRequest(whole), lambda: One(result), cancel=cancel, timeout_s=timeout_s)


def forget(model: Model | bytes, *, cancel: Canceller | None = None, timeout_s: float | None = None) -> Call[bool]:
    """Removes an uploaded model, and the answers made from it, from the server. False: it was not there.

    model: the model by its digest, as `upload` gives it, or the digest itself.
    """
    digest = model if isinstance(model, bytes) else bytes(model.message().model_sha256)
    if not digest:
        raise OptionError("model", "is a whole model; it must be one by its digest, as `upload` gives it")
    request = model_service_pb2.ForgetModelRequest(model_sha256=digest)
    return Call(RPCS["ForgetModel"], request, lambda: One(lambda answer: from_message(ForgetModelResponse, answer).was_there),
                cancel=cancel, timeout_s=timeout_s)

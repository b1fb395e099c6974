"""A call before it is made: which method, with which request, and what its answer becomes. Client and
AsyncClient differ in how they wait only; both run these."""
from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Generic, Iterator, Protocol, TypeVar

from ._message import from_message
from .messages import Progress
from .v1 import analysis_service_pb2, model_service_pb2, server_service_pb2, toolpath_service_pb2

T = TypeVar("T")
R = TypeVar("R", covariant=True)


class Canceller:
    """Cancels the calls that it is given to: call it, from a progress callback or from another thread."""

    def __init__(self) -> None:
        self._event = threading.Event()
        self._lock = threading.Lock()
        self._listeners: list[Callable[[], Any]] = []

    def __call__(self) -> None:
        with self._lock:
            self._event.set()
            listeners = list(self._listeners)
        for listener in listeners:
            listener()

    @property
    def is_cancelled(self) -> bool:
        """Whether the calls have been cancelled. A cancelled Canceller stays so."""
        return self._event.is_set()

    def wait(self, seconds: float) -> bool:
        """Waits. True if it was cancelled meanwhile."""
        return self._event.wait(seconds)

    @contextmanager
    def attached(self, listener: Callable[[], Any]) -> Iterator[None]:
        """Calls `listener` once this is cancelled, at once if it already is."""
        with self._lock:
            self._listeners.append(listener)
            is_late = self._event.is_set()
        if is_late:
            listener()
        try:
            yield
        finally:
            with self._lock:
                self._listeners.remove(listener)


@dataclass(frozen=True)
class Method:
    """A method of the contract."""

    path: str
    request: Any
    response: Any
    is_stream: bool  # the server answers with a stream
    is_upload: bool  # the client sends one: the request is iterable


def _method(service_file: Any, service: str, name: str) -> Method:
    method = service_file.DESCRIPTOR.services_by_name[service].methods_by_name[name]
    stated = next(m for m in _proto_of(service_file, service).method if m.name == name)
    return Method(f"/{method.containing_service.full_name}/{name}", method.input_type._concrete_class,
                  method.output_type._concrete_class, bool(stated.server_streaming), bool(stated.client_streaming))


def _proto_of(service_file: Any, service: str) -> Any:
    from google.protobuf import descriptor_pb2

    proto = descriptor_pb2.ServiceDescriptorProto()
    service_file.DESCRIPTOR.services_by_name[service].CopyToProto(proto)
    return proto


SERVICES = {"ToolpathService": toolpath_service_pb2, "AnalysisService": analysis_service_pb2, "ModelService": model_service_pb2,
            "ServerService": server_service_pb2}
RPCS: dict[str, Method] = {
    name: _method(file, service, name)
    for service, file in SERVICES.items() for name in file.DESCRIPTOR.services_by_name[service].methods_by_name
}


class Collector(Protocol[R]):
    """Takes the events of an answer, then says what they are together."""

    def take(self, event: Any) -> None: ...

    def finish(self) -> R: ...


class One(Generic[T]):
    """Collects an answer of one message."""

    def __init__(self, make: Callable[[Any], T]) -> None:
        self._make = make
        self._answer: Any = None

    def take(self, event: Any) -> None:
        self._answer = event

    def finish(self) -> T:
        return self._make(self._answer)


ProgressCallback = Callable[[Progress], object]


def progress_of(event: Any) -> Progress | None:
    """The progress that an event of a stream carries."""
    if "progress" not in event.DESCRIPTOR.fields_by_name or not event.HasField("progress"):
        return None
    return from_message(Progress, event.progress)


@dataclass(frozen=True)
class Inline:
    """What a client does where the server does not hold the model of a request.

    upload: makes the call that sends the model again.
    request: makes the request with the whole model in it.
    """

    upload: Callable[[], Call[Any]]
    request: Callable[[], Any]


@dataclass(frozen=True)
class Call(Generic[T]):
    """A call.

    inline: the whole model, where `request` names the model by its digest only.
    """

    method: Method
    request: Any
    collector: Callable[[], Collector[T]]
    inline: Inline | None = None
    progress: ProgressCallback | None = None
    cancel: Canceller | None = None
    timeout_s: float | None = None

"""Makes a call over a channel of gRPC and waits for its answer."""
from __future__ import annotations

import asyncio
import contextlib
import time
from typing import Any, TypeVar

import grpc

from ._call import Call, progress_of
from ._status import ended_by_server, error_of
from .errors import CallError, DeadlineError, JobCancelledError

T = TypeVar("T")
Metadata = list[tuple[str, str]]
_WAY_S = 0.1


def run_once(channel: Any, call: Call[T], request: Any, metadata: Metadata, timeout_s: float | None, where: str) -> T:
    """Makes a call once. Whatever ends the wait (an error of the progress callback, Ctrl-C) ends the call,
    too."""
    method, collector = call.method, call.collector()
    codec = {"request_serializer": method.request.SerializeToString, "response_deserializer": method.response.FromString}
    options = {"timeout": timeout_s, "metadata": metadata}
    end = _end_of(timeout_s)
    has_begun = False
    with contextlib.ExitStack() as stack:
        try:
            if method.is_upload:
                rpc = channel.stream_unary(method.path, **codec).future(iter(request), **options)
            elif method.is_stream:
                rpc = channel.unary_stream(method.path, **codec)(request, **options)
            else:
                rpc = channel.unary_unary(method.path, **codec).future(request, **options)
            stack.callback(rpc.cancel)
            if call.cancel is not None:
                stack.enter_context(call.cancel.attached(rpc.cancel))
            if not method.is_stream:
                collector.take(rpc.result())
            else:
                for event in rpc:
                    has_begun = True
                    _take(call, collector, event)
        except grpc.FutureCancelledError:
            raise error_of(rpc, where) from None
        except grpc.RpcError as error:
            raise _error_of(call, error, where, has_begun, end) from None
    return collector.finish()


def _is_cancelled(call: Call[T]) -> bool:
    return call.cancel is not None and call.cancel.is_cancelled


def _end_of(timeout_s: float | None) -> float | None:
    return None if timeout_s is None else time.monotonic() + timeout_s


def _error_of(call: Call[T], error: Any, where: str, has_begun: bool, end: float | None) -> CallError:
    if error.code() == grpc.StatusCode.CANCELLED and not _is_cancelled(call):
        # The server knows the deadline, too, and its clock may be ahead by the time that the call took to it.
        if end is not None and time.monotonic() > end - _WAY_S:
            return DeadlineError("The call was not done within its time (timeout_s).", "DEADLINE_EXCEEDED")
        return ended_by_server(where, has_begun)
    return error_of(error, where)


def _take(call: Call[T], collector: Any, event: Any) -> None:
    collector.take(event)
    if call.progress is not None and (progress := progress_of(event)) is not None:
        call.progress(progress)


async def run_once_async(channel: Any, call: Call[T], request: Any, metadata: Metadata, timeout_s: float | None, where: str) -> T:
    """The same for a channel of grpc.aio. Cancelling the task ends the call."""
    method, collector = call.method, call.collector()
    codec = {"request_serializer": method.request.SerializeToString, "response_deserializer": method.response.FromString}
    options = {"timeout": timeout_s, "metadata": tuple(metadata)}
    end = _end_of(timeout_s)
    loop = asyncio.get_running_loop()
    has_begun = False
    with contextlib.ExitStack() as stack:
        try:
            if method.is_upload:
                rpc = channel.stream_unary(method.path, **codec)(iter(request), **options)
            else:
                rpc = (channel.unary_stream if method.is_stream else channel.unary_unary)(method.path, **codec)(request, **options)
            stack.callback(rpc.cancel)
            if call.cancel is not None:
                stack.enter_context(call.cancel.attached(lambda: loop.call_soon_threadsafe(rpc.cancel)))
            if not method.is_stream:
                collector.take(await rpc)
            else:
                async for event in rpc:
                    has_begun = True
                    _take(call, collector, event)
        except asyncio.CancelledError:
            # gRPC raises this for a call that was cancelled, too; a cancelled task goes on being cancelled.
            if not _is_cancelled(call):
                raise
            raise JobCancelledError("The call was cancelled.", "CANCELLED", "CANCELLED") from None
        except grpc.RpcError as error:
            raise _error_of(call, error, where, has_begun, end) from None
    # Large arrays take a moment; the loop goes on meanwhile.
    return await asyncio.to_thread(collector.finish)

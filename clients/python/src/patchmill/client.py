"""Clients of a server: one that waits, and one for asyncio."""
from __future__ import annotations

import asyncio
import functools
import inspect
import secrets
import threading
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Any, Concatenate, ParamSpec, TypeVar

import grpc
import grpc.aio

from . import analysis, asking, milling, modelling, uploading
from ._call import Call
from ._connection import CHANNEL_OPTIONS, Tls, Token, check_address, check_token, credentials, metadata
from ._run import run_once, run_once_async
from ._server import LazyServer, Program
from .errors import JobCancelledError, ModelNotCachedError, PatchmillError, ServerLostError, ServerUnreachableError, TemporaryError
from .retry import Deadline, Retry, Tries

P = ParamSpec("P")
T = TypeVar("T")


def _with_self(method: Callable[..., Any], made: Callable[..., Any], returns: str) -> None:
    """Gives a method the documentation and the arguments of the function that makes its call."""
    functools.update_wrapper(method, made)
    del method.__wrapped__  # type: ignore[attr-defined]
    signature = inspect.signature(made)
    own = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    method.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[own, *signature.parameters.values()], return_annotation=returns.removeprefix("Call[").removesuffix("]"))


def _method(make: Callable[P, Call[T]]) -> Callable[Concatenate[Client, P], T]:
    def method(self: Client, /, *args: P.args, **kwargs: P.kwargs) -> T:
        return self.run(make(*args, **kwargs))

    _with_self(method, make, make.__annotations__["return"])
    return method


def _async_method(make: Callable[P, Call[T]]) -> Callable[Concatenate[AsyncClient, P], Awaitable[T]]:
    async def method(self: AsyncClient, /, *args: P.args, **kwargs: P.kwargs) -> T:
        return await self.run(make(*args, **kwargs))

    _with_self(method, make, make.__annotations__["return"])
    return method


class _Target:
    """Where calls go, and with what."""

    def __init__(self, address: str | None, tls: Tls | None, token: Token | None, retry: Retry | None, program: Program | None,
                 threads: int) -> None:
        if address is not None:
            check_address(address)
            check_token(token, address, tls)
        self._address, self._tls, self._token = address, tls, token
        self.retry = Retry() if retry is None else retry
        self._own = LazyServer(program, threads) if address is None else None

    @property
    def where(self) -> str:
        return self._address or "the server that this client started"

    def connect(self, secure: Callable[..., Any], insecure: Callable[..., Any]) -> Any:
        if self._own is not None:
            return insecure(self._own.address(), options=CHANNEL_OPTIONS)
        if self._tls is not None:
            return secure(self._address, credentials(self._tls), options=CHANNEL_OPTIONS)
        return insecure(self._address, options=CHANNEL_OPTIONS)

    def metadata(self, request_id: str) -> list[tuple[str, str]]:
        return [*metadata(self._token), ("x-request-id", request_id)]

    def explained(self, error: PatchmillError) -> PatchmillError:
        """The error, or what has become of a server of one's own."""
        if self._own is None or self._own.running is None or not isinstance(error, (ServerLostError, ServerUnreachableError)):
            return error
        ended = self._own.running.ended()
        if not ended:
            return error
        log = self._own.running.log().strip().splitlines()[-3:]
        lost = ServerLostError("\n  ".join([f"{ended}. The next call starts it anew. Its last words:", *log]), error.code)
        lost.may_retry = False  # the call may be why it ended
        return lost

    def forget_ended(self) -> bool:
        """Whether a server of one's own had ended; the next call starts another one."""
        if self._own is None or self._own.running is None or not self._own.running.ended():
            return False
        self._own.close()
        return True

    def close(self) -> None:
        if self._own is not None:
            self._own.close()


class Client:
    """A client of a server.

        with Client() as client: ...                    # a server of its own, which ends with the client
        with Client("127.0.0.1:50051") as client: ...   # one that runs
        with Client("cam.lan:50051", tls=Tls(ca="ca.pem")) as client: ...

    address: HOST:PORT, or unix:PATH. None: the client starts patchmilld at its first call, on a socket that
        only this user reaches.
    tls: the connection is encrypted. None: it is not.
    token: sent as `authorization: Bearer TOKEN` with every call, or a function that returns it. Never sent
        unencrypted beyond this machine.
    retry: how often a call is tried while the server is busy, drains, cannot be reached or is lost.
    program, threads: of the server that the client starts: patchmilld (None: the environment variable
        PATCHMILLD, or the one on the path), and threads of one job (0: all).

    A client may be used from several threads at once.
    """

    def __init__(self, address: str | None = None, *, tls: Tls | None = None, token: Token | None = None, retry: Retry | None = None,
                 program: Program | None = None, threads: int = 0) -> None:
        self._target = _Target(address, tls, token, retry, program, threads)
        self._channel: Any = None
        self._lock = threading.Lock()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Ends running calls and the connection, and the server if the client has started it."""
        self._disconnect()
        self._target.close()

    def _disconnect(self) -> None:
        with self._lock:
            if self._channel is not None:
                self._channel.close()
            self._channel = None

    def _connected(self) -> Any:
        with self._lock:
            if self._channel is None:
                self._channel = self._target.connect(grpc.secure_channel, grpc.insecure_channel)
            return self._channel

    def run(self, call: Call[T]) -> T:
        """Makes a call, and makes it again where its error is temporary."""
        deadline, request, tries = Deadline(call.timeout_s), call.request, Tries(self._target.retry)
        request_id, uploaded = secrets.token_hex(8), False
        while True:
            try:
                return run_once(self._connected(), call, request, self._target.metadata(request_id), deadline.left_s(), self._target.where)
            except ModelNotCachedError:
                if call.inline is None or request is not call.request:
                    raise
                if not uploaded:
                    uploaded = True
                    self.run(call.inline.upload())
                else:
                    request = call.inline.request()
            except (TemporaryError, ServerLostError) as error:
                explained = self._target.explained(error)
                if self._target.forget_ended():
                    self._disconnect()
                wait_s = tries.wait_after(explained)
                if wait_s is None or not deadline.allows(wait_s):
                    raise tries.raised(explained) from None
                uploaded = False  # another server may answer
                if (call.cancel.wait(wait_s) if call.cancel is not None else _sleep(wait_s)):
                    raise JobCancelledError("The call was cancelled.", "CANCELLED", "CANCELLED") from None

    mill = _method(milling.mill)
    resolve = _method(milling.resolve)
    verify = _method(milling.verify)
    posts = _method(milling.posts)
    capabilities = _method(asking.capabilities)
    check_post = _method(milling.check_post)
    regions = _method(analysis.regions)
    reach = _method(analysis.reach)
    lines = _method(analysis.lines)
    evaluate = _method(analysis.evaluate)
    preview = _method(analysis.preview)
    check = _method(modelling.check)
    convert = _method(modelling.convert)
    build = _method(modelling.build)
    edit = _method(modelling.edit)
    fair = _method(modelling.fair)
    fair_net = _method(modelling.fair_net)
    upload = _method(uploading.upload)
    forget = _method(uploading.forget)


def _sleep(seconds: float) -> bool:
    threading.Event().wait(seconds)
    return False


class AsyncClient:
    """The same for asyncio: every method of Client, to be awaited. Cancelling a task cancels its call.

        async with AsyncClient() as client:
            one, two = await asyncio.gather(client.mill("one.step", operation), client.mill("two.step",
            operation))

    Use it within one event loop. The arguments are those of Client. A process should have clients of one
    kind: where gRPC serves both, it takes seconds to notice that a server has come or gone.
    """

    def __init__(self, address: str | None = None, *, tls: Tls | None = None, token: Token | None = None, retry: Retry | None = None,
                 program: Program | None = None, threads: int = 0) -> None:
        self._target = _Target(address, tls, token, retry, program, threads)
        self._channel: Any = None
        self._lock: Any = None

    async def __aenter__(self) -> AsyncClient:
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await self.close()

    async def close(self) -> None:
        """Ends running calls and the connection, and the server if the client has started it."""
        await self._disconnect()
        await asyncio.to_thread(self._target.close)

    async def _disconnect(self) -> None:
        channel, self._channel = self._channel, None
        if channel is not None:
            await channel.close()

    async def _connected(self) -> Any:
        if self._lock is None:
            self._lock = asyncio.Lock()
        async with self._lock:
            if self._channel is None:
                # Starting a server takes a moment; the loop goes on meanwhile.
                made = await asyncio.to_thread(self._target.connect, lambda *a, **k: (grpc.aio.secure_channel, a, k),
                                               lambda *a, **k: (grpc.aio.insecure_channel, a, k))
                make, args, options = made
                self._channel = make(*args, **options)
            return self._channel

    async def run(self, call: Call[T]) -> T:
        """Makes a call, and makes it again where its error is temporary."""
        deadline, request, tries = Deadline(call.timeout_s), call.request, Tries(self._target.retry)
        request_id, uploaded = secrets.token_hex(8), False
        while True:
            try:
                channel = await self._connected()
                sent = self._target.metadata(request_id)
                return await run_once_async(channel, call, request, sent, deadline.left_s(), self._target.where)
            except ModelNotCachedError:
                if call.inline is None or request is not call.request:
                    raise
                if not uploaded:
                    uploaded = True
                    await self.run(call.inline.upload())
                else:
                    request = call.inline.request()
            except (TemporaryError, ServerLostError) as error:
                explained = await asyncio.to_thread(self._target.explained, error)
                if await asyncio.to_thread(self._target.forget_ended):
                    await self._disconnect()
                wait_s = tries.wait_after(explained)
                if wait_s is None or not deadline.allows(wait_s):
                    raise tries.raised(explained) from None
                uploaded = False  # another server may answer
                if call.cancel is None:
                    await asyncio.sleep(wait_s)
                elif await asyncio.to_thread(call.cancel.wait, wait_s):
                    raise JobCancelledError("The call was cancelled.", "CANCELLED", "CANCELLED") from None

    mill = _async_method(milling.mill)
    resolve = _async_method(milling.resolve)
    verify = _async_method(milling.verify)
    posts = _async_method(milling.posts)
    capabilities = _async_method(asking.capabilities)
    check_post = _async_method(milling.check_post)
    regions = _async_method(analysis.regions)
    reach = _async_method(analysis.reach)
    lines = _async_method(analysis.lines)
    evaluate = _async_method(analysis.evaluate)
    preview = _async_method(analysis.preview)
    check = _async_method(modelling.check)
    convert = _async_method(modelling.convert)
    build = _async_method(modelling.build)
    edit = _async_method(modelling.edit)
    fair = _async_method(modelling.fair)
    fair_net = _async_method(modelling.fair_net)
    upload = _async_method(uploading.upload)
    forget = _async_method(uploading.forget)

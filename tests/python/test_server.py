"""Servers that are busy, drain, are lost or cannot be reached; TLS and tokens; a server of one's own."""
import os
import pathlib
import signal
import stat
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from concurrent import futures

import grpc
import patchmill as pm
from patchmill import _status
from patchmill.v1 import status_pb2
from support import BIN, DOME, HILLS, NO_RETRY, Daemon, daemon, free_port, long_operation, operation

MODEL = pm.Model.from_patches(DOME)


class Status:
    """The status of a call, as gRPC gives it."""

    def __init__(self, code, details, trailers=()):
        self.code, self.details, self.trailing_metadata = (lambda: code), (lambda: details), (lambda: trailers)


class InBackground:
    """A call on a thread of its own, begun once it reports progress."""

    def __init__(self, client: pm.Client) -> None:
        self.error: BaseException | None = None
        self.cancel = pm.Canceller()
        self._began = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(client,))
        self._thread.start()
        assert self._began.wait(60)

    def _run(self, client: pm.Client) -> None:
        try:
            client.mill(HILLS, long_operation(), progress=lambda p: self._began.set(), cancel=self.cancel)
        except pm.PatchmillError as error:
            self.error = error
        finally:
            self._began.set()

    def ended_by(self) -> BaseException | None:
        self._thread.join(30)
        return self.error


UNAVAILABLE = (grpc.StatusCode.UNAVAILABLE, "Socket closed", "")
RESET = (grpc.StatusCode.INTERNAL, "Received RST_STREAM with error code 2", "")
DRAINING = (grpc.StatusCode.UNAVAILABLE, "the server is shutting down", "DRAINING")


class Troubled:
    """A server that ends its first calls so, and answers every later one with an empty message."""

    def __init__(self, troubles):
        self.names, self._troubles = [], troubles
        self._server = grpc.server(futures.ThreadPoolExecutor(1), handlers=[self])
        self.address = f"127.0.0.1:{self._server.add_insecure_port('127.0.0.1:0')}"
        self._server.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._server.stop(None).wait()

    def service(self, call):
        self.names.append(dict(call.invocation_metadata).get("x-request-id"))
        return grpc.unary_unary_rpc_method_handler(self.answer)

    def answer(self, _, context):
        if len(self.names) <= len(self._troubles):
            code, text, reason = self._troubles[len(self.names) - 1]
            if reason:
                status = status_pb2.Status()
                status.details.add().Pack(status_pb2.ErrorInfo(reason=reason))
                context.set_trailing_metadata([("grpc-status-details-bin", status.SerializeToString())])
            context.abort(code, text)
        return b""


class Trouble(unittest.TestCase):
    def test_a_server_that_is_killed_in_a_job_is_lost(self):
        with daemon() as server, pm.Client(server.address) as client:
            job = InBackground(client)
            server.signal(signal.SIGKILL)
            self.assertIsInstance(job.ended_by(), pm.ServerLostError)
            self.assertIn("broke while the call ran", str(job.error))

    def test_a_lost_call_is_made_again_under_the_same_name(self):
        lost = pm.ServerLostError
        for troubles, ends, calls in [([UNAVAILABLE], None, 2), ([RESET, UNAVAILABLE], None, 3), ([UNAVAILABLE] * 9, lost, 3)]:
            with Troubled(troubles) as server, pm.Client(server.address, retry=pm.Retry(first_wait_s=0.01)) as client:
                if ends is None:
                    client.posts()
                else:
                    with self.assertRaisesRegex(ends, "broke while the call ran"):
                        client.posts()
            self.assertEqual(len(server.names), calls)
            self.assertEqual(len(set(server.names)), 1)
            self.assertTrue(server.names[0])

    def test_a_server_that_drains_is_asked_until_another_one_answers(self):
        with Troubled([DRAINING] * 9) as server, pm.Client(server.address, retry=pm.Retry(first_wait_s=0.01)) as client:
            client.posts()
        self.assertEqual(len(server.names), 10)
        retry = pm.Retry(first_wait_s=0.01, draining_s=0.0)
        with Troubled([DRAINING] * 9) as server, pm.Client(server.address, retry=retry) as client:
            with self.assertRaises(pm.ServerDrainingError):
                client.posts()
        self.assertEqual(len(server.names), 4)

    def test_a_busy_server_is_tried_again(self):
        with daemon("--max-jobs", "1", "--max-queue", "0") as server, pm.Client(server.address, retry=NO_RETRY) as client:
            job = InBackground(client)
            with self.assertRaises(pm.ServerBusyError) as caught:
                client.regions(MODEL, operation())
            self.assertEqual((caught.exception.reason, caught.exception.limit), ("TOO_MANY_JOBS", "waiting_jobs"))
            self.assertTrue(client.check(MODEL).is_usable)  # calls of milliseconds have places of their own
            with pm.Client(server.address, retry=pm.Retry(attempts=20, first_wait_s=0.1, longest_wait_s=0.3)) as patient:
                threading.Timer(0.5, job.cancel).start()
                self.assertTrue(patient.regions(MODEL, operation()).regions)
            self.assertIsInstance(job.ended_by(), pm.JobCancelledError)

    def test_waiting_ends_with_the_deadline_and_with_a_cancel(self):
        with daemon("--max-jobs", "1", "--max-queue", "0") as server, pm.Client(server.address) as client:
            job = InBackground(client)
            retry = pm.Retry(attempts=1000, first_wait_s=60.0, longest_wait_s=60.0)
            with pm.Client(server.address, retry=retry) as patient:
                with self.assertRaises(pm.ServerBusyError):
                    patient.regions(MODEL, operation(), timeout_s=30.0)  # no time for the wait and another try
                cancel = pm.Canceller()
                threading.Timer(0.3, cancel).start()
                with self.assertRaises(pm.JobCancelledError):
                    patient.regions(MODEL, operation(), cancel=cancel)
            job.cancel()
            job.ended_by()

    def test_a_server_that_drains_takes_no_new_call_and_ends_its_job(self):
        with daemon() as server, pm.Client(server.address, retry=NO_RETRY) as client:
            job = InBackground(client)
            server.signal(signal.SIGTERM)
            # At first the server says DRAINING; soon it no longer listens.
            with self.assertRaises((pm.ServerDrainingError, pm.ServerUnreachableError)):
                for _ in range(200):
                    client.check(MODEL)
                    time.sleep(0.02)
            self.assertIsNone(job.error)
            job.cancel()
            self.assertIsInstance(job.ended_by(), pm.JobCancelledError)

    def test_nobody_at_the_address(self):
        with pm.Client(f"127.0.0.1:{free_port()}", retry=NO_RETRY) as client:
            with self.assertRaisesRegex(pm.ServerUnreachableError, r"No server answers at 127\.0\.0\.1:\d+"):
                client.posts()

    def test_what_is_no_address(self):
        for address in ("localhost", "localhost:", "localhost:http", ":50051", "127.0.0.1:65536", ""):
            with self.assertRaisesRegex(pm.OptionError, f"address = '{address}'; it must be HOST:PORT"):
                pm.Client(address)

    def test_a_server_that_comes_later_is_found(self):
        port, started = free_port(), []
        later = threading.Timer(0.5, lambda: started.append(Daemon(listen=f"127.0.0.1:{port}")))
        later.start()
        with pm.Client(f"127.0.0.1:{port}", retry=pm.Retry(attempts=30, first_wait_s=0.2, longest_wait_s=0.5)) as client:
            self.assertTrue(client.check(MODEL).is_usable)
        later.join()
        started[0].close()

    def test_a_stream_without_its_report_is_void(self):
        from patchmill import milling

        collector = milling._MillCollector("part")
        with self.assertRaisesRegex(pm.IncompleteAnswerError, "without a report"):
            collector.finish()
        answer = milling.toolpath_service_pb2.GenerateProgramResponse
        for event in (answer(program={"data": b"G21\n"}), answer(report={"program_size_bytes": 4, "program_sha256": bytes(32)})):
            collector.take(event)
        with self.assertRaisesRegex(pm.IncompleteAnswerError, "did not arrive whole"):
            collector.finish()

    def test_reasons_of_the_contract_have_their_class(self):
        kinds = {"DRAINING": pm.ServerDrainingError, "TOO_MANY_BYTES": pm.ServerBusyError, "MODEL_INVALID": pm.ModelError,
                 "CURVE_UNREADABLE": pm.UnreadableError, "INTERNAL": pm.InternalServerError, "NEWER": pm.InvalidRequestError}
        for reason, kind in kinds.items():
            status = status_pb2.Status()
            status.details.add().Pack(status_pb2.ErrorInfo(reason=reason))
            trailers = [("other", "x"), ("grpc-status-details-bin", status.SerializeToString())]
            error = _status.error_of(Status(grpc.StatusCode.INVALID_ARGUMENT, "why", trailers), "there")
            self.assertIs(type(error), kind)
            self.assertEqual((error.reason, str(error)), (reason, "why"))

    def test_a_call_that_the_server_ends_is_not_cancelled_by_us(self):
        self.assertIsInstance(_status.ended_by_server("there", has_begun=False), pm.TemporaryError)
        self.assertIsInstance(_status.ended_by_server("there", has_begun=True), pm.ServerLostError)

    def test_an_answer_of_grpc_itself_has_its_class(self):
        for code, details, kind in ((grpc.StatusCode.RESOURCE_EXHAUSTED, "larger than max", pm.LimitError),
                                    (grpc.StatusCode.UNAVAILABLE, "failed to connect to all addresses", pm.ServerUnreachableError),
                                    (grpc.StatusCode.UNAVAILABLE, "Socket closed", pm.ServerLostError),
                                    (grpc.StatusCode.UNAVAILABLE, "Cancelling all calls", pm.ServerLostError),
                                    (grpc.StatusCode.CANCELLED, "Cancelled", pm.JobCancelledError),
                                    (grpc.StatusCode.UNKNOWN, "what", pm.CallError)):
            self.assertIs(type(_status.error_of(Status(code, details), "there")), kind)
        shut_down = _status.error_of(Status(grpc.StatusCode.UNAVAILABLE, "Cancelling all calls"), "there")
        self.assertEqual(str(shut_down), "The server at there shut down before the call was done.")


class OwnServer(unittest.TestCase):
    def test_it_is_private_and_ends_with_the_client(self):
        client = pm.Client(threads=1)
        client.check(MODEL)
        own = client._target._own.running
        folder = pathlib.Path(own.folder)
        self.assertEqual(stat.S_IMODE(folder.stat().st_mode), 0o700)
        client.close()
        self.assertEqual(own.process.poll(), 0)
        self.assertFalse(folder.exists())
        client.close()

    def test_it_ends_with_a_process_that_is_killed(self):
        program = "import patchmill as pm, time\nclient = pm.Client()\nclient.posts()\n" \
                  "print(client._target._own.running.process.pid, flush=True)\ntime.sleep(60)"
        with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as parent:
            own = int(parent.stdout.readline())
            parent.kill()
        end = time.monotonic() + 15
        while pathlib.Path(f"/proc/{own}").exists() and "Z" not in pathlib.Path(f"/proc/{own}/stat").read_text().split(")")[-1]:
            self.assertLess(time.monotonic(), end, "the server outlives its client")
            time.sleep(0.05)

    def test_one_that_is_killed_is_named_and_started_anew(self):
        with pm.Client() as client:
            job = InBackground(client)
            os.kill(client._target._own.running.process.pid, signal.SIGKILL)
            self.assertIsInstance(job.ended_by(), pm.ServerLostError)
            self.assertIn("The server that this client started has ended by signal 9", str(job.error))
            self.assertTrue(client.check(MODEL).is_usable)

    def test_a_program_that_is_not_there(self):
        with pm.Client(program="/nowhere/patchmilld") as client:
            with self.assertRaisesRegex(pm.StartError, "/nowhere/patchmilld.*PATCHMILLD"):
                client.posts()

    def test_a_program_that_does_not_start(self):
        with pm.Client(program="/bin/false") as client:
            with self.assertRaisesRegex(pm.StartError, "ended with status 1"):
                client.posts()


class Secured(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        for name in ("server", "client"):
            subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
                            "-subj", f"/CN={name}", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout",
                            cls.folder / f"{name}.key", "-out", cls.folder / f"{name}.pem"], check=True, capture_output=True)

    def file(self, name: str) -> str:
        return str(self.folder / name)

    def test_tls(self):
        with daemon("--cert", self.file("server.pem"), "--key", self.file("server.key")) as server:
            for ca in (self.file("server.pem"), (self.folder / "server.pem").read_bytes()):
                with pm.Client(server.address, tls=pm.Tls(ca=ca), token="secret") as client:
                    self.assertTrue(client.check(MODEL).is_usable)
            for tls in (None, pm.Tls(), pm.Tls(ca=self.file("client.pem"))):
                with pm.Client(server.address, tls=tls, retry=NO_RETRY) as client:
                    with self.assertRaises((pm.ServerUnreachableError, pm.ServerLostError)):
                        client.check(MODEL, timeout_s=10)

    def test_certificates_of_clients(self):
        with daemon("--cert", self.file("server.pem"), "--key", self.file("server.key"), "--ca", self.file("client.pem")) as server:
            known = pm.Tls(ca=self.file("server.pem"), cert=self.file("client.pem"), key=self.file("client.key"))
            with pm.Client(server.address, tls=known) as client:
                self.assertTrue(client.check(MODEL).is_usable)
            with pm.Client(server.address, tls=pm.Tls(ca=self.file("server.pem")), retry=NO_RETRY) as client:
                with self.assertRaises((pm.ServerUnreachableError, pm.ServerLostError)):
                    client.check(MODEL, timeout_s=10)

    def test_tokens_and_quotas(self):
        tokens = self.folder / "tokens.conf"
        tokens.write_text("[ann]\ntoken = text:token-of-ann-0001\nrequests_per_minute = 2\nplaces = 3\n")
        with daemon("--tokens", str(tokens)) as server:
            with pm.Client(server.address, token="token-of-nobody-1", retry=NO_RETRY) as client:
                with self.assertRaises(pm.NotAuthenticatedError) as unknown:
                    client.posts()
            self.assertEqual((unknown.exception.code, unknown.exception.reason), ("UNAUTHENTICATED", "TOKEN_UNKNOWN"))
            with pm.Client(server.address, token="token-of-ann-0001", retry=NO_RETRY) as client:
                can = client.capabilities()
                self.assertEqual((can.caller, can.contract), ("ann", "patchmill.v1"))
                self.assertIn(("caller_jobs", 3.0), [(quota.name, quota.value) for quota in can.quotas])
                client.posts()
                with self.assertRaises(pm.QuotaError) as refused:
                    client.posts()
            self.assertEqual((refused.exception.limit, refused.exception.limit_value), ("caller_requests_per_minute", 2.0))

    def test_half_a_certificate(self):
        with pm.Client("localhost:1", tls=pm.Tls(cert=b"x")) as client:
            with self.assertRaisesRegex(pm.OptionError, "belong together"):
                client.posts()

    def test_a_token_is_sent_and_never_in_the_clear(self):
        heard = []

        class Listen(grpc.GenericRpcHandler):
            def service(self, call):
                heard.append(dict(call.invocation_metadata).get("authorization"))

        server = grpc.server(futures.ThreadPoolExecutor(1), handlers=[Listen()])
        port = server.add_insecure_port("127.0.0.1:0")
        server.start()
        tokens = iter(["one", "two"])
        with pm.Client(f"127.0.0.1:{port}", token=lambda: next(tokens), retry=NO_RETRY) as client:
            for _ in range(2):
                with self.assertRaisesRegex(pm.NotAvailableError, "is no server of Patchmill, or one of another version"):
                    client.posts()
        server.stop(None).wait()
        self.assertEqual(heard, ["Bearer one", "Bearer two"])
        with self.assertRaisesRegex(pm.OptionError, "token.*unencrypted"):
            pm.Client("cam.example:50051", token="secret")
        for address in ("localhost:1", "127.3.4.5:1", "[::1]:1", "unix:/run/patchmill"):
            pm.Client(address, token="secret").close()


class ReadOnly(unittest.TestCase):
    def test_several_threads_share_a_client(self):
        with daemon() as server, pm.Client(server.address) as client:
            digests = []
            threads = [threading.Thread(target=lambda: digests.append(client.check(MODEL).model_sha256)) for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual((len(digests), len(set(digests))), (4, 1))

    def test_the_command_line_and_the_package_share_a_server(self):
        with daemon() as server, tempfile.TemporaryDirectory() as folder:
            with pm.Client(server.address) as client:
                ours = client.mill(HILLS, operation(1.0), outputs=()).program_bytes
            program = pathlib.Path(folder) / "hills.ngc"
            subprocess.run([BIN / "patchmill", "mill", HILLS, "-o", program, "--scallop", "1", "--tolerance", "0.05", "--server",
                            server.address, "--quiet"], check=True, capture_output=True)
            self.assertEqual(program.read_bytes(), ours)


if __name__ == "__main__":
    unittest.main()

"""Bearer tokens: who gets in, what a caller reaches, and what its quotas refuse."""
import os
import subprocess
import threading
import unittest

import grpc
from support import PATCHMILL, ROOT, TOKENS, TYPES, Folder, Server, call, health, refused, wait_until, worked_request

REFLECTION = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo"


def long_job():
    """A job that runs for longer than any of these tests."""
    request = worked_request("GenerateProgram")[0]
    request.job.operations[0].scallop_mm = 0.0002
    request.job.operations[0].tolerance_mm = 0.0002
    return request


class Tokens(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(Folder())

    def server(self, *flags):
        server = self.enterContext(Server(*flags))
        return server, self.enterContext(grpc.insecure_channel(server.address))

    def test_only_callers_with_a_token_get_in(self):
        server, channel = self.server("--tokens", self.folder.tokens())
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["ann"]).code, "OK")
        for token, reason in [(None, "TOKEN_MISSING"), ("wrong-wrong-wrong", "TOKEN_UNKNOWN"), ("", "TOKEN_UNKNOWN")]:
            for name in ("ListPosts", "GenerateProgram", "UploadModel"):
                answer = call(channel, name, token=token)
                self.assertEqual((answer.code, answer.reason, answer.events), ("UNAUTHENTICATED", reason, []), name)
        answer = call(channel, "ListPosts", metadata={"authorization": "Basic dXNlcjp3b3Jk"})
        self.assertEqual((answer.code, answer.reason), ("UNAUTHENTICATED", "TOKEN_UNREADABLE"))
        self.assertEqual(health(channel), "SERVING")  # whoever balances the load has no token
        with self.assertRaises(grpc.RpcError) as caught:
            list(channel.stream_stream(REFLECTION, None, None)(iter([b""]), timeout=20))
        self.assertEqual(caught.exception.code().name, "UNAUTHENTICATED")
        self.assertNotIn("wrong-wrong-wrong", server.log())

    def test_a_caller_reaches_neither_models_nor_answers_of_another(self):
        _, channel = self.server("--tokens", self.folder.tokens())
        ann, bob = TOKENS["ann"], TOKENS["bob"]
        uploaded = call(channel, "UploadModel", token=ann)
        self.assertEqual(uploaded.code, "OK", uploaded.message)
        digest = uploaded.events[0].model_sha256
        job = worked_request("GenerateProgram")[0]
        job.job.source.Clear()
        job.job.source.model_sha256 = digest
        first = call(channel, "GenerateProgram", [job], token=ann)
        self.assertNotEqual(first.reason, "MODEL_NOT_CACHED", first.message)
        check = TYPES.of("CheckModelRequest")()
        check.source.model_sha256 = digest
        self.assertEqual(call(channel, "CheckModel", [check], token=ann).code, "OK")
        for name, request in [("CheckModel", check), ("GenerateProgram", job)]:
            answer = call(channel, name, [request], token=bob)
            self.assertEqual((answer.code, answer.reason), ("NOT_FOUND", "MODEL_NOT_CACHED"), name)
        forget = TYPES.of("ForgetModelRequest")(model_sha256=digest)
        self.assertFalse(call(channel, "ForgetModel", [forget], token=bob).events[0].was_there)
        self.assertEqual(call(channel, "CheckModel", [check], token=ann).code, "OK")
        self.assertTrue(call(channel, "ForgetModel", [forget], token=ann).events[0].was_there)

    def test_a_file_that_changes_counts_and_a_wrong_one_does_not(self):
        path = self.folder.tokens()
        server, channel = self.server("--tokens", path)
        self.folder.write("tokens.conf", f"[ann]\ntoken = text:{TOKENS['ann']}\ntoken = text:renewed-token-of-ann\n")
        self.assertTrue(server.logged("1 callers"))
        self.assertEqual(call(channel, "ListPosts", token="renewed-token-of-ann").code, "OK")
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["ann"]).code, "OK")  # while it is renewed, both
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["bob"]).reason, "TOKEN_UNKNOWN")
        self.folder.write("tokens.conf", "[ann]\nplaces = none\n")
        self.assertTrue(server.logged("line 2: places = none; must be a whole number from 1 to 64"))
        self.assertTrue(server.logged("the callers of before stay"))
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["ann"]).code, "OK")

    def test_a_wrong_file_at_the_start_is_one_error(self):
        path = self.folder.write("tokens.conf", "[ann]\ntoken = short\n")
        status, message = refused("--tokens", path)
        self.assertEqual((status, message.count("\n")), (2, 1), message)
        self.assertIn(f"{path}, line 2: a token begins with sha256: or text:", message)
        status, message = refused("--tokens", path + ".none")
        self.assertEqual((status, message.count("\n")), (2, 1), message)
        self.assertIn("cannot be read", message)

    def test_requests_of_a_minute(self):
        _, channel = self.server("--tokens", self.folder.tokens("requests_per_minute = 2\n"))
        codes = [call(channel, "ListPosts", token=TOKENS["ann"]) for _ in range(3)]
        self.assertEqual([answer.code for answer in codes], ["OK", "OK", "RESOURCE_EXHAUSTED"])
        self.assertEqual((codes[2].reason, codes[2].info.limit, codes[2].info.limit_value),
                         ("QUOTA_EXCEEDED", "caller_requests_per_minute", 2.0))
        self.assertTrue(0.0 < codes[2].retry_s <= 30.01, codes[2].retry_s)
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["bob"]).code, "OK")

    def test_seconds_of_jobs_end_the_job_that_uses_them_up(self):
        _, channel = self.server("--tokens", self.folder.tokens("job_seconds_per_day = 1\n"))
        answer = call(channel, "GenerateProgram", [long_job()], token=TOKENS["ann"])
        self.assertEqual((answer.code, answer.reason, answer.info.limit),
                         ("RESOURCE_EXHAUSTED", "QUOTA_EXCEEDED", "caller_job_seconds_per_day"), answer.message)
        self.assertLessEqual(answer.retry_s, 86400.0)
        again = call(channel, "GenerateProgram", token=TOKENS["ann"])
        self.assertEqual(again.reason, "QUOTA_EXCEEDED")
        self.assertEqual(call(channel, "CheckModel", token=TOKENS["ann"]).code, "OK")  # no job

    def test_places(self):
        _, channel = self.server("--tokens", self.folder.tokens("places = 1\n"), "--max-jobs", "3", "--drain-seconds", "0")
        started = []

        def run(k):
            request = long_job()
            request.job.operations[0].scallop_mm = 0.0002 + 1e-6 * k  # jobs that are not the same
            make = channel.unary_stream("/patchmill.v1.ToolpathService/GenerateProgram", lambda m: m.SerializeToString(),
                                        TYPES.of("GenerateProgramResponse").FromString)
            stream = make(request, metadata=[("authorization", f"Bearer {TOKENS['ann']}")], timeout=100)
            started.append(stream)
            try:
                for _ in stream:
                    stream.has_begun = True
            except grpc.RpcError:
                pass

        threads = [threading.Thread(target=run, args=(k,)) for k in range(5)]
        for thread in threads:
            thread.start()
        self.assertTrue(wait_until(lambda: sum(getattr(s, "has_begun", False) for s in started) == 5))
        answer = wait_for_refusal(channel)
        self.assertEqual((answer.reason, answer.info.limit), ("QUOTA_EXCEEDED", "caller_jobs"), answer.message)
        self.assertEqual(call(channel, "GenerateProgram", token=TOKENS["bob"]).code, "OK")
        for stream in started:
            stream.cancel()
        for thread in threads:
            thread.join()

    def test_store(self):
        _, channel = self.server("--tokens", self.folder.tokens("store_mib = 1\n"))
        job = worked_request("UploadModel")
        self.assertEqual(call(channel, "UploadModel", job, token=TOKENS["ann"]).code, "OK")

    def test_the_command_line_sends_its_token(self):
        server, _ = self.server("--tokens", self.folder.tokens())
        file = self.folder.write("ann.token", TOKENS["ann"] + "\n")
        model = str(ROOT / "examples/mouse.json")

        def run(*flags, env=None):
            return subprocess.run([PATCHMILL, "check", model, "--server", server.address, *flags], capture_output=True, text=True,
                                  env={**os.environ, **(env or {})}, timeout=60)

        self.assertEqual(run("--token-file", file).returncode, 0)
        self.assertEqual(run(env={"PATCHMILL_TOKEN_FILE": file}).returncode, 0)
        without = run()
        self.assertEqual(without.returncode, 1, without.stderr)
        self.assertIn("does not know the caller: the call has no token", without.stderr)
        self.assertIn("--token-file", without.stderr)
        empty = run("--token-file", self.folder.write("empty", "\n"))
        self.assertEqual(empty.returncode, 2)
        self.assertIn("the first line must be a token", empty.stderr)
        # Names that begin like addresses of this machine are others'.
        for server in ["cam.example:50051", "127.cam.example:50051", "unix.cam.example:50051"]:
            clear = subprocess.run([PATCHMILL, "check", model, "--server", server, "--token-file", file],
                                   capture_output=True, text=True, timeout=60)
            self.assertEqual(clear.returncode, 2, server)
            self.assertIn("without TLS", clear.stderr)


def wait_for_refusal(channel):
    """The sixth job: one runs and four wait, as soon as the server has them all."""
    answers = []

    def ask():
        request = long_job()
        request.job.operations[0].scallop_mm = 0.0003  # the same request would join the job that runs
        answers.append(call(channel, "GenerateProgram", [request], token=TOKENS["ann"], timeout=1.0))
        return answers[-1].code == "RESOURCE_EXHAUSTED"

    wait_until(ask)
    return answers[-1]


if __name__ == "__main__":
    unittest.main()

"""The log: two lines for each call, with the true reason, and never a word of a model."""
import json
import re
import unittest

import grpc
from support import TOKENS, Folder, Server, call, wait_until, worked_request

SECRET = "turbine-blade-7"


def lines(server):
    return [json.loads(line) for line in server.log().splitlines()]


def ends(server):
    return [line for line in lines(server) if line["message"] == "call ends"]


class Log(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(Folder())

    def json_server(self, *flags):
        server = self.enterContext(Server("--log-format", "json", *flags))
        return server, self.enterContext(grpc.insecure_channel(server.address))

    def test_start_and_end_of_a_call(self):
        server, channel = self.json_server("--tokens", self.folder.tokens())
        job = worked_request("GenerateProgram")[0]
        job.request_id = "order-4711"
        self.assertEqual(call(channel, "GenerateProgram", [job], token=TOKENS["ann"]).code, "OK")
        self.assertEqual(call(channel, "ListPosts", token=TOKENS["bob"], metadata={"x-request-id": "from-a-proxy"}).code, "OK")
        self.assertTrue(wait_until(lambda: len(ends(server)) == 2))
        begun = {line["call"]: line for line in lines(server) if line["message"] == "call begins"}
        first, second = ends(server)
        self.assertEqual((first["method"], first["caller"], first["code"], first["request_id"], first["level"]),
                         ("GenerateProgram", "ann", "OK", "order-4711", "info"))
        self.assertEqual((second["method"], second["caller"], second["request_id"]), ("ListPosts", "bob", "from-a-proxy"))
        self.assertGreater(first["seconds"], 0.0)
        self.assertEqual(begun[first["call"]]["method"], "GenerateProgram")
        self.assertRegex(first["peer"], r"^ipv4:127\.0\.0\.1:\d+$")
        for line in lines(server):
            self.assertRegex(line["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d\d:\d\d$")

    def test_text_says_the_same(self):
        with Server() as server, grpc.insecure_channel(server.address) as channel:
            call(channel, "ListPosts", metadata={"x-request-id": 'a "b" c'})
            self.assertTrue(server.logged("call ends"))
            line = next(line for line in server.log().splitlines() if "call ends" in line)
            self.assertRegex(line, r'^\S+[+-]\d\d:\d\d info call ends: call=\d+ method=ListPosts request_id="a \\"b\\" c" '
                                   r'peer=ipv4:127\.0\.0\.1:\d+ code=OK seconds=\S+$')

    def test_a_deadline_is_no_cancel(self):
        server, channel = self.json_server()
        job = worked_request("GenerateProgram")[0]
        job.job.operations[0].scallop_mm = job.job.operations[0].tolerance_mm = 0.0002
        self.assertEqual(call(channel, "GenerateProgram", [job], timeout=0.5).code, "DEADLINE_EXCEEDED")
        self.assertTrue(wait_until(lambda: len(ends(server)) == 1))
        self.assertEqual((ends(server)[0]["code"], ends(server)[0]["reason"]), ("DEADLINE_EXCEEDED", "DEADLINE_EXCEEDED"))
        path = "/patchmill.v1.ToolpathService/GenerateProgram"
        stream = channel.unary_stream(path, lambda m: m.SerializeToString(), None)(job, timeout=60)
        next(stream)
        stream.cancel()
        self.assertTrue(wait_until(lambda: len(ends(server)) == 2))
        self.assertEqual((ends(server)[1]["code"], ends(server)[1]["reason"]), ("CANCELLED", "CANCELLED"))

    def test_refusals_have_their_reason(self):
        server, channel = self.json_server("--tokens", self.folder.tokens("requests_per_minute = 1\n"))
        call(channel, "ListPosts", token="wrong-wrong-wrong")
        call(channel, "ListPosts", token=TOKENS["ann"])
        call(channel, "ListPosts", token=TOKENS["ann"])
        self.assertTrue(wait_until(lambda: len(ends(server)) == 3))
        unknown, _, quota = ends(server)
        self.assertEqual((unknown["code"], unknown["reason"], unknown["level"]), ("UNAUTHENTICATED", "TOKEN_UNKNOWN", "warning"))
        self.assertNotIn("caller", unknown)
        self.assertEqual((quota["reason"], quota["limit"], quota["limit_value"]), ("QUOTA_EXCEEDED", "caller_requests_per_minute", 1))

    def test_no_word_of_a_model(self):
        server, channel = self.json_server()
        job = worked_request("GenerateProgram")[0]
        job.job.name = SECRET
        job.job.source.model.patches[0].id = SECRET
        self.assertEqual(call(channel, "GenerateProgram", [job]).code, "OK")
        answers = []
        del job.job.source.model.patches[0].bezier.points[3:]
        answers.append(call(channel, "GenerateProgram", [job]))
        check = worked_request("CheckModel")[0]
        for content, kind in [(f"{SECRET} 1 2 3\n{SECRET}", "bpt"), (f'{{"{SECRET}": 1}}', "json")]:
            check.source.file.content, check.source.file.format = content.encode(), kind
            answers.append(call(channel, "CheckModel", [check]))
        verify = worked_request("VerifyProgram")[0]
        verify.program = f"G21\nO<{SECRET}> CALL\n".encode()
        answers.append(call(channel, "VerifyProgram", [verify]))
        self.assertEqual([answer.code for answer in answers], ["INVALID_ARGUMENT"] * 4)
        self.assertIn(SECRET, "".join(answer.message for answer in answers))  # the caller reads it
        self.assertTrue(wait_until(lambda: len(ends(server)) == 5))
        self.assertNotIn("turbine", server.log().lower())
        self.assertEqual([line["code"] for line in ends(server)].count("INVALID_ARGUMENT"), 4)

    def test_a_crash_leaves_no_core(self):
        with Server() as server:
            limits = open(f"/proc/{server.process.pid}/limits").read()
            self.assertRegex(limits, r"Max core file size +0 +0 ")

    def test_draining_is_logged(self):
        server, _ = self.json_server()
        server.process.terminate()
        self.assertEqual(server.process.wait(10), 0)
        said = [line["message"] for line in lines(server)]
        self.assertTrue(any(re.match(r"signal 15: draining", message) for message in said), said)
        self.assertEqual(said[-1], "stopped")


if __name__ == "__main__":
    unittest.main()

"""GetCapabilities, and readiness apart from liveness."""
import subprocess
import threading
import unittest

import grpc
from certificates import Authority
from support import PATCHMILL, TOKENS, Folder, Server, call, health, wait_until, worked_request
from test_metrics import metrics_port, scrape


def numbers(named):
    return {number.name: number.value for number in named}


def set_field(message, path, value):
    """Sets the field of a path such as job.operations[0].detail to a value that is given as text."""
    *outer, last = path.split(".")
    for step in outer:
        name, _, index = step.rstrip("]").partition("[")
        message = getattr(message, name)[int(index)] if index else getattr(message, name)
    field = message.DESCRIPTOR.fields_by_name[last]
    if field.enum_type is not None:
        value = field.enum_type.values_by_name[value].number
    elif field.cpp_type == field.CPPTYPE_BOOL:
        value = value == "true"
    elif field.cpp_type != field.CPPTYPE_STRING:
        value = (int if field.cpp_type == field.CPPTYPE_INT32 else float)(value)
    setattr(message, last, value)


class Capabilities(unittest.TestCase):
    def test_they_are_those_of_this_server_and_caller(self):
        with Folder() as folder:
            cert, key = Authority(folder.path).sign("server")
            tokens = folder.write("tokens.conf", f"[ann]\ntoken = text:{TOKENS['ann']}\nplaces = 2\nstore_mib = 3\n"
                                                 f"[bob]\ntoken = text:{TOKENS['bob']}\n")
            with Server("--tokens", tokens, "--max-jobs", "5", "--max-queue", "9", "--max-job-seconds", "77", "--threads", "2",
                        "--cache-dir", str(folder.path / "cache")) as server, grpc.insecure_channel(server.address) as channel:
                answer = call(channel, "GetCapabilities", token=TOKENS["ann"]).events[0]
                other = call(channel, "GetCapabilities", token=TOKENS["bob"]).events[0]
                posts = call(channel, "ListPosts", token=TOKENS["bob"]).events[0]
                accepted = call(channel, "GenerateProgram", token=TOKENS["bob"]).events[0].accepted
            with Server("--cert", cert, "--key", key, "--store-mib", "0", "--metrics-listen", "127.0.0.1:0") as server:
                credentials = grpc.ssl_channel_credentials(open(folder.path / "ca.pem", "rb").read())
                with grpc.secure_channel(server.address, credentials) as channel:
                    plain = call(channel, "GetCapabilities").events[0]
        self.assertEqual(list(answer.dialects), [post.name for post in posts.posts])
        self.assertEqual(answer.server_version, accepted.server_version)
        self.assertEqual(answer.contract, "patchmill.v1")
        limits = numbers(answer.limits)
        self.assertEqual((limits["running_jobs"], limits["waiting_jobs"], limits["job_seconds"], limits["job_threads"]), (5, 9, 77, 2))
        self.assertEqual(limits["message_bytes"], 64 << 20)
        self.assertEqual((answer.caller, numbers(answer.quotas)), ("ann", {"caller_jobs": 2, "caller_store_bytes": 3 << 20}))
        self.assertEqual((other.caller, list(other.quotas)), ("bob", []))
        self.assertLessEqual({"tokens", "store", "disk_cache"}, set(answer.features))
        self.assertFalse({"tls", "metrics"} & set(answer.features))
        self.assertLessEqual({"tls", "metrics"}, set(plain.features))
        self.assertFalse({"tokens", "store"} & set(plain.features))
        self.assertEqual((plain.caller, list(plain.quotas)), ("", []))
        self.assertEqual({"step", "iges"} <= set(answer.model_formats), "cad_import" in answer.features)
        self.assertLessEqual({"json", "pb", "bpt", "bv", "bez", "patches"}, set(answer.model_formats))

    def test_the_command_line_prints_them(self):
        with Folder() as folder:
            token = folder.write("token", TOKENS["ann"])
            tokens = folder.tokens("places = 2\n")
            with Server("--tokens", tokens, "--max-jobs", "5") as server:
                said = subprocess.run([PATCHMILL, "capabilities", "--server", server.address, "--token-file", token],
                                      capture_output=True, text=True, timeout=60)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertRegex(said.stdout, r"(?m)^caller +ann$")
        self.assertRegex(said.stdout, r"(?m)^limit running_jobs +5$")
        self.assertRegex(said.stdout, r"(?m)^quota caller_jobs +2$")
        self.assertRegex(said.stdout, r"(?m)^dialects +.*linuxcnc")

    def test_a_default_is_what_a_request_without_the_field_gets(self):
        job = worked_request("GenerateProgram")[0]
        job.post.Clear()
        job.validate_only = True
        with Server() as server, grpc.insecure_channel(server.address) as channel:
            defaults = {d.name: d.value for d in call(channel, "GetCapabilities").events[0].defaults}
            digest = call(channel, "GenerateProgram", [job]).events[0].accepted.request_sha256
            for path, value in defaults.items():
                stated = type(job)()
                stated.CopyFrom(job)
                set_field(stated, path, value)
                answer = call(channel, "GenerateProgram", [stated])
                self.assertEqual(answer.code, "OK", f"{path} = {value}: {answer.message}")
                self.assertEqual(answer.events[0].accepted.request_sha256, digest, f"{path} = {value}")
        self.assertEqual(defaults["post.dialect"], "linuxcnc")  # docs/posts.md
        self.assertEqual(defaults["job.operations[0].strategy"], "STRATEGY_AUTO")
        for path in ("job.operations[0].steep_angle_deg", "job.operations[0].heights.clearance_above_mm", "post.work_offset", "post.arcs"):
            self.assertIn(path, defaults)
        # What a request has to state, and what follows from that, is no default.
        for path in ("tool.ball_end.diameter_mm", "scallop_mm", "leads.radius_mm"):
            self.assertNotIn("job.operations[0]." + path, defaults)


class Probes(unittest.TestCase):
    def test_a_server_that_drains_is_alive_and_not_ready(self):
        job = worked_request("GenerateProgram")[0]
        job.job.operations[0].scallop_mm = job.job.operations[0].tolerance_mm = 0.0002
        with Server("--drain-seconds", "20", "--metrics-listen", "127.0.0.1:0") as server, grpc.insecure_channel(server.address) as channel:
            self.assertEqual([health(channel, name) for name in ("", "readiness", "liveness")], ["SERVING"] * 3)
            self.assertEqual(health(channel, "patchmill.v1.ServerService"), "SERVING")
            self.assertEqual(health(channel, "startup"), "NOT_FOUND")
            ended = []
            thread = threading.Thread(target=lambda: ended.append(call(channel, "GenerateProgram", [job], timeout=4.0)))
            thread.start()
            port = metrics_port(server)
            self.assertTrue(wait_until(lambda: scrape(port)["patchmill_jobs_running"] == 1))
            server.process.terminate()
            self.assertTrue(wait_until(lambda: health(channel, "readiness") == "NOT_SERVING"))
            self.assertEqual(health(channel, "liveness"), "SERVING")
            thread.join()
        self.assertEqual(ended[0].code, "DEADLINE_EXCEEDED")


if __name__ == "__main__":
    unittest.main()

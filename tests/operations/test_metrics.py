"""Metrics are read over HTTP, on this machine alone unless the operator says otherwise."""
import pathlib
import re
import socket
import unittest
import urllib.request

import grpc
from support import TOKENS, Folder, Server, call, refused, wait_until, worked_request

SAMPLE = re.compile(r"^(\w+)(?:\{(.*)\})? ([^ ]+)$", re.MULTILINE)


def metrics_port(server):
    assert server.logged("metrics are at port")
    return int(re.search(r"metrics are at port (\d+)", server.log())[1])


def scrape(port):
    """The samples, by name and labels as they stand."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=10) as answer:
        text = answer.read().decode()
    return {f"{name}{{{labels}}}" if labels else name: float(value) for name, labels, value in SAMPLE.findall(text)}


def listens_at(port):
    """The addresses of the sockets that listen at a port, in hex."""
    found = set()
    for table in ("tcp", "tcp6"):
        for line in pathlib.Path("/proc/net", table).read_text().splitlines()[1:]:
            local, state = line.split()[1], line.split()[3]
            if state == "0A" and int(local.split(":")[1], 16) == port:
                found.add(local.split(":")[0])
    return found


class Metrics(unittest.TestCase):
    def test_what_they_say(self):
        with Folder() as folder, Server("--metrics-listen", "127.0.0.1:0", "--tokens", folder.tokens(), "--store-mib", "64",
                                        "--memory-limit", "2048", "--max-jobs", "3") as server:
            port = metrics_port(server)
            before = scrape(port)
            self.assertEqual([before[f"patchmill_{name}"] for name in ("job_places", "jobs_running", "jobs_waiting")], [3, 0, 0])
            self.assertEqual(before["patchmill_memory_limit_bytes"], 2048 * 2**20)
            self.assertGreater(before["patchmill_resident_bytes"], 2**20)
            self.assertEqual(before["patchmill_store_values"], 0)
            with grpc.insecure_channel(server.address) as channel:
                self.assertEqual(call(channel, "UploadModel", token=TOKENS["ann"]).code, "OK")
                self.assertEqual(call(channel, "GenerateProgram", token=TOKENS["ann"]).code, "OK")
                self.assertEqual(call(channel, "GenerateProgram", token=TOKENS["ann"]).code, "OK")  # from the store
                wrong = worked_request("GenerateProgram")[0]
                wrong.job.operations[0].scallop_mm = -1
                self.assertEqual(call(channel, "GenerateProgram", [wrong], token=TOKENS["ann"]).code, "INVALID_ARGUMENT")
                self.assertEqual(call(channel, "ListPosts").code, "UNAUTHENTICATED")
                broken = worked_request("CheckModel")[0]
                broken.source.file.content, broken.source.file.format = b"ISO-10303-21; nonsense", "step"
                self.assertNotEqual(call(channel, "CheckModel", [broken], token=TOKENS["ann"]).code, "OK")
            after = scrape(port)
            self.assertEqual(after['patchmill_calls_total{code="OK",method="GenerateProgram"}'], 2)
            self.assertEqual(after['patchmill_calls_total{code="INVALID_ARGUMENT",method="GenerateProgram"}'], 1)
            self.assertEqual(after['patchmill_call_seconds_count{method="GenerateProgram"}'], 3)
            self.assertEqual(after['patchmill_refusals_total{reason="INVALID_FIELDS"}'], 1)
            self.assertEqual(after['patchmill_refusals_total{reason="TOKEN_MISSING"}'], 1)
            self.assertEqual(after["patchmill_token_failures_total"], 1)
            self.assertGreater(sum(v for k, v in after.items() if k.startswith("patchmill_stage_seconds_total{")), 0)
            self.assertGreaterEqual(after["patchmill_store_values"], 2)  # a model and an answer
            self.assertGreater(after["patchmill_store_bytes"], 0)
            self.assertGreaterEqual(after["patchmill_store_hits_total"], 1)
            self.assertEqual(after["patchmill_certificate_defects_total"], 0)
            self.assertEqual(after["patchmill_import_failures_total"], 1)
            self.assertNotIn("ann", " ".join(after))  # no name of a caller

    def test_a_running_and_a_waiting_job(self):
        job = worked_request("GenerateProgram")[0]
        job.job.operations[0].scallop_mm = job.job.operations[0].tolerance_mm = 0.0002
        with Server("--metrics-listen", "127.0.0.1:0", "--max-jobs", "1", "--drain-seconds", "0") as server:
            port = metrics_port(server)
            with grpc.insecure_channel(server.address) as channel:
                make = channel.unary_stream("/patchmill.v1.ToolpathService/GenerateProgram", lambda m: m.SerializeToString(), None)
                streams = []
                for scallop in (0.0002, 0.00021):
                    job.job.operations[0].scallop_mm = scallop
                    streams.append(make(job, timeout=60))
                jobs = ("patchmill_jobs_running", "patchmill_jobs_waiting")
                self.assertTrue(wait_until(lambda: [scrape(port)[name] for name in jobs] == [1, 1]))
                self.assertGreater(scrape(port)["patchmill_granted_bytes"], 0)
                for stream in streams:
                    stream.cancel()
                cancelled = 'patchmill_calls_total{code="CANCELLED",method="GenerateProgram"}'
                self.assertTrue(wait_until(lambda: scrape(port).get(cancelled) == 2))

    def test_a_wrong_address(self):
        taken = self.enterContext(socket.create_server(("127.0.0.1", 0)))
        for listen, words in [("nowhere", "must be HOST:PORT"), (":9464", "must be HOST:PORT"), ("127.0.0.1:70000", "must be HOST:PORT"),
                              (f"127.0.0.1:{taken.getsockname()[1]}", "cannot listen there"), ("192.0.2.1:9464", "cannot listen there")]:
            status, message = refused("--metrics-listen", listen)
            self.assertEqual(status, 2, message)
            self.assertIn(f"--metrics-listen {listen}", message)
            self.assertIn(words, message)

    def test_without_the_option_there_are_none_and_a_port_alone_is_of_this_machine(self):
        with Server() as server:
            self.assertNotIn("metrics", server.log())
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        with Server("--metrics-listen", str(port)) as server:
            self.assertEqual(metrics_port(server), port)
            self.assertEqual(listens_at(port), {"0100007F"})  # 127.0.0.1 as the kernel writes it
            self.assertIn("patchmill_job_places", scrape(port))


if __name__ == "__main__":
    unittest.main()

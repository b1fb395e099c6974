"""Several servers behind nginx: one is killed, one added, one drained, and every job ends with the bytes
that it has without a server.

A tenth of it runs in CI, all of it with PATCHMILL_LONG=1 (scripts/long_tests.sh many)."""
import collections
import concurrent.futures
import os
import re
import signal
import subprocess
import threading
import unittest

from fleet import Fleet, package
from parts import large_part, small_part
from support import PATCHMILL, Folder, wait_until
from test_metrics import metrics_port, scrape

JOBS = 200 if os.environ.get("PATCHMILL_LONG") else 20
AT_ONCE = 6  # clients
CALLERS = 40  # many, so that each of three servers has some: nginx keeps a caller at one of them
TOLERANCE = 0.05
LARGE_TOLERANCE = 0.1
Job = collections.namedtuple("Job", "number kind caller scallop")


def token(caller):
    return f"token-of-caller-{caller:04}"


def jobs_of(count):
    """Different jobs: none finds the answer of another one. Some are of the command line, some of the
    package; a tenth is of the large model."""
    jobs = []
    for k in range(count):
        kind = "large" if k % 10 == 4 else "package" if k % 3 == 1 else "command line"
        jobs.append(Job(k, kind, k % CALLERS, (0.3 if kind == "large" else 0.1) + 0.0001 * k))
    return jobs


def running(server):
    return scrape(metrics_port(server))["patchmill_jobs_running"]


def calls(server, event, method):
    """The numbers of the calls of a method in the log of a server, with the codes that they ended with."""
    return dict(re.findall(rf"call {event}: call=(\d+) method={method} (?:.*code=(\w+))?", server.log()))


class Many(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Folder()
        cls.addClassCleanup(cls.folder.__exit__)
        path = cls.folder.path
        cls.pm = package(path)
        cls.small, cls.large = small_part(path), large_part(path)
        cls.tokens = cls.folder.write("tokens.conf", "".join(f"[c{k}]\ntoken = text:{token(k)}\n" for k in range(CALLERS)))
        for k in range(CALLERS):
            cls.folder.write(f"{k}.token", token(k))
        cls.uploaded = {}
        cls.upload_lock = threading.Lock()

    def setUp(self):
        self.fleet = Fleet(self.folder.path, self.tokens, "--metrics-listen", "127.0.0.1:0", "--threads", "1", "--drain-seconds", "30")
        self.addCleanup(self.fleet.__exit__)
        self.log = self.folder.path / "commands.log"

    def command(self, job, *remote):
        """The program of the command line."""
        part, tolerance = (self.large, LARGE_TOLERANCE) if job.kind == "large" else (self.small, TOLERANCE)
        out = self.folder.path / f"{job.number}-{len(remote)}.ngc"
        run = subprocess.run([PATCHMILL, "mill", part, "-o", out, "--tool-diameter", "6", "--scallop", f"{job.scallop:.4f}",
                              "--tolerance", str(tolerance), *remote], capture_output=True, text=True, timeout=120)
        if run.returncode != 0:
            raise AssertionError(f"{job}: {run.stderr}")
        with open(self.log, "a") as log:
            log.write(run.stderr)
        return out.read_bytes()

    def alone(self, job):
        return self.command(job, "--threads", "1")

    def client(self, caller):
        return self.pm.Client(self.fleet.address, tls=self.pm.Tls(ca=self.fleet.ca), token=token(caller))

    def operation(self, job, tolerance):
        return self.pm.Operation(tool=self.pm.ball(6), scallop_mm=round(job.scallop, 4), tolerance_mm=tolerance)

    def shared(self, job):
        """The program of one of the servers."""
        if job.kind == "command line":
            return self.command(job, "--server", self.fleet.address, "--ca", self.fleet.ca, "--token-file",
                                str(self.folder.path / f"{job.caller}.token"))
        if job.kind == "package":
            with self.client(job.caller) as client:
                return client.mill(self.small, self.operation(job, TOLERANCE), outputs=()).program_bytes
        return self.of_large_model(job)

    def of_large_model(self, job):
        """All jobs of the large model are of one caller, which sends it once and names it by its digest."""
        with self.client(0) as client:
            with self.upload_lock:
                if "model" not in self.uploaded:
                    self.uploaded["model"] = client.upload(self.large).model
            return client.mill(self.uploaded["model"], self.operation(job, LARGE_TOLERANCE), outputs=()).program_bytes

    def holder(self):
        return next(server for server in self.fleet.servers if calls(server, "ends", "UploadModel"))

    def test_every_job_ends_with_the_right_bytes(self):
        jobs = jobs_of(JOBS)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            expected = dict(zip(jobs, pool.map(self.alone, jobs)))
        self.fleet.know([self.fleet.start() for _ in range(3)])
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
            ended = {job: pool.submit(self.shared, job) for job in jobs}

            def done():
                return sum(future.done() for future in ended.values())

            def in_a_job(servers):
                found = []
                self.assertTrue(wait_until(lambda: found.extend(s for s in servers if running(s)) or found, 60))
                return found[0]

            # The server that holds the large model is killed while it has a job.
            self.assertTrue(wait_until(lambda: done() >= JOBS // 5 and "model" in self.uploaded, 300))
            killed = in_a_job([self.holder()])
            killed.process.send_signal(signal.SIGKILL)
            killed.process.wait()
            # One more comes. nginx still knows the dead one.
            self.assertTrue(wait_until(lambda: done() >= 2 * JOBS // 5, 300))
            added = self.fleet.start()
            self.fleet.know([*self.fleet.servers, added])
            # One ends in order, without a word to nginx.
            self.assertTrue(wait_until(lambda: done() >= 3 * JOBS // 5, 300))
            drained = in_a_job([s for s in self.fleet.servers if s is not killed and s is not added])
            drained.process.send_signal(signal.SIGTERM)
            for job, future in ended.items():
                self.assertEqual(future.result(timeout=300), expected[job], job)
        self.assertEqual(drained.process.wait(timeout=40), 0)

        lost = calls(killed, "begins", "GenerateProgram").keys() - calls(killed, "ends", "GenerateProgram").keys()
        self.assertTrue(lost, killed.log())
        uploads = [code for s in self.fleet.servers for code in calls(s, "ends", "UploadModel").values()]
        self.assertGreater(uploads.count("OK"), 1)  # the server that came after the dead one did not have the model
        self.assertIn("MODEL_NOT_CACHED", "".join(s.log() for s in self.fleet.servers))
        # The drained server lost none that it had begun.
        self.assertEqual(calls(drained, "begins", "GenerateProgram").keys(), calls(drained, "ends", "GenerateProgram").keys())
        self.assertLessEqual(set(calls(drained, "ends", "GenerateProgram").values()), {"OK", "UNAVAILABLE", "NOT_FOUND"})
        # The added one takes its share of callers.
        for k in range(CALLERS):
            with self.client(k) as client:
                client.capabilities()
        self.assertTrue(calls(added, "ends", "GetCapabilities"))


if __name__ == "__main__":
    unittest.main()

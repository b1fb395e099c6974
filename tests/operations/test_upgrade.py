"""One of two servers is upgraded while jobs run: none is lost, and none gets an answer of the wrong version.

The other version is a copy of the same program in which the one string that states the version is
another one. All that a version decides follows from that string: the header of programs, and under which
digest an answer is kept. An older build would differ in more, but CI has none; and a switch for it in
the program would be there for tests only."""
import concurrent.futures
import signal
import subprocess
import threading
import unittest

from fleet import Fleet, package
from parts import small_part
from support import PATCHMILL, PATCHMILLD, Folder, wait_until

OLD, CALLERS = b"0.0.9", 16


def version_of(program):
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return said.split()[-1].encode()


def other_version(folder):
    """A patchmilld of another version."""
    new, program = version_of(PATCHMILLD), PATCHMILLD.read_bytes()
    assert len(new) == len(OLD) and program.count(b"\0" + new + b"\0") == 1, "the version is no longer one string of the program"
    copy = folder / "patchmilld-old"
    copy.write_bytes(program.replace(b"\0" + new + b"\0", b"\0" + OLD + b"\0"))
    copy.chmod(0o755)
    assert version_of(copy) == OLD
    return copy


class Upgrade(unittest.TestCase):
    def client(self, caller):
        return self.pm.Client(self.fleet.address, tls=self.pm.Tls(ca=self.fleet.ca), token=f"token-of-caller-{caller:04}")

    def job(self, caller, model, scallop):
        with self.client(caller) as client:
            operation = self.pm.Operation(tool=self.pm.ball(6), scallop_mm=scallop, tolerance_mm=0.05)
            return client.mill(model, operation, outputs=()).program_bytes

    def versions(self):
        """The version of the server that each caller meets."""
        found = []
        for caller in range(CALLERS):
            with self.client(caller) as client:
                found.append(client.capabilities().server_version.encode())
        return found

    def alone(self, scallop):
        out = self.folder.path / "alone.ngc"
        subprocess.run([PATCHMILL, "mill", self.part, "-o", out, "--tool-diameter", "6", "--scallop", str(scallop), "--tolerance", "0.05",
                        "--quiet"], check=True, capture_output=True)
        return out.read_bytes()

    def test_no_job_is_lost_and_none_has_an_answer_of_the_wrong_version(self):
        self.folder = Folder()
        self.addCleanup(self.folder.__exit__)
        path = self.folder.path
        self.pm, self.part = package(path), small_part(path)
        old_program, new = other_version(path), version_of(PATCHMILLD)
        tokens = self.folder.write("tokens.conf",
                                   "".join(f"[c{k}]\ntoken = text:token-of-caller-{k:04}\n" for k in range(CALLERS)))
        scallops = [0.3, 0.25, 0.2]
        programs = [self.alone(scallop) for scallop in scallops]
        right = [{new: program, OLD: program.replace(b"Patchmill " + new, b"Patchmill " + OLD)} for program in programs]
        for program in right:
            self.assertNotEqual(program[new], program[OLD])

        self.fleet = Fleet(path, tokens, "--threads", "1", "--drain-seconds", "30")
        self.addCleanup(self.fleet.__exit__)
        disk = ("--cache-dir", str(path / "cache"))
        old, other = self.fleet.start(*disk, program=old_program), self.fleet.start()
        self.fleet.know([old, other])
        before = self.versions()
        self.assertEqual(set(before), {OLD, new})
        kept = before.index(OLD)  # a caller of the server that will be upgraded, with a model and an answer there
        with self.client(kept) as client:
            model = client.upload(self.part).model
        self.assertEqual(self.job(kept, model, scallops[0]), right[0][OLD])

        ended, upgraded = [], threading.Event()

        def stream(caller):
            """Jobs one after the other until the upgrade is done, and one more."""
            for k in range(1000):
                is_last = upgraded.is_set()
                number = k % len(scallops)
                ended.append((number, self.job(caller, self.part, scallops[number])))
                if is_last:
                    return

        callers = [kept, *(c for c in range(CALLERS) if c != kept)][:6]
        with concurrent.futures.ThreadPoolExecutor(len(callers)) as pool:
            streams = [pool.submit(stream, caller) for caller in callers]
            try:
                self.assertTrue(wait_until(lambda: "GenerateProgram" in old.log() and len(ended) >= len(callers), 60))
                old.process.send_signal(signal.SIGTERM)
                self.assertEqual(old.process.wait(timeout=60), 0)
                self.fleet.start(*disk, listen=old.address)
            finally:
                upgraded.set()
            for finished in streams:
                finished.result(timeout=120)
        for number, program in ended:
            self.assertIn(program, right[number].values(), number)
        self.assertEqual(set(self.versions()), {new})
        # The answer on the disk is of the old version, and the model was in the memory of the old process.
        self.assertEqual(self.job(kept, model, scallops[0]), right[0][new])


if __name__ == "__main__":
    unittest.main()

"""docs/operations.md: its commands run, one after the other, in an empty folder."""
import os
import re
import socket
import subprocess
import unittest

from support import BIN, ROOT, Folder

PAGE = (ROOT / "docs/operations.md").read_text()


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as found:
        return found.getsockname()[1]


class Page(unittest.TestCase):
    def test_its_commands_run(self):
        blocks = re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 7)
        commands = "".join(blocks)
        ports = set(re.findall(r"(?:127\.0\.0\.1|localhost):(\d+)", commands))
        self.assertEqual(len(ports), 7)
        for port in ports:
            commands = commands.replace(port, str(free_port()))
        script = "set -euo pipefail\ntrap 'kill $(jobs -p) 2>/dev/null || true' EXIT\n" + commands + "echo all-done\n"
        with Folder() as folder:
            (folder.path / "deploy").symlink_to(ROOT / "deploy")
            ended = subprocess.run(["bash", "-c", script], cwd=folder.path, capture_output=True, text=True, timeout=120,
                                   env={**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"})
            self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
            self.assertTrue(ended.stdout.endswith("all-done\n"), ended.stdout)
            self.assertIn("M2", (folder.path / "part.ngc").read_text())

    def test_it_names_the_metrics_that_there_are(self):
        source = (ROOT / "server/operate/metrics.cc").read_text()
        there = set(re.findall(r'"(patchmill_\w+)"', source))
        table = PAGE[PAGE.index("\n## Metrics"):PAGE.index("\n## Log")]
        named = set(re.findall(r"`(patchmill_\w+)", table))
        self.assertEqual(named, there)


if __name__ == "__main__":
    unittest.main()

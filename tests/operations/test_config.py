"""Every flag by command line, environment and file; the page of reference; each wrong configuration."""
import os
import re
import subprocess
import unittest

from support import PATCHMILL, PATCHMILLD, ROOT, Folder, Server, refused

SERVE = [PATCHMILL, "serve", "--listen", "127.0.0.1:0"]
NOT_OPTIONS = {"--help", "--version", "--check-health"}


def help_text(*program):
    return subprocess.run([*program, "--help"], capture_output=True, text=True, check=True, timeout=30).stdout


def options_of(text):
    """The options of a --help, with their defaults."""
    found = {}
    for line in text.splitlines():
        match = re.match(r"^  (?:-\w,)?(--[\w-]+)(?: \w+(?::[^=]*?)?)?(?:=(\S+))?", line)
        if match:
            found[match[1]] = match[2]
    return found


class Help(unittest.TestCase):
    def test_both_programs_have_the_same_options(self):
        daemon, serve = options_of(help_text(PATCHMILLD)), options_of(help_text(PATCHMILL, "serve"))
        self.assertEqual(set(daemon) - NOT_OPTIONS, set(serve) - NOT_OPTIONS)
        self.assertGreater(len(daemon), 20)
        for text in (help_text(PATCHMILLD), help_text(PATCHMILL, "serve")):
            for words in ("Examples:", "Signals:", "Exit status:", "Callers", "PATCHMILLD_MAX_JOBS"):
                self.assertIn(words, text)

    def test_the_page_of_reference_has_each_with_its_variable(self):
        page = (ROOT / "docs/operations.md").read_text()
        rows = dict(re.findall(r"^\| `(--[\w-]+)` \| `(PATCHMILLD_\w+)` \|", page, re.MULTILINE))
        options = set(options_of(help_text(PATCHMILLD))) - NOT_OPTIONS
        self.assertEqual(set(rows), options)
        for option, variable in rows.items():
            self.assertEqual(variable, "PATCHMILLD_" + option[2:].upper().replace("-", "_"))


class Sources(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(Folder())

    def places(self, *flags, env=None):
        """How many places for jobs the server has, as its metrics say."""
        from test_metrics import metrics_port, scrape
        with Server("--metrics-listen", "127.0.0.1:0", *flags, env=env) as server:
            return scrape(metrics_port(server))["patchmill_job_places"]

    def test_the_command_line_goes_before_the_environment_and_that_before_the_file(self):
        file = self.folder.write("serve.conf", "# of this machine\nmax-jobs = 5\nmax-queue = 7\n\n")
        self.assertEqual(self.places("--config", file), 5)
        self.assertEqual(self.places(f"--config={file}", env={"PATCHMILLD_MAX_JOBS": "4"}), 4)
        self.assertEqual(self.places("--max-jobs", "3", env={"PATCHMILLD_MAX_JOBS": "4", "PATCHMILLD_CONFIG": file}), 3)
        self.assertEqual(self.places(env={"PATCHMILLD_CONFIG": file}), 5)

    def test_flags_without_a_value(self):
        env = {"PATCHMILLD_LISTEN": "0.0.0.0:0", "PATCHMILLD_INSECURE": "true"}
        with Server(env=env, listen=None) as server:
            self.assertTrue(server.logged("listens on 0.0.0.0:0"))
        status, message = refused(env={**env, "PATCHMILLD_INSECURE": "false"}, program=[PATCHMILLD])
        self.assertEqual(status, 2)
        self.assertIn("--insecure if the network is trusted", message)

    def test_wrong_configuration_of_every_kind_is_one_error(self):
        def file(text):
            folder = self.enterContext(Folder())
            return ["--config", folder.write("serve.conf", text)]

        for program in ([PATCHMILLD, "--listen", "127.0.0.1:0"], SERVE):
            for flags, env, words in [
                (["--max-jobs", "65"], {}, "--max-jobs: Value 65 not in range"),
                (["--max-jobs", "many"], {}, "--max-jobs"),
                (["--max-jobs"], {}, "--max-jobs"),
                (["--max-job", "3"], {}, "--max-job"),
                (["--log-format", "xml"], {}, "--log-format: xml not in"),
                (["--cache-days", "-1"], {}, "--cache-days: Value -1 not in range"),
                ([], {"PATCHMILLD_MAX_JOBS": "65"}, "not in range 0 to 64 (from PATCHMILLD_MAX_JOBS)"),
                ([], {"PATCHMILLD_MAX_JOB": "6"}, "PATCHMILLD_MAX_JOB: there is no option --max-job"),
                ([], {"PATCHMILLD_TOKENS": ""}, "PATCHMILLD_TOKENS: has no value for --tokens"),
                ([], {"PATCHMILLD_INSECURE": "yes"}, "PATCHMILLD_INSECURE: --insecure = yes; must be true or false"),
                (file("max-jobs = 65\n"), {}, "serve.conf, line 1)"),
                (file("\nmax-job = 6\n"), {}, "serve.conf, line 2: there is no option --max-job"),
                (file("max-jobs\n"), {}, "serve.conf, line 1: is no \"option = value\""),
                (file("max-jobs =\n"), {}, "serve.conf, line 1: has no value for --max-jobs"),
                (file("max-jobs = 1\nmax-jobs = 2\n"), {}, "line 2: max-jobs stands in line 1 already"),
                (file("insecure = 1\n"), {}, "line 1: --insecure = 1; must be true or false"),
                (["--config", "/nowhere/serve.conf"], {}, "--config /nowhere/serve.conf: cannot be read: No such file"),
                (["--config", str(self.folder.path)], {}, "cannot be read: Is a directory"),
                (["--tokens", "/nowhere/tokens"], {}, "--tokens /nowhere/tokens: cannot be read"),
                (["--cache-dir", "/proc/nowhere"], {}, "/proc/nowhere"),
            ]:
                status, message = refused(*flags, env=env, program=program)
                self.assertEqual((status, message.count("\n")), (2, 1), (program, flags, env, message))
                self.assertIn(words, message)
        for listen, words in [("0.0.0.0:0", "without TLS"), ("nowhere", "must be HOST:PORT"), ("127.0.0.1:x", "must be HOST:PORT"),
                              ("192.0.2.1:0", "192.0.2.1:0")]:
            status, message = refused("--listen", listen, program=[PATCHMILLD])
            self.assertEqual((status, message.count("\n")), (2, 1), message)
            self.assertIn(words, message)

    def test_other_variables_are_left_alone(self):
        env = {**os.environ, "PATCHMILLD": "/usr/bin/patchmilld"}
        ended = subprocess.run([PATCHMILLD, "--version"], env=env, capture_output=True, timeout=30)
        self.assertEqual(ended.returncode, 0)


if __name__ == "__main__":
    unittest.main()

"""The command lines of the pages do what the pages say: the real buf against a running server, offline."""
import json
import shlex
import subprocess
import unittest
from typing import Any

from support import PATCHMILLD, ROOT  # before the modules of scripts: it makes them importable

from contract.calls import Types, call, server
from contract.descriptors import descriptor_set, read_contract
from contract.rpc_page import command

FILES = descriptor_set(ROOT / "proto")
CONTRACT = read_contract(FILES)
BUF = ROOT / "node_modules/.bin/buf"


def documents(text: str) -> list[dict[str, Any]]:
    """The JSON documents of a text, one after the other."""
    found, at = [], 0
    while text[at:].strip():
        at += len(text[at:]) - len(text[at:].lstrip())
        document, at = json.JSONDecoder().raw_decode(text, at)
        found.append(document)
    return found


def kinds(answers: list[dict[str, Any]]) -> list[list[str]]:
    """The names of the fields of each answer, in one case. Progress is left out: it comes by the clock."""
    return [sorted(name.replace("_", "").lower() for name in answer) for answer in answers if "progress" not in answer]


@unittest.skipUnless(BUF.exists(), "buf is not installed (scripts/setup.sh does)")
class CommandLines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        running = server(PATCHMILLD)
        cls.address = running.__enter__()
        cls.addClassCleanup(running.__exit__, None, None, None)

    def buf(self, words: list[str]) -> str:
        run = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def words(self, rpc) -> list[str]:
        return shlex.split(command(rpc).replace("127.0.0.1:50051", self.address))

    def test_each_answers_as_the_server_does(self):
        types = Types(FILES)
        for rpc in CONTRACT.rpcs:
            answers = call(self.address, types, rpc, (ROOT / f"docs/requests/{rpc.name}.json").read_text())
            if rpc.name == "ForgetModel":  # what it forgets must be there again
                upload = next(other for other in CONTRACT.rpcs if other.name == "UploadModel")
                call(self.address, types, upload, (ROOT / "docs/requests/UploadModel.json").read_text())
            self.assertEqual(kinds(documents(self.buf(self.words(rpc)))), kinds(answers), rpc.name)

    def test_the_schema_may_be_left_out(self):
        words = self.words(next(rpc for rpc in CONTRACT.rpcs if rpc.name == "ListPosts"))
        without = [word for word in words if word not in ("--schema", "proto")]
        self.assertEqual(len(without), len(words) - 2)
        self.assertEqual(self.buf(without), self.buf(words))


if __name__ == "__main__":
    unittest.main()

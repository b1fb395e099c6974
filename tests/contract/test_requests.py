"""Every RPC has a worked request, and a running server answers it as the contract says."""
import json
import re
import unittest
from typing import Any

from support import PATCHMILLD, ROOT  # before the modules of scripts: it makes them importable

from contract.calls import Types, call, refusal, server
from contract.descriptors import descriptor_set, read_contract

FILES = descriptor_set(ROOT / "proto")
CONTRACT = read_contract(FILES)
TYPES = Types(FILES)
REQUESTS = ROOT / "docs/requests"


def request(name: str) -> str:
    return (REQUESTS / f"{name}.json").read_text()


def all_values(value: Any, key: str) -> list[Any]:
    """The values of a key at any depth."""
    if isinstance(value, list):
        return [found for item in value for found in all_values(item, key)]
    if isinstance(value, dict):
        return [found for k, item in value.items() for found in ([item] if k == key else []) + all_values(item, key)]
    return []


class Requests(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        running = server(PATCHMILLD)
        cls.address = running.__enter__()
        cls.addClassCleanup(running.__exit__, None, None, None)
        cls.answers = {rpc.name: call(cls.address, TYPES, rpc, request(rpc.name)) for rpc in CONTRACT.rpcs}

    def answer(self, name: str) -> dict[str, Any]:
        self.assertEqual(len(self.answers[name]), 1)
        return self.answers[name][0]

    def test_each_is_answered(self):
        for name, answers in self.answers.items():
            self.assertTrue(answers and all(answers), name)
            self.assertNotIn("SEVERITY_ERROR", all_values(answers, "severity"), name)

    def test_streams_keep_the_order_of_their_comments(self):
        for rpc in CONTRACT.rpcs:
            order = re.search(r"Order of the stream:([^.]*)\.", rpc.comment)
            self.assertEqual(rpc.streams, order is not None, rpc.name)
            if order is not None:
                # "accepted, {progress | paths}*, report" becomes a regular expression.
                pattern = re.sub(r"[\s,]", "", order[1]).replace("{", "(?:").replace("}", ")")
                pattern = re.sub(r"\w+", lambda word: f"(?:{word[0]};)", pattern)
                events = "".join(f"{next(iter(answer))};" for answer in self.answers[rpc.name])
                self.assertRegex(events, f"^{pattern}$")

    def test_what_the_answers_say(self):
        report = self.answers["GenerateProgram"][-1]["report"]
        self.assertEqual(report["outcome"], "OUTCOME_COMPLETE_WHERE_REACHABLE")
        self.assertTrue(any("program" in answer for answer in self.answers["GenerateProgram"]))
        self.assertEqual(self.answers["VerifyProgram"][-1]["report"]["outcome"], "OUTCOME_COMPLETE")
        self.assertEqual(self.answer("CheckModel")["joined_edge_count"], 1)
        self.assertEqual(self.answer("ConvertModel")["model"]["patches"][0]["bezier"]["degree_u"], 3)
        self.assertEqual([bool(v["normals"]) for v in self.answer("BuildModel")["network_model"]["network"]["vertices"]], [True] * 4)
        self.assertEqual(self.answer("EditModel")["changed_faces"], [0, 1])
        self.assertTrue(self.answer("FairCurve")["settled"])
        self.assertTrue(self.answer("FairNet")["settled"])
        self.assertEqual([entry["tool_diameter_mm"] for entry in self.answer("TabulateReach")["entries"]], [2, 6, 20])
        self.assertEqual([(s["kind"], round(s["level"], 9)) for s in self.answer("TraceLines")["sets"]],
                         [("LINE_KIND_CONTOUR", 2), ("LINE_KIND_CONTOUR", 5), ("LINE_KIND_EQUI_SLOPE", 30)])
        # The middle of the dome: control points with the weights 1/8, 3/8, 3/8, 1/8 either way.
        self.assertAlmostEqual(self.answer("EvaluateSurface")["points_mm"][2], (12 * 36 + 8 * 3 * 3) / 64)
        # Both faces share the smooth edge between the pushed one and the one that reaches a goal.
        preview = self.answer("Preview")
        self.assertEqual(preview["changed_faces"], [0, 1])
        self.assertEqual([len(p["position_mm"]) for p in preview["patches"]], [3 * 5 * 5] * 2)
        self.assertIn("linuxcnc", [post["name"] for post in self.answer("ListPosts")["posts"]])

    def test_a_wrong_field_is_refused_with_its_path(self):
        generate = next(rpc for rpc in CONTRACT.rpcs if rpc.name == "GenerateProgram")
        wrong = json.loads(request("GenerateProgram"))
        wrong["job"]["operations"][0]["scallop_mm"] = 9
        error = refusal(self.address, TYPES, generate, json.dumps(wrong))
        self.assertEqual((error["code"], error["ErrorInfo"]["reason"]), ("INVALID_ARGUMENT", "INVALID_FIELDS"))
        self.assertEqual(error["ErrorInfo"]["field_violations"][0]["field"], "job.operations[0].scallop_mm")


class Missing(unittest.TestCase):
    def test_each_rpc_has_one_request(self):
        self.assertEqual({path.name for path in REQUESTS.iterdir()}, {f"{rpc.name}.json" for rpc in CONTRACT.rpcs})

    def test_a_field_that_the_contract_does_not_have(self):
        with self.assertRaisesRegex(Exception, "scalop_mm"):
            call("127.0.0.1:1", TYPES, CONTRACT.rpcs[0], '{"job": {"operations": [{"scalop_mm": 1}]}}')


if __name__ == "__main__":
    unittest.main()

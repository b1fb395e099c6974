"""The package against the contract: every field of a request can be set, whatever is added to it."""
import inspect
import re
import unittest

import numpy as np
import patchmill as pm
from patchmill import _call, _message, analysis, asking, messages, milling, modelling, uploading
from patchmill.v1 import fairing_pb2, job_pb2, operation_pb2, setup_pb2
from support import ROOT

# Functions for the methods of the contract.
FUNCTIONS = {
    "GenerateProgram": milling.mill, "VerifyProgram": milling.verify, "ListPosts": milling.posts, "SplitRegions": analysis.regions,
    "TabulateReach": analysis.reach, "TraceLines": analysis.lines, "EvaluateSurface": analysis.evaluate, "Preview": analysis.preview,
    "CheckModel": modelling.check,
    "ConvertModel": modelling.convert, "BuildModel": modelling.build, "EditModel": modelling.edit, "FairCurve": modelling.fair,
    "FairNet": modelling.fair_net, "UploadModel": uploading.upload, "ForgetModel": uploading.forget,
    "GetCapabilities": asking.capabilities,
}
# Fields whose arguments have other names.
ARGUMENTS = {
    "job": "operation", "source": "model", "sections": "outline", "boundary": "outline", "crossing": "outline",
    "surface": "outline", "mesh": "outline", "GenerateProgram.validate_only": "-",
    "ListPosts.post_file": "-",  # milling.check_post takes it
    "FairCurve.points": "curve", "FairCurve.file": "curve", "FairNet.points": "net", "FairNet.file": "net",
    "UploadModel.start": "model", "UploadModel.chunk": "-", "ForgetModel.model_sha256": "model",
}
# Fields of a job are arguments of their own.
JOB_ARGUMENTS = {"source": "model", "setup": "setup", "operations": "operation", "name": "name"}


def messages_below(descriptor, found):
    if descriptor.full_name not in found and descriptor.full_name.startswith("patchmill."):
        found[descriptor.full_name] = descriptor
        for field in descriptor.fields:
            if field.message_type is not None:
                messages_below(field.message_type, found)
    return found


class Contract(unittest.TestCase):
    def test_every_method_has_a_function_of_both_clients(self):
        files = (ROOT / "proto/patchmill/v1").glob("*.proto")
        stated = {name for file in files for name in re.findall(r"^ *rpc (\w+)", file.read_text(), re.MULTILINE)}
        self.assertEqual(stated, set(_call.RPCS))
        self.assertEqual(set(FUNCTIONS), set(_call.RPCS))
        for function in FUNCTIONS.values():
            for client in (pm.Client, pm.AsyncClient):
                method = getattr(client, function.__name__)
                self.assertEqual(list(inspect.signature(method).parameters)[1:], list(inspect.signature(function).parameters))
                self.assertEqual(method.__doc__, function.__doc__)

    def test_every_field_of_a_request_is_an_argument(self):
        for name, function in FUNCTIONS.items():
            arguments = inspect.signature(function).parameters
            for field in _call.RPCS[name].request.DESCRIPTOR.fields:
                argument = ARGUMENTS.get(f"{name}.{field.name}", ARGUMENTS.get(field.name, field.name))
                if argument != "-":
                    self.assertIn(argument, arguments, f"{name}.{field.name} cannot be set")
                if field.name == "job":
                    self.assertEqual({f.name for f in field.message_type.fields}, set(JOB_ARGUMENTS))
                    self.assertLessEqual(set(JOB_ARGUMENTS.values()), set(arguments))
        self.assertIn("validate_only=True", inspect.getsource(milling.resolve))

    def test_arguments_that_repeat_the_contract_have_its_defaults(self):
        for function in FUNCTIONS.values():
            for name, argument in inspect.signature(function).parameters.items():
                # The contract has no default for a unit; numpy's numbers have none either.
                if isinstance(argument.default, (bool, int, float)) and name != "length_unit":
                    self.assertFalse(argument.default, f"{function.__name__}({name}={argument.default!r}) is not the server's default")

    def test_every_message_below_a_request_is_a_dataclass_with_its_fields(self):
        seen = {}
        for method in _call.RPCS.values():
            for field in method.request.DESCRIPTOR.fields:
                if field.message_type is not None:
                    messages_below(field.message_type, seen)
        self.assertGreater(len(seen), 50)
        for name, descriptor in seen.items():
            cls = getattr(messages, descriptor.name)
            self.assertEqual([f.name for f in descriptor.fields], list(cls.__dataclass_fields__), name)
            for field in descriptor.fields:
                self.assertIn(f"{field.name}:", cls.__doc__)

    def test_what_is_not_set_is_not_sent(self):
        empty = _message.to_message(pm.Operation(), operation_pb2.Operation())
        self.assertEqual(empty.ByteSize(), 0)
        # A zero that differs from no value is sent.
        flat = _message.to_message(pm.Operation(zigzag_bend_deg=0.0), operation_pb2.Operation())
        self.assertTrue(flat.HasField("zigzag_bend_deg"))

    def test_messages_come_back_as_they_were(self):
        setup = pm.Setup(up=pm.UpAxis.NEG_Y, zero_anchor=pm.ZeroAnchor.TOP_CENTER, translation=pm.Point3(1, 2, 3),
                         stock=pm.Stock(allowance_mm=0.0, outline=pm.OutlineStock(outline_xy_mm=[[0, 0], [5, 0], [0, 5]])),
                         obstacles=[pm.Obstacle(id="vice", outline_xy_mm=np.eye(3, 2), top_z_mm=4)])
        sent = _message.to_message(setup, setup_pb2.Setup())
        back = _message.from_message(pm.Setup, sent)
        self.assertEqual(_message.to_message(back, setup_pb2.Setup()), sent)
        self.assertEqual(back.stock.outline.outline_xy_mm.shape, (3, 2))
        self.assertEqual((back.up, back.stock.allowance_mm, back.stock.top_z_mm), (pm.UpAxis.NEG_Y, 0.0, None))

    def test_values_of_a_newer_server_are_kept(self):
        post = _message.from_message(pm.Post, job_pb2.Post(unit=77))
        self.assertEqual((post.unit, post.unit.name), (77, "VALUE_77"))

    def test_a_misspelt_option_is_refused(self):
        with self.assertRaises(TypeError):
            pm.Operation(scalop_mm=1)
        with self.assertRaises(AttributeError):
            pm.Operation().scalop_mm = 1

    def test_options_print_what_is_set(self):
        self.assertEqual(repr(pm.Heights(floor_z_mm=-3.0)), "Heights(floor_z_mm=-3.0)")
        self.assertEqual(repr(pm.Selection(boundary_xy_mm=np.zeros((9, 2)), boundary_mode=pm.BoundaryMode.INSIDE)),
                         "Selection(boundary_xy_mm=<array 9 x 2>, boundary_mode=BoundaryMode.INSIDE)")


class WrongOptions(unittest.TestCase):
    def refused(self, option, message, field, part):
        with self.assertRaises(pm.OptionError) as caught:
            _message.to_message(option, message, "job")
        self.assertEqual(caught.exception.field, field)
        self.assertIn(part, str(caught.exception))

    def test_two_of_a_choice(self):
        self.refused(pm.Setup(stock=pm.Stock(block=pm.BlockStock(), cylinder=pm.CylinderStock(diameter_mm=3))), setup_pb2.Setup(),
                     "job.stock", "block and cylinder")

    def test_a_wrong_type(self):
        self.refused(pm.Operation(scallop_mm="0.01"), operation_pb2.Operation(), "job.scallop_mm", "'0.01'; it must be a number")
        self.refused(pm.Operation(detail=[1]), operation_pb2.Operation(), "job.detail", "it must be a number")
        self.refused(pm.Operation(tool=6), operation_pb2.Operation(), "job.tool", "is of the type int; it must be patchmill.Tool")
        self.refused(pm.Setup(up="Z"), setup_pb2.Setup(), "job.up", "= 'Z'; it must be patchmill.UpAxis.Z, or Y, X, NEG_Z,")
        self.refused(pm.Operation(contour_spirals=1), operation_pb2.Operation(), "job.contour_spirals", "True or False")
        self.refused(pm.Selection(patch_ids="f12"), operation_pb2.Selection(), "job.patch_ids", "it must be a list")
        self.refused(pm.Post(program_number=1.5), job_pb2.Post(), "job.program_number", "a whole number")

    def test_a_wrong_shape(self):
        self.refused(pm.Selection(boundary_xy_mm=np.zeros((4, 3))), operation_pb2.Selection(), "job.boundary_xy_mm", "(4, 3)")
        self.refused(pm.CurvePoints(points_mm=[1.0, 2.0]), fairing_pb2.CurvePoints(), "job.points_mm", "3 numbers for each point")
        self.refused(pm.CurvePoints(points_mm=["a"]), fairing_pb2.CurvePoints(), "job.points_mm", "array of numbers")

    def test_a_number_out_of_the_type(self):
        self.refused(pm.Post(program_number=2**40), job_pb2.Post(), "job.program_number", "cannot be used")


if __name__ == "__main__":
    unittest.main()

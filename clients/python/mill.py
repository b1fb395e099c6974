#!/usr/bin/python3
"""A small client of the Patchmill service: sends a model, shows progress, writes the verified program.

usage: mill.py HOST:PORT MODEL PROGRAM [--up y] [--scale 50] [--scallop 0.02] [--tool-diameter 6]

Needs python3-grpcio, python3-protobuf, protobuf-compiler and protobuf-compiler-grpc (Debian); the stubs are
generated from the contract at every start, so they can never be out of date.
"""
import argparse
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import grpc

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEXT_FORMATS = {".bpt", ".bv", ".bez", ".patches"}  # known by their ending; the server distinguishes JSON and protobuf by content


def generate_stubs(folder):
    """Generates the Python code of proto/patchmill/v1 into `folder` and makes it importable."""
    plugin = shutil.which("grpc_python_plugin")
    if plugin is None:
        raise SystemExit("mill.py: grpc_python_plugin is missing (Debian: protobuf-compiler-grpc)")
    protos = sorted(str(p) for p in (ROOT / "proto/patchmill/v1").glob("*.proto"))
    subprocess.run(
        ["protoc", "-I", str(ROOT / "proto"), f"--python_out={folder}", f"--grpc_python_out={folder}",
         f"--plugin=protoc-gen-grpc_python={plugin}", *protos], check=True)
    sys.path.insert(0, folder)


def make_request(args):
    from patchmill.v1 import operation_pb2, setup_pb2, tool_pb2, toolpath_service_pb2

    ups = {"z": setup_pb2.UP_AXIS_Z, "y": setup_pb2.UP_AXIS_Y, "x": setup_pb2.UP_AXIS_X}
    request = toolpath_service_pb2.GenerateProgramRequest()
    job = request.job
    ending = pathlib.Path(args.model).suffix.lower()
    job.source.file.content = pathlib.Path(args.model).read_bytes()
    job.source.file.format = ending[1:] if ending in TEXT_FORMATS else ""
    job.name = pathlib.Path(args.model).name
    job.setup.up = ups[args.up]
    job.setup.scale = args.scale
    job.operations.append(operation_pb2.Operation(
        scallop_mm=args.scallop,
        tolerance_mm=0.01,
        tool=tool_pb2.Tool(
            number=1, ball_end=tool_pb2.BallEnd(diameter_mm=args.tool_diameter),
            # No defaults on the wire: these are this example's, and it says so.
            spindle_rpm=12000, feed_mm_per_min=1200, plunge_feed_mm_per_min=400, cutting_data_is_default=True)))
    return request


def mill(channel, request):
    """Returns (program bytes, report); raises grpc.RpcError."""
    from patchmill.v1 import toolpath_service_pb2_grpc

    program, report = bytearray(), None
    for event in toolpath_service_pb2_grpc.ToolpathServiceStub(channel).GenerateProgram(request):
        kind = event.WhichOneof("event")
        if kind == "progress":
            print(f"{event.progress.stage} {100 * event.progress.fraction:.0f} %", file=sys.stderr)
        elif kind == "program":
            program += event.program.data
        elif kind == "report":
            report = event.report
    if report is None:
        raise SystemExit("mill.py: the stream ended without a report: void, whatever was read")
    if hashlib.sha256(program).digest() != report.program_sha256 and report.program_size_bytes > 0:
        raise SystemExit("mill.py: the program did not arrive whole")
    return bytes(program), report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("server")
    parser.add_argument("model")
    parser.add_argument("program")
    parser.add_argument("--up", choices=["x", "y", "z"], default="z")
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--scallop", type=float, default=0.02)
    parser.add_argument("--tool-diameter", type=float, default=6.0)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as stubs:
        generate_stubs(stubs)
        from patchmill.v1 import report_pb2

        size = 64 << 20  # gRPC's own default of 4 MB is too small for large models
        options = [("grpc.max_send_message_length", size), ("grpc.max_receive_message_length", size)]
        with grpc.insecure_channel(args.server, options=options) as channel:
            try:
                program, report = mill(channel, make_request(args))
            except grpc.RpcError as error:
                raise SystemExit(f"mill.py: {error.code().name}: {error.details()}")
        print(f"{report_pb2.Outcome.Name(report.outcome)}: gouge {report.max_gouge_mm:.4f} mm, "
              f"leftover {report.max_leftover_mm:.4f} mm, not reached {report.unreachable_area_mm2:.1f} mm2")
        if not program:
            raise SystemExit(1)
        temporary = args.program + ".part"
        pathlib.Path(temporary).write_bytes(program)
        os.replace(temporary, args.program)


if __name__ == "__main__":
    main()

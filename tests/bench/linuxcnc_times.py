#!/usr/bin/env python3
"""The time that Patchmill states for five short programs, beside the time that LinuxCNC's trajectory planner takes.

usage: linuxcnc_times.py PATCHMILL MACHINE [--limit PERCENT] [--only NAME] [--keep FOLDER]
       from the root of the repository

PATCHMILL is the program, MACHINE a machine file such as docs/machine.json. LinuxCNC 2.9 runs without a display and
without a real-time kernel, on a machine of the same travel, speeds and accelerations. Each program takes as long there
as on a machine: four minutes in all. Debian's package is linuxcnc-uspace (scripts/setup.sh installs it).

LinuxCNC's own sampler records every period of the servo thread, a millisecond. The time is the number of periods from
the first that moves, after the tool stands over the part, to the last before the spindle stops. A busy computer does
not change it. Patchmill's time has the same ends; so that the motion begins at rest, a pause (G4) is put before it.
LinuxCNC has no limit for the feed of an axis, so the programs keep below those of MACHINE.

--limit PERCENT  the exit status is 1 if a difference is more than that
--only NAME      one of the programs: contours, zigzag, chords, rapids, retracts
--keep FOLDER    leave the programs, reports, samples and the configuration of LinuxCNC there

LinuxCNC refuses to run as root. Under root it runs as the user `nobody`.
"""
import argparse
import json
import math
import os
import pathlib
import pwd
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAMS = [
    ("contours", "tests/models/sphere.bv --scale 10 --scallop 0.3 --strategy contour --feed 1200"),
    ("zigzag", "examples/two_hills.bv --scale 0.3 --scallop 0.3 --strategy zigzag --feed 2400"),
    ("chords", "tests/models/saddle.patches --scale 10 --scallop 0.05 --no-arcs --feed 2400"),
    ("rapids", "examples/two_hills.bv --scale 0.5 --scallop 0.5 --strategy zigzag --one-way --high-rapids --feed 2400"),
    ("retracts", "tests/models/icosahedron.patches --scale 10 --scallop 0.3 --one-way --feed 1200"),
]
COMMON = "--tool-diameter 6 --allowance 0.5 --spindle 8000 --quiet"
PERIOD = 1e-3  # s, of the servo thread
PAUSE = "G4 P0.5"
SYSTEM_PYTHON = "/usr/bin/python3"  # the one that has the module `linuxcnc`

HAL = """\
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
loadrt sampler depth=30000 cfg=bsf
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net z joint.2.motor-pos-cmd => joint.2.motor-pos-fb
net stop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared
net change iocontrol.0.tool-change => iocontrol.0.tool-changed
setp spindle.0.at-speed 1
setp sampler.0.enable 0
net at-rest motion.in-position => sampler.0.pin.0
net line motion.program-line => sampler.0.pin.1
net speed motion.current-vel => sampler.0.pin.2
"""

INI = """\
[EMC]
VERSION = 1.1
MACHINE = {name}
[DISPLAY]
DISPLAY = {folder}/display
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = {folder}/parameters.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.010
TOOL_TABLE = {folder}/tools.tbl
[HAL]
HALFILE = {folder}/machine.hal
[KINS]
KINEMATICS = trivkins coordinates=XYZ
JOINTS = 3
[TRAJ]
COORDINATES = X Y Z
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = {speed}
DEFAULT_LINEAR_VELOCITY = {speed}
MAX_LINEAR_ACCELERATION = {acceleration}
DEFAULT_LINEAR_ACCELERATION = {acceleration}
"""

LIMITS = """\
MIN_LIMIT = {least}
MAX_LIMIT = {most}
MAX_VELOCITY = {speed}
MAX_ACCELERATION = {acceleration}
"""

# No switches: an axis is at home where it stands when the machine is switched on.
JOINT = """\
TYPE = LINEAR
FERROR = 10
MIN_FERROR = 10
HOME = {most}
HOME_OFFSET = {most}
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
"""


def write_configuration(machine: dict, folder: pathlib.Path) -> None:
    axes = machine["axes"]
    # The limits along the path are those of all axes together, so that only the axes limit it.
    text = INI.format(
        name=machine.get("name", "machine"),
        folder=folder,
        speed=math.hypot(*(axis["rapid_mm_per_min"] / 60.0 for axis in axes)),
        acceleration=math.hypot(*(axis["acceleration_mm_per_s2"] for axis in axes)),
    )
    for k, axis in enumerate(axes):
        values = {
            "least": axis["travel_min_mm"],
            "most": axis["travel_max_mm"],
            "speed": axis["rapid_mm_per_min"] / 60.0,
            "acceleration": axis["acceleration_mm_per_s2"],
        }
        text += f"[AXIS_{'XYZ'[k]}]\n" + LIMITS.format(**values)
        text += f"[JOINT_{k}]\n" + LIMITS.format(**values) + JOINT.format(**values)
    (folder / "machine.ini").write_text(text)
    (folder / "machine.hal").write_text(HAL)
    (folder / "tools.tbl").write_text("T1 P1 Z0 D6\n")
    (folder / "parameters.var").write_text("")
    shutil.copy(__file__, folder / "driver.py")
    display = folder / "display"
    run = f"{SYSTEM_PYTHON} {folder}/driver.py --drive {folder}"
    display.write_text(f"#!/bin/sh\nexec {run} > {folder}/driver.log 2>&1\n")
    for name in ("driver.py", "display"):
        (folder / name).chmod(0o755)


def make_program(binary: str, machine: pathlib.Path, name: str, words: str, folder: pathlib.Path) -> dict:
    """Writes NAME.ngc, with the pause, and returns its time, its first line of motion and the line after the last."""
    program, report = folder / f"{name}.ngc", folder / f"{name}.json"
    command = [binary, "mill", *words.split(), *COMMON.split(), "--machine", machine, "-o", program, "--report", report]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"linuxcnc_times: {name}: patchmill mill failed\n{done.stdout}{done.stderr}")
    lines = program.read_text().splitlines()
    over = next(i for i, line in enumerate(lines) if line.startswith("G43")) + 3
    end = next(i for i, line in enumerate(lines) if line.startswith("M9"))
    if not (lines[over - 2].startswith("G0 X") and lines[over - 1].startswith("Z")):
        sys.exit(f"linuxcnc_times: {name}: the program does not begin as the post linuxcnc has it")
    lines.insert(over, PAUSE)
    program.write_text("\n".join(lines) + "\n")
    figures = json.loads(report.read_text())
    if figures["time_basis"] != "accelerations":
        sys.exit(f"linuxcnc_times: {name}: the report's time has no accelerations")
    # Line numbers count from 1; the pause has the number over + 1.
    return {"name": name, "time": figures["estimated_time_s"], "blocks": figures["feed_block_count"],
            "first": over + 2, "after": end + 2}


def run_linuxcnc(folder: pathlib.Path, limit: float) -> None:
    settings = {"env": {**os.environ, "HOME": str(folder), "DISPLAY": ""}, "cwd": folder}
    if os.geteuid() == 0:
        nobody = pwd.getpwnam("nobody")
        for place in (folder, *folder.iterdir()):
            os.chown(place, nobody.pw_uid, nobody.pw_gid)
        settings |= {"user": nobody.pw_uid, "group": nobody.pw_gid, "extra_groups": []}
    with (folder / "linuxcnc.log").open("w") as log:
        # -r leaves its messages on the standard output.
        running = subprocess.Popen(["linuxcnc", "-r", folder / "machine.ini"], stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=log, start_new_session=True, **settings)
        try:
            running.wait(limit)
        except subprocess.TimeoutExpired:
            os.killpg(running.pid, signal.SIGTERM)  # LinuxCNC then unloads what it has loaded
            running.wait(60)


def measured(folder: pathlib.Path, program: dict) -> float:
    """Seconds from the first servo period that moves to the last one, from the samples of LinuxCNC."""
    samples = folder / f"{program['name']}.samples"
    first = last = before = None
    if samples.exists():
        for sample in samples.read_text().splitlines():
            if sample.strip() == "overrun":  # it begins so, because the count goes on from program to program
                continue
            number, at_rest, line = (int(word) for word in sample.split()[:3])
            if before is not None and number != before + 1:
                sys.exit(f"linuxcnc_times: {program['name']}: samples are lost, the computer is too busy")
            before = number
            if not at_rest and program["first"] <= line < program["after"]:
                first = number if first is None else first
                last = number
    if first is None:
        logs = "".join(f"--- {log.name}\n{log.read_text()}" for log in folder.glob("*.log"))
        sys.exit(f"linuxcnc_times: {program['name']} did not run in LinuxCNC\n{logs}")
    return (last - first + 1) * PERIOD


def drive(folder: pathlib.Path) -> None:
    """The display of LinuxCNC: switches the machine on and runs the programs one after the other."""
    import linuxcnc  # only Debian's Python has it

    command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()

    def do(what, *arguments) -> None:
        what(*arguments)
        if command.wait_complete(30) not in (linuxcnc.RCS_DONE, -1):
            report_errors()
            raise SystemExit(f"LinuxCNC refuses {what.__name__}{arguments}")

    def report_errors() -> bool:
        message = errors.poll()
        if message:
            print(message, flush=True)
        return message is not None and message[0] in (linuxcnc.OPERATOR_ERROR, linuxcnc.NML_ERROR)

    def until(condition, seconds: float) -> None:
        end = time.monotonic() + seconds
        while not condition():
            status.poll()
            if report_errors() or time.monotonic() > end:
                raise SystemExit("LinuxCNC does not get there")
            time.sleep(0.01)

    time.sleep(1.0)
    do(command.state, linuxcnc.STATE_ESTOP_RESET)
    do(command.state, linuxcnc.STATE_ON)
    do(command.home, -1)
    until(lambda: status.homed[:3] == (1, 1, 1), 10.0)
    jobs = json.loads((folder / "jobs.json").read_text())
    do(command.mode, linuxcnc.MODE_MDI)
    # The program zero is in the middle of the travel.
    do(command.mdi, "G10 L2 P1 " + " ".join(f"{axis}{value}" for axis, value in jobs["zero"].items()))
    do(command.mode, linuxcnc.MODE_AUTO)
    for name in jobs["names"]:
        do(command.program_open, str(folder / f"{name}.ngc"))
        with (folder / f"{name}.samples").open("w") as samples:
            sampler = subprocess.Popen(["halsampler", "-t"], stdout=samples)
            subprocess.run(["halcmd", "setp", "sampler.0.enable", "1"], check=True)
            command.auto(linuxcnc.AUTO_RUN, 0)
            until(lambda: status.interp_state != linuxcnc.INTERP_IDLE, 10.0)
            until(lambda: status.interp_state == linuxcnc.INTERP_IDLE, 600.0)
            subprocess.run(["halcmd", "setp", "sampler.0.enable", "0"], check=True)
            time.sleep(0.5)
            sampler.terminate()
            sampler.wait()
        print(f"{name} done", flush=True)


def main() -> None:
    if sys.argv[1:2] == ["--drive"]:
        drive(pathlib.Path(sys.argv[2]))
        return
    if len(sys.argv) < 3 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].removeprefix("usage: "), add_help=False)
    parser.add_argument("patchmill")
    parser.add_argument("machine", type=pathlib.Path)
    parser.add_argument("--limit", type=float)
    parser.add_argument("--only", choices=[name for name, _ in PROGRAMS])
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    if not all(shutil.which(program) for program in ("linuxcnc", "halsampler", "milltask")):
        sys.exit("linuxcnc_times: LinuxCNC is missing: apt-get install linuxcnc-uspace")
    if subprocess.run([SYSTEM_PYTHON, "-c", "import linuxcnc"], capture_output=True, check=False).returncode != 0:
        sys.exit(f"linuxcnc_times: {SYSTEM_PYTHON} has no module linuxcnc: apt-get install linuxcnc-uspace")
    if pathlib.Path("/tmp/linuxcnc.lock").exists():
        sys.exit("linuxcnc_times: LinuxCNC is running already, or has left /tmp/linuxcnc.lock")
    try:
        machine = json.loads(options.machine.read_text())
    except (OSError, ValueError) as error:
        sys.exit(f"linuxcnc_times: {options.machine}: {error}")
    with tempfile.TemporaryDirectory(prefix="linuxcnc_times.") as temporary:
        folder = pathlib.Path(temporary)
        programs = [
            make_program(options.patchmill, options.machine, name, words, folder)
            for name, words in PROGRAMS if options.only in (None, name)
        ]
        middle = {letter: 0.5 * (axis["travel_min_mm"] + axis["travel_max_mm"])
                  for letter, axis in zip("XYZ", machine["axes"])}
        jobs = {"names": [program["name"] for program in programs], "zero": middle}
        (folder / "jobs.json").write_text(json.dumps(jobs))
        write_configuration(machine, folder)
        run_linuxcnc(folder, limit=60.0 + sum(30.0 + 3.0 * program["time"] for program in programs))
        if options.keep:
            shutil.copytree(folder, options.keep, dirs_exist_ok=True)
        print("| program | feed blocks | Patchmill, s | LinuxCNC, s | difference |")
        print("|---|---|---|---|---|")
        worst = 0.0
        for program in programs:
            seconds = measured(folder, program)
            percent = 100.0 * (program["time"] / seconds - 1.0)
            worst = max(worst, abs(percent))
            times = f"{program['time']:.2f} | {seconds:.2f} | {percent:+.1f} %"
            print(f"| {program['name']} | {program['blocks']} | {times} |")
    print(f"linuxcnc_times: at most {worst:.1f} % between the times")
    if options.limit is not None and worst > options.limit:
        sys.exit(1)


if __name__ == "__main__":
    main()

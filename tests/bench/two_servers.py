#!/usr/bin/python3
"""Jobs a second of one server and of two behind nginx, one thread each: two_servers.py BIN [--jobs N]

All jobs are different. As many callers meet the one server as the other: nginx chooses by caller. Needs two
cores that nothing else uses; clients and nginx take a part of them.
"""
import argparse
import concurrent.futures
import os
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
CALLERS, CLIENTS = 40, 8


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=120)
    options = parser.parse_args()
    os.environ["PATCHMILL_BIN"] = str(options.bin)
    sys.path.insert(0, str(ROOT / "tests/operations"))
    import grpc
    from fleet import Fleet
    from support import Folder, call, worked_request

    def token(caller):
        return f"token-of-caller-{caller:04}"

    def request(number):
        made = worked_request("GenerateProgram")[0]
        made.job.operations[0].scallop_mm = 0.01 + 1e-6 * number
        made.job.operations[0].tolerance_mm = 0.01
        return [made]

    def rate(count, first):
        """Jobs a second of so many servers."""
        with Folder() as folder:
            tokens = folder.write("tokens.conf", "".join(f"[c{k}]\ntoken = text:{token(k)}\n" for k in range(CALLERS)))
            with Fleet(folder.path, tokens, "--threads", "1", "--max-jobs", "1", "--max-queue", "64") as fleet:
                fleet.know([fleet.start() for _ in range(count)])
                credentials = grpc.ssl_channel_credentials(pathlib.Path(fleet.ca).read_bytes())
                with grpc.secure_channel(fleet.address, credentials) as channel:
                    for caller in range(CALLERS):
                        assert call(channel, "GetCapabilities", token=token(caller)).code == "OK"
                    of = [[k for k in range(CALLERS) if f"caller=c{k} " in server.log()] for server in fleet.servers]
                    share = min(len(callers) for callers in of)
                    spread = [callers[k] for k in range(share) for callers in of]

                    def job(k):
                        answer = call(channel, "GenerateProgram", request(first + k), token=token(spread[k % len(spread)]), timeout=300)
                        assert answer.code == "OK" and answer.events[-1].HasField("report"), answer.message

                    with concurrent.futures.ThreadPoolExecutor(CLIENTS) as pool:
                        begin = time.monotonic()
                        list(pool.map(job, range(options.jobs)))
                        return options.jobs / (time.monotonic() - begin)

    one, two = rate(1, 0), rate(2, options.jobs)
    print(f"two_servers: one {one:.2f} jobs/s, two {two:.2f} jobs/s: {two / one:.2f} times")


if __name__ == "__main__":
    main()

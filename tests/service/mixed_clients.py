#!/usr/bin/python3
"""64 clients of one server, with the worked requests of docs/requests in random order, for some minutes.

usage: mixed_clients.py PATCHMILLD [--minutes N] [--clients N] [--seed N]

Every call must end well; a server that is busy says when to come again, and its client does. The median memory of the
last minute is at most 5 % above that of the third. The 50th and 99th percentiles of each call's time are printed.
"""
import argparse
import json
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import grpc
from google.protobuf import json_format

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from contract.calls import Types, documents_in  # noqa: E402
from contract.descriptors import descriptor_set, read_contract  # noqa: E402

FILES = descriptor_set(ROOT / "proto")
CONTRACT, TYPES = read_contract(FILES), Types(FILES)


def messages(rpc, rng):
    """The worked request, with a name or a number of its own where the answer would be kept otherwise."""
    documents = documents_in((ROOT / f"docs/requests/{rpc.name}.json").read_text())
    if rpc.name == "GenerateProgram" and rng.random() < 0.8:
        documents[0]["job"]["name"] = f"part {rng.randrange(10**9)}"
    return [json_format.Parse(json.dumps(d), TYPES.of(rpc.request)(), descriptor_pool=TYPES.pool) for d in documents]


class Client(threading.Thread):
    def __init__(self, address, seed, end, took, failures):
        super().__init__()
        self.rng, self.end, self.took, self.failures = random.Random(seed), end, took, failures
        self.channel = grpc.insecure_channel(address, options=[("grpc.use_local_subchannel_pool", 1)])

    def call(self, rpc):
        sent = messages(rpc, self.rng)
        write = type(sent[0]).SerializeToString
        path, read = f"/{rpc.path}", TYPES.of(rpc.response).FromString
        if rpc.uploads:
            return self.channel.stream_unary(path, write, read)(iter(sent), timeout=120)
        if rpc.streams:
            return list(self.channel.unary_stream(path, write, read)(sent[0], timeout=120))
        return self.channel.unary_unary(path, write, read)(sent[0], timeout=120)

    def run(self):
        while time.monotonic() < self.end:
            rpc = self.rng.choice(CONTRACT.rpcs)
            begin = time.monotonic()
            for _ in range(60):
                try:
                    self.call(rpc)
                    self.took.setdefault(rpc.name, []).append(time.monotonic() - begin)
                    break
                except grpc.RpcError as error:
                    wait = dict(error.trailing_metadata() or ()).get("grpc-retry-pushback-ms")
                    if wait is None:
                        self.failures.append(f"{rpc.name}: {error.code().name} {error.details()}")
                        break
                    time.sleep(int(wait) / 1000 * self.rng.uniform(0.5, 1.5))
            else:
                self.failures.append(f"{rpc.name}: busy for too long")
            time.sleep(self.rng.uniform(0, 0.5))


def memory_mib(pid):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--clients", type=int, default=64)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    with tempfile.NamedTemporaryFile("r") as log:
        with open(log.name, "w") as errors:
            # A store that is full before the third minute: what it still has to fill is no leak.
            server = subprocess.Popen([asked.program, "--listen", "127.0.0.1:0", "--store-mib", "32"], stderr=errors)
        port = None
        while port is None and server.poll() is None:
            time.sleep(0.02)
            port = re.search(r"port (\d+)\n", pathlib.Path(log.name).read_text())
        took, failures, begin = {}, [], time.monotonic()
        end = begin + 60 * asked.minutes
        clients = [Client(f"127.0.0.1:{port[1]}", asked.seed * 1000 + k, end, took, failures) for k in range(asked.clients)]
        for client in clients:
            client.start()
        memory = []
        while time.monotonic() < end and server.poll() is None:
            memory.append(((time.monotonic() - begin) / 60, memory_mib(server.pid)))
            time.sleep(0.5)
        for client in clients:
            client.join()
        alive = server.poll() is None
        server.terminate()
        status = server.wait(timeout=30)
    for name, seconds in sorted(took.items()):
        seconds.sort()
        p50, p99 = seconds[len(seconds) // 2], seconds[int(0.99 * (len(seconds) - 1))]
        print(f"{name:18} {len(seconds):6} calls, median {1000 * p50:8.1f} ms, p99 {1000 * p99:8.1f} ms")
    third = [m for t, m in memory if 2 <= t < 3] or [m for _, m in memory]
    last = [m for t, m in memory if t >= asked.minutes - 1]
    growth = statistics.median(last) / statistics.median(third) - 1
    for failure in failures[:20]:
        print("failed:", failure)
    calls = sum(map(len, took.values()))
    print(f"mixed_clients: {asked.clients} clients, {calls} calls, {len(failures)} failures, memory "
          f"{statistics.median(third):.0f} MiB in the third minute, {100 * growth:+.1f} % in the last one")
    return 0 if alive and status == 0 and not failures and growth <= 0.05 and len(took) == len(CONTRACT.rpcs) else 1


if __name__ == "__main__":
    sys.exit(main())

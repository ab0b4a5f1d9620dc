"""What the server does under load, as a table beside the goals. Starts servers of its own.

    /usr/bin/python3 tests/load/load.py [--seconds 60] [--sockets 5000] [--only NAME]

Clients and server share the machine, so what the clients need is missing to the server; the load
of the machine before each part is in the table.
"""

import argparse
import asyncio
import base64
import collections
import json
import os
import pathlib
import resource
import shutil
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))

from conftest import Server  # noqa: E402
from event_reader import EventReader  # noqa: E402
from websocket_client import WebSocketClient  # noqa: E402
from workload import ENDLESS_JOB, STEADY_JOB, YARD, submit  # noqa: E402

HOST = "127.0.0.1"
TICKS = os.sysconf("SC_CLK_TCK")


def resident_mb(server):
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) / 1000 for line in status if line.startswith("VmRSS:"))


def processor_seconds(server):
    """By the name of the thread; the network thread is the main one."""
    used = collections.Counter()
    for task in pathlib.Path(f"/proc/{server.process.pid}/task").iterdir():
        text = (task / "stat").read_text()
        name = text[text.index("(") + 1:text.rindex(")")]
        fields = text[text.rindex(")") + 2:].split()
        used["network" if name == "modelsynthd" else name] += (
            int(fields[11]) + int(fields[12])) / TICKS
    return used


async def ask(reader, writer, head, body=b""):
    """One request on a connection that is kept; status and body."""
    writer.write(head + body)
    lines = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").lower().split("\r\n")
    length = next((int(line[15:]) for line in lines if line.startswith("content-length:")), 0)
    return int(lines[0].split(" ")[1]), await reader.readexactly(length)


# --- parts; each gives rows of (what, figure, goal)

async def open_socket(port):
    reader, writer = await asyncio.open_connection(HOST, port)
    key = base64.b64encode(os.urandom(16)).decode()
    writer.write((f"GET /v1/stream HTTP/1.1\r\nHost: {HOST}\r\nConnection: Upgrade\r\n"
                  "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                  f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Protocol: modelsynth.v1\r\n\r\n"
                  ).encode())
    head = await reader.readuntil(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 101"), head
    return writer


async def hold_sockets(server, count):
    before = resident_mb(server)
    writers = []
    for start in range(0, count, 200):
        writers += await asyncio.gather(
            *(open_socket(server.port) for _ in range(min(200, count - start))))
    await asyncio.sleep(1)
    after = resident_mb(server)
    reader, writer = await asyncio.open_connection(HOST, server.port)
    status, _ = await ask(reader, writer, b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
    assert status == 200
    for each in [*writers, writer]:
        each.transport.abort()
    return before, after


def idle_sockets(make, options):
    server = make("--connections-max", options.sockets + 100)
    before, after = asyncio.run(hold_sockets(server, options.sockets))
    return [(f"memory with {options.sockets} idle WebSockets", f"{after:.0f} MB", "150 MB"),
            ("one of them", f"{(after - before) * 1000 / options.sockets:.1f} kB", "")]


# A tenth of a second of solving, some ten milliseconds, some, and of those a few.
SMALL_JOBS = {"houses, 24x8x24 m": {"solver": "continuous", "example": "houses",
                                    "parameters": {"size": [24, 8, 24]}},
              "castle, 100x10x100": {"example": "castle", "parameters": {"size": [100, 10, 100]}},
              "castle, 40x10x40": {"example": "castle", "parameters": {"size": [40, 10, 40]}},
              "a yard of 6 pieces, 30x6x30": {"example": YARD, "parameters": {
                  "size": [30, 6, 30], "weights": "uniform"}}}


async def submit_all_the_time(port, until, number, job, statuses):
    body = json.dumps({"solver": "discrete", "seed": number, **job}).encode()
    head = (b"POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
            b"Prefer: wait=60\r\nContent-Length: %d\r\n\r\n" % len(body))
    reader, writer = await asyncio.open_connection(HOST, port)
    while time.monotonic() < until:
        status, answer = await ask(reader, writer, head, body)
        done = status == 200 and b'"state":"succeeded"' in answer
        statuses[status if not done else "succeeded"] += 1
    writer.close()


def small_jobs(make, options):
    return [row for name, job in SMALL_JOBS.items()
            for row in jobs_of_64_clients(make(), name, job, options.seconds)]


def jobs_of_64_clients(server, name, job, seconds):
    async def run():
        statuses = collections.Counter()
        until = time.monotonic() + seconds
        await asyncio.gather(*(submit_all_the_time(server.port, until, number, job, statuses)
                               for number in range(64)))
        return statuses

    before = processor_seconds(server)
    begun = time.monotonic()
    statuses = asyncio.run(run())
    taken = time.monotonic() - begun
    used = processor_seconds(server) - before
    total = sum(used.values())
    others = sum(count for status, count in statuses.items() if status != "succeeded")
    parts = ", ".join(f"{name} {100 * share / total:.0f} %" for name, share in used.most_common())
    server.kill()
    return [(f"64 clients, {name}, {taken:.0f} s: errors", str(others), "0"),
            ("solved, each kept on disk", f"{statuses['succeeded'] / taken:.0f} / s", ""),
            ("the server's processor time", f"{total / taken:.2f} cores: {parts}", "worker first")]


async def time_gets(port, path, seconds):
    reader, writer = await asyncio.open_connection(HOST, port)
    head = f"GET {path} HTTP/1.1\r\nHost: x\r\n\r\n".encode()
    taken = []
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        begun = time.perf_counter()
        status, _ = await ask(reader, writer, head)
        taken.append(time.perf_counter() - begun)
        assert status == 200
        await asyncio.sleep(0.005)
    writer.close()
    return sorted(taken)


def gets_while_solving(make, options):
    # One more, since a worker is kept from large jobs.
    server = make(workers=os.cpu_count() + 1)
    jobs = [submit(server, ENDLESS_JOB) for _ in range(os.cpu_count())]
    for job in jobs:
        with EventReader(server.port, job["id"]) as reader:
            reader.until_event(lambda event: event["type"] == "block")
    async def run():
        return await asyncio.gather(*(time_gets(server.port, path, options.seconds / 3) for path in
                                      (f"/v1/jobs/{jobs[0]['id']}", "/healthz")))

    (median, worst), (_, floor) = ([taken[int(len(taken) * share)] * 1000 for share in (0.5, 0.99)]
                                   for taken in asyncio.run(run()))
    return [("GET of a job while all processors solve: median", f"{median:.1f} ms", ""),
            ("99th of 100", f"{worst:.1f} ms", "10 ms"),
            ("99th of 100 of /healthz, which does nothing", f"{floor:.1f} ms", "")]


def one_who_reads(server, stuck):
    """Seconds until a reader has all events of a job, with so many beside it who read none."""
    job = submit(server, STEADY_JOB)
    clients = [WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream?partial=labels",
                               receive_buffer=4096) for _ in range(stuck)]
    begun = time.monotonic()
    with EventReader(server.port, job["id"]) as reader:
        events = reader.rest()
    taken = time.monotonic() - begun
    for client in clients:
        client.abort()
    return len(events) / taken


def who_never_reads(make, _options):
    server = make(workers=1)
    rates = {0: [], 1: []}
    for _ in range(7):
        for stuck in rates:
            rates[stuck].append(one_who_reads(server, stuck))
    alone, beside = (statistics.median(rates[stuck]) for stuck in (0, 1))
    return [("events / s to a subscriber that is alone", f"{alone:.0f}", ""),
            ("the same beside one that never reads", f"{beside:.0f} ({100 * beside / alone:.0f} %)",
             "the same")]


PARTS = {"sockets": idle_sockets, "jobs": small_jobs, "gets": gets_while_solving,
         "never": who_never_reads}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--sockets", type=int, default=5000)
    parser.add_argument("--only", choices=PARTS)
    options = parser.parse_args()
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-load-"))
    print("| what | figure | goal | load of the machine before |\n|---|---|---|---|", flush=True)
    try:
        for name, part in PARTS.items():
            if options.only not in (None, name):
                continue
            server = None

            def make(*given, workers=2, name=name):
                nonlocal server
                server = Server(directory / name, *given, workers=workers).start()
                return server

            load = os.getloadavg()[0]
            try:
                for what, figure, goal in part(make, options):
                    print(f"| {what} | {figure} | {goal} | {load:.1f} |", flush=True)
            finally:
                server.kill()
    finally:
        shutil.rmtree(directory)


if __name__ == "__main__":
    main()

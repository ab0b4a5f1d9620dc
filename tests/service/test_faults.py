"""What happens to machines: a full disk, too few descriptors, a stopped process, a clock that jumps,
clients that vanish. Afterwards everything acknowledged is there and ends as it would have."""

import contextlib
import datetime
import os
import pathlib
import resource
import signal
import socket
import struct
import subprocess
import tempfile

import pytest

from checks import compact, wait_until
from conftest import Server
from event_reader import EventReader, texts
from raw_http import Wire
from websocket_client import TEXT, WebSocketClient
from workload import ENDLESS_JOB, SMALL_JOB, STEADY_JOB, YARD, submit

FAKETIME = pathlib.Path("/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1")
MIB = 1 << 20


@pytest.fixture(scope="module")
def undisturbed(server):
    """The SHA-256 of STEADY_JOB's model."""
    return server.wait(submit(server, STEADY_JOB)["id"])["result"]["sha256"]


def check_ended(server, job, sha256):
    done = server.wait(job["id"])
    assert done["state"] == "succeeded", done["error"]
    assert done["result"]["sha256"] == sha256
    events = server.events(job["id"])
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert [event["type"] for event in events].count("succeeded") == 1
    blocks = [event["index"] for event in events if event["type"] == "block"]
    assert blocks == list(range(len(blocks)))
    return events


# --- a full disk

@contextlib.contextmanager
def small_disk(mebibytes):
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-test-"))
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={mebibytes}m", "none", directory],
        capture_output=True, text=True, check=False)
    if mounted.returncode != 0:
        directory.rmdir()
        pytest.skip(f"no disk of its own can be mounted: {mounted.stderr.strip()}")
    try:
        yield directory
    finally:
        subprocess.run(["umount", "-l", directory], check=False)
        directory.rmdir()


def fill(directory):
    with open(directory / "fill", "wb", buffering=0) as file:
        with contextlib.suppress(OSError):
            while True:
                file.write(b"x" * MIB)
        with contextlib.suppress(OSError):
            while True:
                file.write(b"x" * 512)


@contextlib.contextmanager
def server_on(disk):
    server = Server(disk / "data", "--disk-free-min", MIB).start()
    try:
        yield server
    finally:
        server.kill()


def test_a_full_disk_refuses_work_and_loses_none(undisturbed):
    with small_disk(64) as disk, server_on(disk) as server:
        done = server.wait(submit(server, SMALL_JOB)["id"])
        running = submit(server, STEADY_JOB)
        with EventReader(server.port, running["id"]) as reader:
            seen = reader.until_event(lambda event: event["type"] == "block")
        fill(disk)
        wait_until(lambda: server.get("/readyz").status == 503)
        answer = server.request("POST", "/v1/examples", YARD)
        assert answer.status == 503 and "retry-after" in answer.headers
        # A key is not used up by what could not be written.
        body = {"solver": "discrete", "example": YARD, "seed": 3,
                "parameters": {"size": [30, 6, 30], "weights": "uniform"}}
        key = {"Idempotency-Key": "once"}
        refused = wait_until(lambda: answer if (answer := server.request(
            "POST", "/v1/jobs", body, key)).status != 202 else None)
        assert refused.status == 503 and "retry-after" in refused.headers
        # What is there can be read.
        assert server.get("/healthz").status == 200
        assert server.get(f"/v1/jobs/{done['id']}").json() == done
        assert server.get(f"/v1/jobs/{done['id']}/model.glb").status == 200
        (disk / "fill").unlink()
        wait_until(lambda: server.get("/readyz").status == 200)
        again = server.request("POST", "/v1/jobs", body, key)
        assert again.status == 202
        assert server.wait(again.json()["id"])["state"] == "succeeded"
        events = check_ended(server, running, undisturbed)
        assert events[:len(seen)] == [dict(event) for event in seen]
        assert server.stop() == 0


def test_a_server_on_a_full_disk_can_be_stopped_and_killed(undisturbed):
    with small_disk(64) as disk, server_on(disk) as server:
        job = submit(server, STEADY_JOB)
        with EventReader(server.port, job["id"]) as reader:
            reader.until_event(lambda event: event["type"] == "block")
        fill(disk)
        wait_until(lambda: server.get("/readyz").status == 503)
        assert server.stop() == 0
        (disk / "fill").unlink()
        server.start()
        check_ended(server, job, undisturbed)


# --- descriptors

def descriptors(server):
    return list(pathlib.Path(f"/proc/{server.process.pid}/fd").iterdir())


def sockets(server):
    count = 0
    for each in descriptors(server):
        with contextlib.suppress(FileNotFoundError):  # closed meanwhile
            count += os.readlink(each).startswith("socket:")
    return count


def test_64_descriptors_are_enough_when_connections_want_more(make_server, undisturbed):
    server = make_server()
    resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE, (64, 64))
    job = submit(server, STEADY_JOB)
    wires = [Wire(server) for _ in range(100)]
    try:
        wait_until(lambda: len(descriptors(server)) == 64)
        for wire in wires[:20]:
            answer = wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n").answer()
            assert answer.status == 200
    finally:
        for wire in wires:
            wire.socket.close()
    wait_until(lambda: sockets(server) < 10)
    check_ended(server, job, undisturbed)
    assert server.stop() == 0


# --- time

def test_a_server_that_is_stopped_for_a_while_goes_on(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(lambda event: event.get("fraction", 0) > 0.2)
        server.process.send_signal(signal.SIGSTOP)
        # Longer than anything of it waits for on its own.
        with Wire(server) as wire:
            wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
            wire.socket.settimeout(1.5)
            with pytest.raises(TimeoutError):
                wire.answer()
            server.process.send_signal(signal.SIGCONT)
            wire.socket.settimeout(10)
            assert wire.answer().status == 200
        seen += reader.rest()
    events = check_ended(server, job, undisturbed)
    assert texts(seen) and [event["seq"] for event in events] == [each["seq"] for each in seen]


@pytest.mark.skipif(not FAKETIME.exists(), reason="faketime is not installed")
@pytest.mark.skipif("MODELSYNTH_SANITIZED" in os.environ,
                    reason="a sanitizer wants to be loaded first")
@pytest.mark.parametrize("jump", ["-3600", "+3600"])
def test_a_clock_that_jumps_by_an_hour_changes_no_job(make_server, undisturbed, monkeypatch,
                                                      tmp_path, jump):
    clock = tmp_path / "clock"
    clock.write_text("+0\n")
    for name, value in {"LD_PRELOAD": str(FAKETIME), "FAKETIME_TIMESTAMP_FILE": str(clock),
                        "FAKETIME_NO_CACHE": "1", "FAKETIME_DONT_FAKE_MONOTONIC": "1"}.items():
        monkeypatch.setenv(name, value)
    server = make_server(workers=1)
    monkeypatch.delenv("LD_PRELOAD")
    running = submit(server, STEADY_JOB, deadline=600)
    waiting = submit(server, SMALL_JOB)
    with EventReader(server.port, running["id"]) as reader:
        reader.until_event(lambda event: event.get("fraction", 0) > 0.2)
        clock.write_text(jump + "\n")
    later = submit(server, SMALL_JOB)
    moved = stamp(later["created"]) - stamp(waiting["created"])
    assert abs(moved - int(jump)) < 600, "the clock did not jump"
    check_ended(server, running, undisturbed)
    for job in (waiting, later):
        assert server.wait(job["id"])["state"] == "succeeded"
    ids = [job["id"] for job in server.get("/v1/jobs").json()["items"]]
    assert sorted(ids) == sorted([running["id"], waiting["id"], later["id"]])


def stamp(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()


# --- clients

def vanish(sock):
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    sock.close()


def test_clients_that_vanish_in_the_middle_of_anything_leave_nothing_behind(make_server):
    server = make_server()
    done = server.wait(submit(server, STEADY_JOB)["id"])
    job = submit(server, ENDLESS_JOB)
    with EventReader(server.port, job["id"]) as reader:
        reader.until_event(lambda event: event["type"] == "block")
    before = sockets(server)
    body = compact(YARD)
    upload = (b"POST /v1/examples HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
              b"Content-Length: %d\r\n\r\n" % len(body))
    get = "GET {} HTTP/1.1\r\nHost: x\r\n\r\n"
    halves = [
        upload + body[:50], upload, upload[:40],
        get.format(f"/v1/jobs/{done['id']}/model.glb").encode() * 3,
        get.format(f"/v1/jobs/{done['id']}/events").encode(),
        get.format(f"/v1/jobs/{job['id']}/events").encode(),
        get.format(f"/v1/jobs/{job['id']}?wait=30").encode(),
    ]
    for _ in range(5):
        wires = [Wire(server).send(half) for half in halves]
        streams = [WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream?partial=labels")
                   for _ in range(3)] + [WebSocketClient(server.port, "/v1/stream")]
        for client in streams:
            client.send(TEXT, b"{" * 100, length=200)  # half a frame
        for each in wires + streams:
            vanish(each.socket)
    wait_until(lambda: sockets(server) <= before)
    assert server.get(f"/v1/jobs/{job['id']}").json()["state"] == "running"
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")
    assert server.wait(job["id"])["state"] == "cancelled"
    assert server.stop() == 0

"""Clients that stop reading, on every carrier: what they lose they are told of, and the server
keeps nothing for them."""

import json
import os
import pathlib
import shutil
import tempfile
import time

import pytest

from checks import check_events
from conftest import Server
from event_reader import EventReader
from test_multi_stream import SharedStream, events_of, is_end
from test_websocket import connect
from websocket_client import LabelGrid, StateFrame
from workload import STEADY_JOB, submit

# More events than the kernel's buffers hold.
LONG_LOG_JOB = {**STEADY_JOB, "parameters": {
    **STEADY_JOB["parameters"], "blocks": {"size": [10, 6, 10], "overlap": 0.5, "passes": 16}}}

LAG_SECONDS = 2.5  # without reading; long enough to count as slow


def read_sse(reader):
    with reader:
        return reader.rest()


def read_socket(client):
    with client:
        messages = client.messages()
    assert messages[-1].close_code == 1000
    return [message for message in messages if isinstance(message, dict)]


def read_shared(client, job):
    with client:
        return events_of(client.until(is_end), job)


def resident_mib(server, field="VmRSS"):
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith(field + ":"))


@pytest.fixture(scope="module")
def lagged():
    """What fifty clients get who read nothing until some time after the job's end, of each carrier;
    the log; what the server's memory grew by for them, in MiB."""
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-test-"))
    server = Server(directory / "data", workers=1).start()
    try:
        server.wait(submit(server, LONG_LOG_JOB)["id"])
        alone = resident_mib(server, "VmHWM")
        job = submit(server, LONG_LOG_JOB)
        sse = [EventReader(server.port, job["id"], receive_buffer=4096) for _ in range(17)]
        sockets = [connect(server, job, receive_buffer=4096) for _ in range(17)]
        shared = [SharedStream(server, receive_buffer=4096) for _ in range(16)]
        for client in shared:
            client.ask(type="subscribe", job=job["id"])
        with_frames = SharedStream(server, receive_buffer=4096)
        with_frames.ask(type="subscribe", job=job["id"], partial="labels")
        # Who reads is not held up by them.
        with EventReader(server.port, job["id"]) as reader:
            log = reader.rest()
        time.sleep(LAG_SECONDS)
        grown = max(resident_mib(server, "VmHWM") - alone, 0)
        yield {
            "log": log, "grown": grown,
            "sse": [read_sse(reader) for reader in sse],
            "socket": [read_socket(client) for client in sockets],
            "shared": [read_shared(client, job) for client in shared],
            "with frames": with_frames.until(is_end),
            "labels": server.get(f"/v1/jobs/{job['id']}/labels.json").json()["cells"],
        }
        with_frames.abort()
    finally:
        server.kill()
        shutil.rmtree(directory, ignore_errors=True)


@pytest.mark.parametrize("carrier", ["sse", "socket", "shared"])
def test_a_client_that_stops_reading_misses_nothing_it_is_not_told_of(lagged, carrier):
    for events in lagged[carrier]:
        check_events(events, lagged["log"])


@pytest.mark.parametrize("carrier", ["sse", "socket", "shared"])
def test_it_loses_events_in_between_and_gets_one_snapshot(lagged, carrier):
    for events in lagged[carrier]:
        assert [event["type"] for event in events].count("snapshot") == 1
        assert len(events) < len(lagged["log"])


def test_nothing_changes_for_a_client_that_reads(lagged):
    log = lagged["log"]
    assert len(log) > 5000
    assert [event["seq"] for event in log] == list(range(1, len(log) + 1))
    assert "snapshot" not in [event["type"] for event in log]


@pytest.mark.skipif("MODELSYNTH_SANITIZED" in os.environ,
                    reason="a sanitizer holds back what was freed")
def test_fifty_such_clients_need_little_memory(lagged):
    text = sum(len(json.dumps(event)) for event in lagged["log"]) / 2**20
    assert 50 * text > 60, "all of it for each of them would not be noticed"
    assert lagged["grown"] < 30


def test_one_that_wants_frames_gets_a_whole_state_after_its_snapshot(lagged):
    messages = lagged["with frames"]
    kinds = [message["type"] if isinstance(message, dict) else "frame" for message in messages]
    at = kinds.index("snapshot")
    first = messages[at + 1 + kinds[at + 1:].index("frame")]
    assert first.is_whole and first.seq >= messages[at]["seq"]
    grid = LabelGrid(LONG_LOG_JOB["size"])
    for message in messages[at:]:
        if isinstance(message, StateFrame):
            grid.apply(message)
    assert grid.cells == lagged["labels"]


def test_who_takes_nothing_for_too_long_is_closed_with_1013(make_server):
    server = make_server("--write-seconds", "1")
    job = server.wait(submit(server, LONG_LOG_JOB)["id"])
    of_one = connect(server, job, receive_buffer=4096)
    of_many = SharedStream(server, receive_buffer=4096)
    of_many.ask(type="subscribe", job=job["id"])
    by_sse = EventReader(server.port, job["id"], receive_buffer=4096)
    time.sleep(2.5)
    with of_one, of_many, by_sse:
        assert of_one.close_code() == 1013
        assert of_many.close_code() == 1013
        # An event stream can only end, without a proper end.
        assert by_sse.rest_before_crash()[-1]["type"] == "block"
        assert not by_sse.ended
    assert server.get("/healthz").status == 200

"""What breaks the silence of streams that have nothing to tell."""

import socket

import pytest

from conftest import Server
from event_reader import EventReader
from test_multi_stream import SharedStream
from test_websocket import connect
from websocket_client import PING, PONG, ConnectionLost
from workload import ENDLESS_JOB, SMALL_JOB, submit

IDLE_SECONDS = 4


@pytest.fixture(scope="module")
def silent(tmp_path_factory):
    """A server that keeps silence for a short time only, and a job that waits."""
    server = Server(tmp_path_factory.mktemp("heartbeats") / "data",
                    "--stream-idle-seconds", IDLE_SECONDS, workers=1).start()
    try:
        submit(server, ENDLESS_JOB, priority=10)
        yield server, submit(server, SMALL_JOB)
    finally:
        server.kill()


def test_an_event_stream_has_a_comment_now_and_then(silent):
    server, job = silent
    with EventReader(server.port, job["id"]) as reader:
        assert reader.next()["type"] == "queued"
        while b"\n\n" not in reader.text:
            reader._more_text()
        assert reader.text.startswith(b":")


def test_a_websocket_is_pinged_and_closed_when_that_is_not_answered(silent):
    server, job = silent
    # All at once: the test is as long as the silence.
    answering, mute = connect(server, job), connect(server, job)
    shared, mute_shared = SharedStream(server), SharedStream(server)
    answering.message()
    mute.message()
    for client in (answering, mute, shared, mute_shared):
        assert client.receive().opcode == PING
    for client in (mute, mute_shared):
        with client, pytest.raises(ConnectionLost):
            for client_still in (answering, shared):
                client_still.send(PONG)
            while True:
                assert client.receive(timeout=2 * IDLE_SECONDS).opcode == PING
    for client in (answering, shared):
        with client:
            client.send(PING, b"still open")
            while (frame := client.receive()).opcode != PONG:
                client.send(PONG, frame.payload)
            assert frame.payload == b"still open"

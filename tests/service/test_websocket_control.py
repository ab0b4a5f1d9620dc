"""What a client of a job's WebSocket may send: control frames, and what breaks the rules."""

import pathlib
import shutil
import struct
import tempfile

import pytest

from conftest import Server
from test_websocket import connect
from websocket_client import BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT
from workload import ENDLESS_JOB, SMALL_JOB, STEADY_JOB, submit

# --- control frames


@pytest.fixture(scope="module")
def quiet():
    """A server of its own, busy with long jobs, and a job that waits behind them, so that its
    streams are silent."""
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-test-"))
    busy = Server(directory / "data", workers=1).start()
    try:
        for _ in range(8):
            submit(busy, ENDLESS_JOB)
        yield busy, submit(busy, SMALL_JOB, priority=-10)
    finally:
        busy.kill()
        shutil.rmtree(directory, ignore_errors=True)


def connect_quiet(quiet):
    """A client who has read all there is for now."""
    client = connect(*quiet)
    assert client.message().opcode == TEXT
    return client


def test_a_ping_is_answered_with_its_payload(quiet):
    with connect_quiet(quiet) as client:
        for payload in (b"", b"hello", b"x" * 125):
            client.send(PING, payload)
            answer = client.receive()
            assert (answer.opcode, answer.payload) == (PONG, payload)


def test_a_ping_is_answered_while_events_pour_in(server):
    job = submit(server, STEADY_JOB)
    with connect(server, job) as client:
        client.message()
        client.send(PING, b"still there?")
        while (frame := client.receive()).opcode != PONG:
            assert frame.opcode == TEXT
        assert frame.payload == b"still there?"
        assert client.messages()[-1].close_code == 1000


def test_a_pong_nobody_asked_for_is_ignored(quiet):
    with connect_quiet(quiet) as client:
        client.send(PONG, b"unasked")
        client.send(PING, b"after")
        assert client.receive().payload == b"after"


@pytest.mark.parametrize("code", [1000, 1001, 3000, 4999])
def test_a_client_that_closes_is_answered_with_its_code(quiet, code):
    with connect_quiet(quiet) as client:
        client.send(CLOSE, struct.pack(">H", code) + b"bye")
        assert client.close_code() == code
        assert client.ended()


def test_a_client_that_closes_without_a_code_is_answered(quiet):
    with connect_quiet(quiet) as client:
        client.send(CLOSE)
        frame = client.receive()
        assert frame.opcode == CLOSE
        assert client.ended()


# --- clients that break the rules

_BAD_FRAMES = {
    "an unmasked text": lambda client: client.send(TEXT, b"{}", masked=False),
    "an unmasked ping": lambda client: client.send(PING, b"x", masked=False),
    "an unmasked close": lambda client: client.send(CLOSE, b"\x03\xe8", masked=False),
    "a reserved data opcode": lambda client: client.send(3, b"x"),
    "another reserved data opcode": lambda client: client.send(7, b"x"),
    "a reserved control opcode": lambda client: client.send(11, b"x"),
    "the last reserved opcode": lambda client: client.send(15, b"x"),
    "the first reserved bit": lambda client: client.send(TEXT, b"x", reserved=4),
    "the second reserved bit": lambda client: client.send(PING, b"x", reserved=2),
    "the third reserved bit": lambda client: client.send(TEXT, b"x", reserved=1),
    "a ping in fragments": lambda client: client.send(PING, b"x", fin=False),
    "a close in fragments": lambda client: client.send(CLOSE, b"\x03\xe8", fin=False),
    "an oversized ping": lambda client: client.send(PING, b"x" * 126),
    "an oversized close": lambda client: client.send(CLOSE, b"\x03\xe8" + b"x" * 124),
    "a ping that claims 64 KiB": lambda client: client.send(PING, b"x" * 65536),
    "a continuation of nothing": lambda client: client.send(CONTINUATION, b"x"),
    "a text within a text": lambda client: (
        client.send(TEXT, b"x", fin=False), client.send(TEXT, b"y")),
    "a close with half a code": lambda client: client.send(CLOSE, b"\x03"),
    "a length beyond 63 bits": lambda client: client.send(BINARY, b"x", length=(1 << 64) - 1),
    "a length in more bytes than needed": lambda client: client.send_raw(
        b"\x82\xfe\x00\x02\x00\x00\x00\x00ab"),
    "noise": lambda client: client.send_raw(bytes(range(255, 0, -1))),
    **{f"close code {code}": lambda client, code=code: client.send(
        CLOSE, struct.pack(">H", code)) for code in (0, 999, 1004, 1005, 1006, 1015, 1016, 2999)},
}


@pytest.mark.parametrize("name", _BAD_FRAMES)
def test_a_bad_frame_closes_the_connection_and_nothing_else(quiet, name):
    with connect_quiet(quiet) as witness, connect_quiet(quiet) as client:
        _BAD_FRAMES[name](client)
        assert client.close_code() in (None, 1002, 1007, 1008, 1009)
        assert client.ended()
        witness.send(PING, b"alive")
        assert witness.receive().payload == b"alive"
    assert quiet[0].get("/healthz").status == 200


@pytest.mark.parametrize("code", [5000, 65535])
def test_a_close_code_out_of_all_ranges_closes_the_connection_all_the_same(quiet, code):
    with connect_quiet(quiet) as client:
        client.send(CLOSE, struct.pack(">H", code))
        assert client.close_code() in (None, 1002, code)
        assert client.ended()
    assert quiet[0].get("/healthz").status == 200


@pytest.mark.parametrize("send", [
    lambda client: client.send(TEXT, b"{}"), lambda client: client.send(TEXT, b""),
    lambda client: client.send(BINARY, b"\0" * 16), lambda client: client.send(BINARY, b"x" * 4096),
    lambda client: (client.send(TEXT, b"ab", fin=False), client.send(CONTINUATION, b"cd"))],
    ids=["text", "empty text", "binary", "4 KiB", "fragments"])
def test_a_data_message_from_the_client_is_closed_with_1008(quiet, send):
    with connect_quiet(quiet) as client:
        send(client)
        assert client.close_code() == 1008
        assert client.ended()


@pytest.mark.parametrize("send", [
    lambda client: client.send(TEXT, b"x" * 4097), lambda client: client.send(BINARY, b"x" * 60000),
    lambda client: client.send(BINARY, b"x" * 16, length=1 << 40),
    lambda client: (client.send(TEXT, b"x" * 3000, fin=False),
                    client.send(CONTINUATION, b"x" * 3000))],
    ids=["4097 bytes", "60000 bytes", "a terabyte announced", "in fragments"])
def test_a_message_over_4_kib_is_closed_with_1009(quiet, send):
    with connect_quiet(quiet) as client:
        send(client)
        assert client.close_code() == 1009
        assert client.ended()


def test_a_data_message_is_closed_with_1008_while_events_pour_in(server):
    job = submit(server, ENDLESS_JOB)
    with connect(server, job, partial="labels") as client:
        client.message()
        client.send(TEXT, b"faster please")
        assert client.close_code() == 1008
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")

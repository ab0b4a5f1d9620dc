"""RFC 6455 frame by frame, in the case families of the Autobahn test suite, on GET /v1/stream:
there each text is answered, so a message that came whole is told from one that did not."""

import json
import struct

import pytest

from test_multi_stream import SharedStream
from websocket_client import (
    BINARY, CLOSE, CONTINUATION, PING, PONG, TEXT, ConnectionLost, HandshakeRefused,
    WebSocketClient)


@pytest.fixture
def client(server):
    with SharedStream(server) as client:
        yield client


@pytest.fixture(autouse=True)
def still_answering(server):
    yield
    assert server.get("/healthz", timeout=10).status == 200


def padded(size, number=7):
    """A request of just so many bytes that is refused by that number."""
    text = b'{"id": %d}' % number
    return text + b" " * (size - len(text)) if size >= len(text) else b" " * size


def assert_answered(client, number=7):
    message = client.next()
    assert message["type"] == "refusal" and message["id"] == number, message


def assert_alive(client):
    client.send(PING, b"alive")
    frame = client.receive()
    assert (frame.opcode, frame.payload) == (PONG, b"alive")


def assert_closed(client, *codes):
    assert client.close_code() in codes
    assert client.ended()


def raw_frame(opcode, payload=b"", fin=True, reserved=0):
    """A masked frame as bytes; the mask changes nothing."""
    assert len(payload) < 126
    return bytes([(0x80 if fin else 0) | reserved << 4 | opcode, 0x80 | len(payload)]) + \
        b"\0\0\0\0" + payload


# --- 1: framing

@pytest.mark.parametrize("size", [0, 1, 9, 125, 126, 127, 128, 4095, 4096])
def test_a_text_of_any_length_up_to_the_limit_is_answered(client, size):
    client.send(TEXT, padded(size))
    assert_answered(client, 7 if size >= 9 else None)
    assert_alive(client)


@pytest.mark.parametrize("size", [4097, 65535, 65536, 65537])
def test_a_text_over_the_limit_is_closed_with_1009(client, size):
    client.send(TEXT, padded(size))
    assert_closed(client, 1009)


@pytest.mark.parametrize("length", [1 << 16, 1 << 32, (1 << 63) - 1])
def test_a_length_that_is_only_announced_is_closed_with_1009(client, length):
    client.send(TEXT, b"x", length=length)
    assert_closed(client, 1009)


@pytest.mark.parametrize("size", [0, 125, 126, 4096])
def test_a_binary_message_of_any_length_is_closed_with_1003(client, size):
    client.send(BINARY, b"\xfe" * size)
    assert_closed(client, 1003)


@pytest.mark.parametrize("head", [
    b"\x81\xfe\x00\x00", b"\x81\xfe\x00\x7d", b"\x81\xff" + b"\0" * 7 + b"\x7e",
    b"\x81\xff\0\0\0\0\0\0\xff\xff"],
    ids=["0 in 16 bits", "125 in 16 bits", "126 in 64 bits", "65535 in 64 bits"])
def test_a_length_in_a_form_that_is_not_allowed_is_closed_with_1002(client, head):
    client.send_raw(head + b"\0\0\0\0" + b"x" * 130)
    assert_closed(client, 1002)


@pytest.mark.parametrize("length", [1 << 63, (1 << 64) - 1])
def test_a_length_beyond_63_bits_is_closed(client, length):
    client.send(TEXT, b"x", length=length)
    assert_closed(client, 1002, 1009)


@pytest.mark.parametrize("piece", [1, 2, 5, 13, 1000])
def test_a_frame_may_come_in_pieces_of_any_size(client, piece):
    data = raw_frame(TEXT, padded(60)) + raw_frame(PING, b"behind it")
    for start in range(0, len(data), piece):
        client.send_raw(data[start:start + piece])
    answer, pong = sorted((client.receive() for _ in range(2)), key=lambda frame: frame.opcode)
    assert json.loads(answer.payload)["id"] == 7
    assert (pong.opcode, pong.payload) == (PONG, b"behind it")


# --- 2: pings and pongs

@pytest.mark.parametrize("payload", [
    b"", b"Hello", b"\x00\xff\xfe\xfd\xfc\xfb\x00\xff", b"\xfe" * 125], ids=[
        "empty", "text", "bytes", "125 bytes"])
def test_a_ping_is_answered_with_the_same_bytes(client, payload):
    client.send(PING, payload)
    frame = client.receive()
    assert (frame.opcode, frame.payload) == (PONG, payload)


def test_pings_at_once_are_answered_no_more_often_than_sent_and_the_last_of_them(client):
    """RFC 6455, section 5.5.3: a pong may stand for the pings before it."""
    client.send_raw(b"".join(raw_frame(PING, b"%d" % number) for number in range(10)))
    answers = []
    while not answers or answers[-1] != b"9":
        frame = client.receive()
        assert frame.opcode == PONG
        answers.append(frame.payload)
    assert answers == sorted(set(answers)) and len(answers) <= 10


@pytest.mark.parametrize("payload", [b"", b"unasked", b"x" * 125], ids=["empty", "text", "125"])
def test_a_pong_that_nobody_asked_for_has_no_effect(client, payload):
    client.send(PONG, payload)
    assert_alive(client)


@pytest.mark.parametrize("opcode", [PING, PONG, CLOSE], ids=["ping", "pong", "close"])
@pytest.mark.parametrize("size", [126, 127, 4096, 65536])
def test_a_control_frame_over_125_bytes_is_closed_with_1002(client, opcode, size):
    client.send(opcode, b"\x03\xe8" + b"x" * (size - 2))
    assert_closed(client, 1002)


# --- 3: reserved bits

@pytest.mark.parametrize("opcode", [TEXT, BINARY, PING, PONG, CLOSE],
                         ids=["text", "binary", "ping", "pong", "close"])
@pytest.mark.parametrize("reserved", range(1, 8))
def test_a_reserved_bit_is_closed_with_1002(client, opcode, reserved):
    client.send(opcode, b"\x03\xe8", reserved=reserved)
    assert_closed(client, 1002)


@pytest.mark.parametrize("reserved", [1, 2, 4])
def test_a_reserved_bit_on_a_continuation_is_closed_with_1002(client, reserved):
    client.send(TEXT, b"{", fin=False)
    client.send(CONTINUATION, b"}", reserved=reserved)
    assert_closed(client, 1002)


# --- 4: opcodes

@pytest.mark.parametrize("payload", [b"", b"reserved"], ids=["empty", "full"])
@pytest.mark.parametrize("opcode", [3, 4, 5, 6, 7, 11, 12, 13, 14, 15])
def test_a_reserved_opcode_is_closed_with_1002(client, opcode, payload):
    client.send(TEXT, padded(20))
    assert_answered(client)
    client.send(opcode, payload)
    assert_closed(client, 1002)


# --- 5: fragments

def send_fragments(client, text, cuts, between=lambda: None):
    pieces = [text[a:b] for a, b in zip([0, *cuts], [*cuts, len(text)])]
    for index, piece in enumerate(pieces):
        client.send(CONTINUATION if index else TEXT, piece, fin=index == len(pieces) - 1)
        between()


@pytest.mark.parametrize("cuts", [[5], [0], [20], [0, 0, 0], [1, 2, 3, 4], list(range(1, 20))],
                         ids=["two", "an empty first", "an empty last", "three empty ones",
                              "five", "one byte each"])
def test_fragments_are_one_message(client, cuts):
    send_fragments(client, padded(20), cuts)
    assert_answered(client)
    assert_alive(client)


@pytest.mark.parametrize("cuts", [[5], [3, 6, 9], list(range(1, 20))], ids=["two", "four", "20"])
def test_control_frames_between_fragments_are_answered_at_once(client, cuts):
    pings = []

    def ping():
        payload = b"%d" % len(pings)
        pings.append(payload)
        client.send_raw(raw_frame(PONG, b"unasked") + raw_frame(PING, payload))

    text = padded(20)
    pieces = [text[a:b] for a, b in zip([0, *cuts], [*cuts, len(text)])]
    for index, piece in enumerate(pieces):
        client.send(CONTINUATION if index else TEXT, piece, fin=index == len(pieces) - 1)
        if index < len(pieces) - 1:
            ping()
            frame = client.receive()
            assert (frame.opcode, frame.payload) == (PONG, pings[-1])
    assert_answered(client)


def test_a_close_between_fragments_closes(client):
    client.send(TEXT, b"{", fin=False)
    client.send(CLOSE, b"\x03\xe8")
    assert_closed(client, 1000)


@pytest.mark.parametrize("opcode", [PING, PONG, CLOSE], ids=["ping", "pong", "close"])
def test_a_control_frame_in_fragments_is_closed_with_1002(client, opcode):
    client.send(opcode, b"", fin=False)
    client.send(CONTINUATION, b"")
    assert_closed(client, 1002)


@pytest.mark.parametrize("fin", [True, False], ids=["last", "not last"])
@pytest.mark.parametrize("before", [False, True], ids=["at first", "after a message"])
def test_a_continuation_of_nothing_is_closed_with_1002(client, fin, before):
    if before:
        send_fragments(client, padded(20), [5])
        assert_answered(client)
    client.send(CONTINUATION, b"x", fin=fin)
    assert_closed(client, 1002)


@pytest.mark.parametrize("opcode", [TEXT, BINARY], ids=["text", "binary"])
def test_a_message_within_a_message_is_closed_with_1002(client, opcode):
    client.send(TEXT, b"{", fin=False)
    client.send(opcode, b"}")
    assert_closed(client, 1002)


@pytest.mark.parametrize("sizes", [[4096, 1], [1] * 4 + [4093], [2048, 2048, 1]], ids=str)
def test_fragments_over_the_limit_together_are_closed_with_1009(client, sizes):
    for index, size in enumerate(sizes):
        client.send(CONTINUATION if index else TEXT, b" " * size, fin=index == len(sizes) - 1)
    assert_closed(client, 1009)


def test_fragments_up_to_the_limit_are_answered(client):
    send_fragments(client, padded(4096), [1000, 2000, 4095])
    assert_answered(client)


def test_fragments_without_end_hold_nothing_up(client):
    """Empty ones count for nothing, so the limit does not end them."""
    client.send(TEXT, b"", fin=False)
    client.send_raw(raw_frame(CONTINUATION, b"", fin=False) * 20_000)
    client.send(CONTINUATION, padded(20))
    assert_answered(client)


# --- 6: UTF-8

VALID = {
    "one, two, three and four bytes": "a\u00e9\u20ac\U0001d11e".encode(),
    "greek": "\u03ba\u1f79\u03c3\u03bc\u03b5".encode(),
    "NUL": b"\0",
    "first of two bytes": b"\xc2\x80", "last of two bytes": b"\xdf\xbf",
    "first of three bytes": b"\xe0\xa0\x80", "last of three bytes": b"\xef\xbf\xbf",
    "first of four bytes": b"\xf0\x90\x80\x80", "last of four bytes": b"\xf4\x8f\xbf\xbf",
    "before the surrogates": b"\xed\x9f\xbf", "behind the surrogates": b"\xee\x80\x80",
    "replacement character": b"\xef\xbf\xbd",
    "noncharacter U+FFFE": b"\xef\xbf\xbe", "noncharacter U+1FFFE": b"\xf0\x9f\xbf\xbe",
    "byte order mark": b"\xef\xbb\xbf",
}

INVALID = {
    "a continuation alone": b"\x80", "the last continuation alone": b"\xbf",
    "six continuations": b"\x80\xbf\x80\xbf\x80\xbf",
    "a first byte alone": b"\xc2 ", "all first bytes of two": bytes(range(0xC0, 0xE0)),
    "a first byte of three alone": b"\xe0 ", "a first byte of four alone": b"\xf0 ",
    "two of three bytes": b"\xe2\x82 ", "three of four bytes": b"\xf0\x9f\x98 ",
    "five bytes": b"\xf8\x88\x80\x80\x80", "six bytes": b"\xfc\x84\x80\x80\x80\x80",
    "fe": b"\xfe", "ff": b"\xff", "fe fe ff ff": b"\xfe\xfe\xff\xff",
    "slash in two bytes": b"\xc0\xaf", "slash in three bytes": b"\xe0\x80\xaf",
    "slash in four bytes": b"\xf0\x80\x80\xaf", "NUL in two bytes": b"\xc0\x80",
    "overlong end of two": b"\xc1\xbf", "overlong end of three": b"\xe0\x9f\xbf",
    "overlong end of four": b"\xf0\x8f\xbf\xbf",
    "first high surrogate": b"\xed\xa0\x80", "last high surrogate": b"\xed\xaf\xbf",
    "first low surrogate": b"\xed\xb0\x80", "last low surrogate": b"\xed\xbf\xbf",
    "a pair of surrogates": b"\xed\xa0\x80\xed\xb0\x80",
    "beyond U+10FFFF": b"\xf4\x90\x80\x80", "f5": b"\xf5\x80\x80\x80",
    "text, then a surrogate": "\u03ba\u1f79\u03c3\u03bc\u03b5".encode() + b"\xed\xa0\x80edited",
}


@pytest.mark.parametrize("name", VALID)
def test_valid_utf_8_is_read(client, name):
    client.send(TEXT, VALID[name])
    assert client.next()["error"]["type"] == "/problems/malformed-json"
    assert_alive(client)


@pytest.mark.parametrize("name", VALID)
def test_valid_utf_8_may_be_cut_within_a_character(client, name):
    send_fragments(client, VALID[name], list(range(1, len(VALID[name]))))
    assert client.next()["error"]["type"] == "/problems/malformed-json"
    assert_alive(client)


@pytest.mark.parametrize("name", INVALID)
def test_invalid_utf_8_is_closed_with_1007(client, name):
    client.send(TEXT, INVALID[name])
    assert_closed(client, 1007)


@pytest.mark.parametrize("name", INVALID)
def test_invalid_utf_8_in_fragments_is_closed_with_1007(client, name):
    text = b"abc" + INVALID[name]
    for index in range(len(text)):
        try:
            client.send(CONTINUATION if index else TEXT, text[index:index + 1],
                        fin=index == len(text) - 1)
        except OSError:
            break  # it does not wait for the end
    assert_closed(client, 1007)


@pytest.mark.parametrize("tail", [b"\xc2", b"\xe2\x82", b"\xf0\x9f\x98"], ids=["2", "3", "4"])
def test_a_message_that_ends_within_a_character_is_closed_with_1007(client, tail):
    client.send(TEXT, b"abc" + tail)
    assert_closed(client, 1007)


@pytest.mark.parametrize("name", ["fe", "first high surrogate", "beyond U+10FFFF",
                                  "slash in two bytes"])
def test_what_can_never_become_utf_8_is_closed_before_the_message_has_ended(client, name):
    client.send(TEXT, b"abc", fin=False)
    client.send(CONTINUATION, INVALID[name], fin=False)
    assert_closed(client, 1007)


# --- 7: closing

@pytest.mark.parametrize("code", [1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 1012,
                                  1013, 3000, 3999, 4000, 4999])
def test_a_close_is_answered_with_its_code(client, code):
    client.send(CLOSE, struct.pack(">H", code))
    assert_closed(client, code)


@pytest.mark.parametrize("code", [0, 1, 999, 1004, 1005, 1006, 1015, 1016, 1100, 2000, 2999])
def test_a_close_with_a_code_that_may_not_be_sent_is_closed_with_1002(client, code):
    client.send(CLOSE, struct.pack(">H", code))
    assert_closed(client, 1002)


@pytest.mark.parametrize("reason", [b"", b"bye", "tsch\u00fc\u00df".encode(), b"x" * 123],
                         ids=["none", "short", "beyond ASCII", "123 bytes"])
def test_a_close_may_give_a_reason(client, reason):
    client.send(CLOSE, b"\x03\xe8" + reason)
    assert_closed(client, 1000)


@pytest.mark.parametrize("name", INVALID)
def test_a_reason_that_is_no_utf_8_is_closed_with_1007(client, name):
    client.send(CLOSE, b"\x03\xe8" + INVALID[name])
    assert_closed(client, 1002, 1007)


def test_a_close_with_half_a_code_is_closed_with_1002(client):
    client.send(CLOSE, b"\x03")
    assert_closed(client, 1002)


def test_a_close_without_a_code_is_answered_without_one(client):
    client.send(CLOSE)
    frame = client.receive()
    assert (frame.opcode, frame.payload) in ((CLOSE, b""), (CLOSE, b"\x03\xe8"))
    assert client.ended()


@pytest.mark.parametrize("after", [
    raw_frame(CLOSE, b"\x03\xe8"), raw_frame(PING, b"late"), raw_frame(TEXT, b"{}"),
    b"\xff" * 20], ids=["close", "ping", "text", "noise"])
def test_nothing_is_answered_after_the_close(client, after):
    client.send_raw(raw_frame(CLOSE, b"\x03\xe8") + after)
    frame = client.receive()
    assert (frame.opcode, frame.close_code) == (CLOSE, 1000)
    with pytest.raises(ConnectionLost):
        client.receive()


@pytest.mark.parametrize("piece", [b"", b"\x81", b"\x81\xfe\x01", raw_frame(TEXT, b"{}")[:-1],
                                   raw_frame(TEXT, b"{", fin=False)],
                         ids=["nothing", "one byte", "half a length", "all but one byte",
                              "half a message"])
@pytest.mark.parametrize("how", ["half-close", "reset"])
def test_a_client_that_vanishes_within_a_frame_does_no_harm(client, piece, how):
    client.send_raw(piece)
    if how == "half-close":
        client.socket.shutdown(1)
        assert client.ended()
    else:
        client.abort()


# --- 12: compression, which is off

@pytest.mark.parametrize("offer", [
    "permessage-deflate", "permessage-deflate; client_max_window_bits",
    "permessage-deflate; server_no_context_takeover; client_max_window_bits=10",
    "permessage-deflate, permessage-deflate; server_max_window_bits=9", "x-webkit-deflate-frame",
    "permessage-bzip2", ";;,=", ""], ids=str)
def test_an_offer_to_compress_is_declined(server, offer):
    with SharedStream(server, headers={"Sec-WebSocket-Extensions": offer}) as client:
        assert "sec-websocket-extensions" not in client.headers
        client.send(TEXT, padded(20))
        assert_answered(client)
        client.send(TEXT, b"\xaa\x56\x2a\x00\x00", reserved=4)
        assert_closed(client, 1002)


# --- the handshake

@pytest.mark.parametrize("headers", [
    {"Upgrade": "WebSocket"}, {"Connection": "keep-alive, Upgrade"}, {"Connection": "upgrade"},
    {"Sec-WebSocket-Protocol": "modelsynth.v1"},
    {"Sec-WebSocket-Protocol": " other ,\tmodelsynth.v1 "}], ids=str)
def test_these_handshakes_are_fine(server, headers):
    with WebSocketClient(server.port, "/v1/stream", headers=headers) as client:
        assert client.status == 101
        assert client.headers["upgrade"].lower() == "websocket"
        assert_alive(client)


@pytest.mark.parametrize("headers", [
    {"Upgrade": None}, {"Upgrade": "h2c"}, {"Connection": None}, {"Connection": "close"},
    {"Sec-WebSocket-Key": None}, {"Sec-WebSocket-Key": ""}, {"Sec-WebSocket-Key": "x" * 24},
    {"Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAAAAAA=="}, {"Sec-WebSocket-Version": None},
    {"Sec-WebSocket-Version": "8"}, {"Sec-WebSocket-Version": "14"},
    {"Sec-WebSocket-Version": "13, 8"}, {"Sec-WebSocket-Version": "x"},
    {"Sec-WebSocket-Protocol": ""}, {"Sec-WebSocket-Protocol": ","}], ids=str)
def test_these_handshakes_are_refused_with_a_problem(server, headers):
    with pytest.raises(HandshakeRefused) as refused:
        WebSocketClient(server.port, "/v1/stream", headers=headers)
    assert refused.value.status in (400, 426)
    assert refused.value.headers["content-type"] == "application/problem+json"


def test_an_old_version_is_told_the_one_that_is_spoken(server):
    with pytest.raises(HandshakeRefused) as refused:
        WebSocketClient(server.port, "/v1/stream", headers={"Sec-WebSocket-Version": "8"})
    assert refused.value.headers["sec-websocket-version"] == "13"

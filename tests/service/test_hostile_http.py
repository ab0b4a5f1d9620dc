"""Bytes that no honest client sends, over raw sockets. After each the server still answers."""

import json
import socket
import struct
import threading

import pytest

from checks import compact, job_request, short
from raw_http import Wire

PAUSE = threading.Event()


@pytest.fixture(autouse=True)
def still_answering(server):
    yield
    assert server.get("/healthz", timeout=10).status == 200
    assert server.process.poll() is None


def ask(server, data):
    """Sends bytes, half-closes, and gives every answer until the server closes."""
    with Wire(server) as wire:
        return wire.send(data).finish().answers()


def assert_refused(server, data, statuses):
    """That the bytes get just one answer, a problem, and the end of the connection: what comes
    after cannot be told from the rest of the broken request."""
    with Wire(server) as wire:
        answer = wire.send(data + b"GET /v1/smuggled HTTP/1.1\r\nHost: x\r\n\r\n").answer()
        assert answer is not None, "closed without a word"
        assert answer.status in statuses, answer
        assert answer.headers["content-type"] == "application/problem+json"
        problem = json.loads(answer.body)
        assert problem["status"] == answer.status and problem["title"] and problem["detail"]
        assert answer.headers["connection"] == "close"
        assert wire.is_closed(), "the rest was read as another request"


GET = b"GET /healthz HTTP/1.1\r\n"
HOST = b"Host: x\r\n"
END = b"\r\n"
BODY = compact(job_request())


# --- broken heads

@pytest.mark.parametrize(("data", "statuses"), [
    (GET + END, {400}),
    (GET + HOST + b"Host: y\r\n" + END, {400}),
    (GET + HOST + HOST + END, {400}),
    (GET + HOST + b"X-A: b\r\n c\r\n" + END, {400}),
    (GET + HOST + b"X-A: b\r\n\tc\r\n" + END, {400}),
    (GET + b" X: y\r\n" + HOST + END, {400}),
    (GET + HOST + b"X-A : b\r\n" + END, {400}),
    (GET + HOST + b": b\r\n" + END, {400}),
    (GET + HOST + b"no colon\r\n" + END, {400}),
    (GET + HOST + b"X(A): b\r\n" + END, {400}),
    (GET + HOST + b"X-\xc3\xa4: b\r\n" + END, {400}),
    (GET + HOST + b"X-A: b\x00c\r\n" + END, {400}),
    (GET + HOST + b"X-A: b\x01c\r\n" + END, {400}),
    (GET + HOST + b"X-A: b\x7fc\r\n" + END, {400}),
    (GET + HOST + b"X-A: b\rc\r\n" + END, {400}),
    (GET + b"Host: x\nX-A: b\r\n" + END, {400}),
    (b"GET /healthz HTTP/1.1\nHost: x\r\n\r\n", {400}),
    (b"GET /healthz HTTP/1.1\rHost: x\r\n\r\n", {400}),
    (b"GET /health\xc3\xa9 HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /\xff HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /\x7f HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /a\x00b HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /a%00b HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /a%zz HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /a% HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /a b HTTP/1.1\r\n" + HOST + END, {400, 505}),
    (b"GET healthz HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET  /healthz HTTP/1.1\r\n" + HOST + END, {400}),
    (b"GET /healthz  HTTP/1.1\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz\r\n" + HOST + END, {400, 505}),
    (b"GET\r\n" + HOST + END, {400}),
    (b" GET /healthz HTTP/1.1\r\n" + HOST + END, {400}),
    (b"G@T /healthz HTTP/1.1\r\n" + HOST + END, {400}),
    (b"\x00\x01\x02\x03 \xff\xfe\r\n\r\n", {400}),
    (b"garbage\r\n\r\n", {400}),
    (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", {400}),
    (b"GET /healthz HTTP/2.0\r\n" + HOST + END, {505}),
    (b"GET /healthz HTTP/9.9\r\n" + HOST + END, {505}),
    (b"GET /healthz HTTP/0.9\r\n" + HOST + END, {505}),
    (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", {400, 505}),
    (b"GET /healthz HTTP/1\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz HTTP/1.1.1\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz HTTP/11\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz HTTX/1.1\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz http/1.1\r\n" + HOST + END, {400, 505}),
    (b"GET /healthz HTTP/1.x\r\n" + HOST + END, {400, 505}),
], ids=short)
def test_a_broken_head_is_refused_and_the_connection_closed(server, data, statuses):
    assert_refused(server, data, statuses)


@pytest.mark.parametrize("data", [
    b"get /healthz HTTP/1.1\r\n", b"CONNECT x:80 HTTP/1.1\r\n", b"OPTIONS * HTTP/1.1\r\n",
    b"TRACE /healthz HTTP/1.1\r\n", b"X" * 200 + b" /healthz HTTP/1.1\r\n",
    b"GET http:// HTTP/1.1\r\n", b"GET //healthz HTTP/1.1\r\n", b"GET ? HTTP/1.1\r\n",
    b"GET # HTTP/1.1\r\n", b"GET /#x HTTP/1.1\r\n", b"GET /healthz HTTP/1.2\r\n",
    b"GET /v1/jobs?cursor=%f0%28 HTTP/1.1\r\n", b"GET /v1/jobs?%22%0d%0aX: y HTTP/1.1\r\n",
    b"GET /%0d%0aSet-Cookie:%20a=b HTTP/1.1\r\n", b"GET /" + b"../" * 500 + b" HTTP/1.1\r\n",
    b"GET /" + b"%2e%2e%2f" * 500 + b"etc/passwd HTTP/1.1\r\n", b"GET /nope?" + b"&" * 4000 +
    b" HTTP/1.1\r\n",
], ids=short)
def test_an_odd_request_line_gets_one_sound_answer(server, data):
    answers = ask(server, data + HOST + END)
    assert len(answers) == 1 and 400 <= answers[0].status < 506, answers
    assert "set-cookie" not in answers[0].headers
    json.loads(answers[0].body)


def test_characters_beyond_ascii_in_a_header_value_are_allowed(server):
    answers = ask(server, GET + HOST + b"User-Agent: J\xc3\xbcrgen \xff\r\n" + END)
    assert [answer.status for answer in answers] == [200]


def test_a_target_in_absolute_form_is_served(server):
    """RFC 9112, section 3.2.2: a server must accept it."""
    for target in (b"http://x/healthz", b"http://127.0.0.1:%d/healthz" % server.port):
        answers = ask(server, b"GET " + target + b" HTTP/1.1\r\n" + HOST + END)
        assert [answer.status for answer in answers] == [200]


@pytest.mark.parametrize("first", [b"", GET + HOST + END], ids=["at first", "after another"])
def test_an_empty_line_before_a_request_is_skipped(server, first):
    """RFC 9112, section 2.2; some clients end a body with a line end that is not part of it."""
    answers = ask(server, first + b"\r\n" + GET + HOST + END)
    assert [answer.status for answer in answers] == [200] * (2 if first else 1)


@pytest.mark.parametrize("name", [b"HOST: x", b"host:x", b"hOsT:  \t x \t "], ids=short)
def test_names_of_any_case_and_space_around_values_are_fine(server, name):
    assert [a.status for a in ask(server, GET + name + b"\r\n" + END)] == [200]


# --- too long

@pytest.mark.parametrize(("size", "ended"), [(9000, True), (20_000, True), (200_000, True),
                                             (200_000, False)])
def test_a_request_line_that_is_too_long_is_414(server, size, ended):
    data = b"GET /" + b"a" * size
    assert_refused(server, data + (b" HTTP/1.1\r\n" + HOST + END if ended else b""), {414})


def test_the_limit_of_the_request_line_holds_at_its_edge(server):
    line = b"GET /%s HTTP/1.1"
    fill = b"a" * (8192 - len(line % b""))
    assert [a.status for a in ask(server, line % fill + b"\r\n" + HOST + END)] == [404]
    assert_refused(server, line % (fill + b"a") + b"\r\n" + HOST + END, {414})


@pytest.mark.parametrize("fields", [
    b"X-A: " + b"a" * 17_000 + b"\r\n", b"X-A: " + b"a" * 300_000 + b"\r\n",
    b"X" * 17_000 + b": a\r\n", b"X-A: abc\r\n" * 101, b"X-A: a\r\n" * 20_000,
    b"X-A: " + b"a" * 300_000,
], ids=["value", "huge value", "name", "fields", "very many fields", "never ended"])
def test_header_fields_that_are_too_many_are_431(server, fields):
    assert_refused(server, GET + HOST + fields + END, {431})


@pytest.mark.parametrize("size", [3000, 4000, 4200, 5000, 8000, 12_000])
def test_a_head_of_some_thousand_bytes_is_served(server, size):
    """Browsers with many cookies send such."""
    answers = ask(server, GET + HOST + b"Cookie: " + b"a" * (size - 60) + b"\r\n" + END)
    assert [answer.status for answer in answers] == [200], answers


def test_the_limit_of_the_fields_holds_at_its_edge(server):
    assert [a.status for a in ask(server, GET + HOST + b"X-A: b\r\n" * 99 + END)] == [200]
    assert_refused(server, GET + HOST + b"X-A: b\r\n" * 100 + END, {431})
    head = GET + HOST + b"X-A: %s\r\n" + END
    fill = b"a" * (16_384 - len(head % b""))
    assert [a.status for a in ask(server, head % fill)] == [200]
    assert_refused(server, head % (fill + b"a" * 64), {431})


# --- framing: what could be taken for another request

POST = b"POST /v1/jobs HTTP/1.1\r\n" + HOST
INNER = b"DELETE /v1/jobs/smuggled HTTP/1.1\r\nHost: x\r\nX: "


@pytest.mark.parametrize(("fields", "statuses"), [
    (b"Transfer-Encoding: gzip", {501}), (b"Transfer-Encoding: gzip, chunked", {501}),
    (b"Transfer-Encoding: chunked, gzip", {501}), (b"Transfer-Encoding: chunked, chunked", {501}),
    (b"Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked", {400, 501}),
    (b"Transfer-Encoding: chunked\r\nTransfer-Encoding: identity", {400, 501}),
    (b"Transfer-Encoding: identity", {400, 501}), (b"Transfer-Encoding: xchunked", {400, 501}),
    (b"Transfer-Encoding: chunked;q=1", {400, 501}), (b"Transfer-Encoding:", {400, 501}),
    (b"Transfer-Encoding: ,chunked", {400, 501}), (b'Transfer-Encoding: "chunked"', {400, 501}),
    (b"Transfer-Encoding: \x0bchunked", {400, 501}), (b"Transfer-Encoding : chunked", {400}),
    (b"Transfer-Encoding: chunked\r\nContent-Length: 30", {400}),
    (b"Content-Length: 30\r\nTransfer-Encoding: chunked", {400}),
    (b"Content-Length: 30\r\nTransfer-Encoding: gzip", {400, 501}),
    (b"Content-Length: 30\r\ntransfer-encoding: chunked, identity", {400, 501}),
    (b"Content-Length: 5, 5", {400}), (b"Content-Length: 5, 6", {400}),
    (b"Content-Length: 5\r\nContent-Length: 6", {400}),
    (b"Content-Length: 5\r\nContent-Length: 5", {400}),
    (b"Content-Length: +5", {400}), (b"Content-Length: -5", {400}), (b"Content-Length: 0x5", {400}),
    (b"Content-Length: 5a", {400}), (b"Content-Length: 5.0", {400}), (b"Content-Length:", {400}),
    (b"Content-Length: five", {400}), (b"Content-Length: 1e1", {400}), (b"Content-Length: 5 5",
                                                                       {400}),
    (b"Content-Length: 18446744073709551616", {400, 413}),
    (b"Content-Length: 18446744073709551615", {400, 413}),
    (b"Content-Length: 9223372036854775808", {400, 413}),
    (b"Content-Length: " + b"9" * 500, {400, 413}),
], ids=short)
def test_a_length_that_could_be_read_in_two_ways_is_refused(server, fields, statuses):
    assert_refused(server, POST + fields + b"\r\n\r\n" + INNER, statuses)


def test_http_1_0_has_no_chunks(server):
    head = POST.replace(b"1.1", b"1.0") + b"Transfer-Encoding: chunked\r\n\r\n"
    assert_refused(server, head + b"0\r\n\r\n" + INNER, {400, 501})


@pytest.mark.parametrize("chunks", [
    b"zz\r\nabc\r\n0\r\n\r\n", b"-1\r\na\r\n0\r\n\r\n", b"0x3\r\nabc\r\n0\r\n\r\n",
    b"+3\r\nabc\r\n0\r\n\r\n", b"ffffffffffffffff1\r\nabc",
    b"10000000000000003\r\nabc\r\n0\r\n\r\n",
    b"3\r\nabcdef\r\n0\r\n\r\n", b"3\r\nabc0\r\n\r\n", b"3\nabc\n0\n\n", b"\r\n\r\n", b"3 abc\r\n",
    b";x\r\n", b"3\r\nabc\r\n0\r\nContent-Length: 3\r\n\r\n",
], ids=short)
def test_broken_chunks_are_refused(server, chunks):
    # The last one's trailer must not count; it may be refused or left out, but not believed.
    statuses = {400} if b"Content-Length" not in chunks else {400, 415, 422}
    with Wire(server) as wire:
        answer = wire.send(POST + b"Transfer-Encoding: chunked\r\n\r\n" + chunks +
                           b"\r\n" + INNER + END).answer()
        assert answer is not None and answer.status in statuses, answer
        if b"Content-Length" not in chunks:
            assert wire.is_closed()


@pytest.mark.parametrize("size", [b"ffffffffffffffff", b"7fffffffffffffff", b"ffffffff"])
def test_a_chunk_that_says_it_is_endless_is_refused(server, size):
    assert_refused(server, POST + b"Transfer-Encoding: chunked\r\n\r\n" + size + b"\r\nabc",
                   {400, 413})


def chunked(body, size, extension=b"", trailer=b""):
    parts = [b"%x%s\r\n%s\r\n" % (len(part), extension, part)
             for part in (body[i:i + size] for i in range(0, len(body), size))]
    return b"".join(parts) + b"0\r\n" + trailer + b"\r\n"


@pytest.mark.parametrize("body", [
    chunked(BODY, 1), chunked(BODY, 100_000), chunked(BODY, 7, b";name=value"),
    chunked(BODY, 50, b"", b"X-Trailer: yes\r\n"), b"00000" + chunked(BODY, 99),
], ids=["one byte each", "one chunk", "extensions", "trailer", "leading zeros"])
def test_a_chunked_body_is_put_together(server, body):
    with Wire(server) as wire:
        answer = wire.send(POST + b"Transfer-Encoding: chunked\r\n\r\n" + body).answer()
        assert answer.status == 202, answer
        assert wire.send(GET + HOST + END).answer().status == 200


@pytest.mark.parametrize("method", [b"GET", b"DELETE", b"HEAD"])
def test_a_body_of_a_method_that_needs_none_is_not_the_next_request(server, method):
    inner = b"GET /v1/smuggled HTTP/1.1\r\nHost: x\r\n\r\n"
    path = b"/v1/jobs/nope" if method == b"DELETE" else b"/healthz"
    with Wire(server) as wire:
        wire.send(method + b" " + path + b" HTTP/1.1\r\n" + HOST + b"Content-Length: %d\r\n\r\n" %
                  len(inner) + inner + GET + HOST + END)
        assert wire.answer(head_only=method == b"HEAD").status in (200, 404)
        second = wire.answer()
        assert second is None or (second.status, second.body) == (200, b'{"status":"alive"}')


@pytest.mark.parametrize("request_", [
    b"POST /nope HTTP/1.1\r\n" + HOST, b"PUT /v1/jobs HTTP/1.1\r\n" + HOST,
    POST + b"Content-Type: text/plain\r\n",
], ids=["404", "405", "415"])
@pytest.mark.parametrize("framing", [b"Content-Length: 44\r\n\r\n",
                                     b"Transfer-Encoding: chunked\r\n\r\n2c\r\n"],
                         ids=["length", "chunked"])
def test_the_body_of_a_refused_request_is_not_the_next_request(server, request_, framing):
    inner = b"GET /v1/smuggled HTTP/1.1\r\nHost: x\r\n\r\n"
    with Wire(server) as wire:
        answers = wire.send(request_ + framing + inner.ljust(44)).finish().answers()
    assert len(answers) == 1 and answers[0].status in (404, 405, 415), answers


# --- connections

def test_pipelined_requests_are_answered_in_order(server):
    paths = [b"/healthz", b"/nope", b"/v1/examples/castle", b"/v1/jobs?limit=0",
             b"/v1/solvers/discrete"] * 6
    with Wire(server) as wire:
        wire.send(b"".join(b"GET " + path + b" HTTP/1.1\r\n" + HOST + END for path in paths))
        statuses = [wire.answer().status for _ in paths]
    assert statuses == [200, 404, 200, 422, 200] * 6


def test_a_request_behind_a_body_is_answered_after_it(server):
    with Wire(server) as wire:
        wire.send(POST + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY + GET + HOST + END +
                  POST + b"Transfer-Encoding: chunked\r\n\r\n" + chunked(BODY, 20) + GET + HOST +
                  END)
        assert [wire.answer().status for _ in range(4)] == [202, 200, 202, 200]


def test_a_request_behind_a_wait_is_answered_after_it(server):
    with Wire(server) as wire:
        wire.send(POST + b"Prefer: wait=30\r\nContent-Length: %d\r\n\r\n" % len(BODY) + BODY +
                  GET + HOST + END)
        assert [wire.answer().status for _ in range(2)] == [200, 200]


@pytest.mark.parametrize("size", [1, 2, 7])
def test_a_request_in_fragments_is_one_request(server, size):
    data = POST + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY
    with Wire(server) as wire:
        for start in range(0, len(data), size):
            wire.send(data[start:start + size])
        assert wire.answer().status == 202
        assert wire.send(GET + HOST + END).answer().status == 200


@pytest.mark.parametrize("cuts", [(3,), (20, 24), (23, 30), (-2,), (-1,)], ids=str)
def test_pauses_within_a_head_do_no_harm(server, cuts):
    data = GET + HOST + END
    with Wire(server) as wire:
        start = 0
        for cut in (cut % len(data) for cut in cuts):
            wire.send(data[start:cut])
            PAUSE.wait(0.03)
            start = cut
        assert wire.send(data[start:]).answer().status == 200


def test_a_connection_is_kept_for_the_next_request(server):
    with Wire(server) as wire:
        for _ in range(50):
            answer = wire.send(GET + HOST + END).answer()
            assert answer.status == 200 and answer.headers.get("connection") != "close"


@pytest.mark.parametrize("head", [
    GET + HOST + b"Connection: close\r\n", GET + HOST + b"Connection: Close, x\r\n",
    b"GET /healthz HTTP/1.0\r\n", b"GET /healthz HTTP/1.0\r\n" + HOST], ids=short)
def test_a_connection_is_closed_when_the_client_says_so(server, head):
    with Wire(server) as wire:
        answer = wire.send(head + END).answer()
        assert answer.status == 200 and answer.headers["connection"] == "close"
        assert wire.is_closed()


def test_http_1_0_may_keep_the_connection(server):
    with Wire(server) as wire:
        for _ in range(2):
            wire.send(b"GET /healthz HTTP/1.0\r\nConnection: keep-alive\r\n\r\n")
            answer = wire.answer()
            assert answer.status == 200 and answer.headers["connection"] == "keep-alive"


def test_a_client_that_has_said_all_still_gets_its_answer(server):
    assert [a.status for a in ask(server, GET + HOST + END)] == [200]
    answers = ask(server, POST + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY)
    assert [a.status for a in answers] == [202]


@pytest.mark.parametrize("data", [b"", b"G", GET, GET + HOST,
                                  POST + b"Content-Length: 50\r\n\r\nabc",
                                  POST + b"Transfer-Encoding: chunked\r\n\r\n5\r\nab"], ids=short)
@pytest.mark.parametrize("how", ["close", "reset", "half"])
def test_a_client_that_goes_away_in_the_middle_does_no_harm(server, data, how):
    with Wire(server) as wire:
        wire.send(data)
        if how == "reset":
            wire.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        elif how == "half":
            assert all(answer.status == 400 for answer in wire.finish().answers())


def test_a_client_that_does_not_read_its_answers_does_no_harm(server):
    with Wire(server) as wire:
        wire.socket.settimeout(0.2)
        try:
            for _ in range(200):
                wire.socket.sendall(b"GET /v1/examples/castle/model.glb HTTP/1.1\r\n" + HOST + END)
        except (TimeoutError, OSError):
            pass
        assert server.get("/healthz", timeout=5).status == 200


def test_two_hundred_silent_connections_do_not_shut_others_out(server):
    wires = [Wire(server) for _ in range(200)]
    try:
        for number, wire in enumerate(wires):
            wire.send(GET[:number % len(GET)])
        assert server.get("/healthz", timeout=5).status == 200
    finally:
        for wire in wires:
            wire.socket.close()


def test_more_connections_than_are_taken_are_told_so(make_server):
    server = make_server("--connections-max", 3)
    wires = [Wire(server) for _ in range(3)]
    try:
        for wire in wires:
            assert wire.send(GET + HOST + END).answer().status == 200
        with Wire(server) as wire:
            answer = wire.answer()
            assert answer.status == 503 and answer.headers["connection"] == "close"
            assert int(answer.headers["retry-after"]) >= 1
            assert json.loads(answer.body)["status"] == 503
        assert wires[0].send(GET + HOST + END).answer().status == 200
    finally:
        for wire in wires:
            wire.socket.close()


# --- Expect: 100-continue

def test_a_client_that_asks_first_is_told_to_go_on(server):
    with Wire(server) as wire:
        wire.send(POST + b"Expect: 100-continue\r\nContent-Length: %d\r\n\r\n" % len(BODY))
        assert wire.answer().status == 100
        assert wire.send(BODY).answer().status == 202
        assert wire.send(GET + HOST + END).answer().status == 200


@pytest.mark.parametrize(("head", "status"), [
    (POST + b"Content-Length: 999999999999\r\n", 413),
    (POST + b"Content-Type: text/plain\r\nContent-Length: 10\r\n", 415),
    (b"PUT /v1/jobs HTTP/1.1\r\nContent-Length: 10\r\n" + HOST, 405),
    (b"POST /nope HTTP/1.1\r\nContent-Length: 10\r\n" + HOST, 404),
], ids=["413", "415", "405", "404"])
def test_a_client_that_asks_first_is_spared_a_body_that_will_not_be_taken(server, head, status):
    with Wire(server) as wire:
        assert wire.send(head + b"Expect: 100-continue\r\n\r\n").answer().status == status
        assert wire.is_closed()


def test_without_a_body_there_is_nothing_to_ask_for(server):
    answers = ask(server, GET + HOST + b"Expect: 100-continue\r\n" + END)
    assert [answer.status for answer in answers] == [200]


def test_an_expectation_of_http_1_0_is_ignored(server):
    """RFC 9110, section 10.1.1: such a client would take the 100 for its answer."""
    answers = ask(server, POST.replace(b"1.1", b"1.0") + b"Expect: 100-continue\r\n"
                  b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY)
    assert [answer.status for answer in answers] == [202]


@pytest.mark.parametrize("value", [b"200-ok", b"100-continue, x", b"100"], ids=short)
def test_another_expectation_cannot_be_met(server, value):
    assert_refused(server, POST + b"Expect: " + value + b"\r\nContent-Length: 2\r\n\r\n{}", {417})


# --- slow ones

@pytest.fixture(scope="module")
def impatient(tmp_path_factory):
    from conftest import Server
    server = Server(tmp_path_factory.mktemp("impatient") / "data", "--head-seconds", 1,
                    "--body-seconds", 1, "--idle-seconds", 1).start()
    yield server
    server.kill()


def test_a_head_or_a_body_that_does_not_come_is_408_and_an_idle_connection_is_closed(impatient):
    """All at once, since each takes its second."""
    heads = [b"G", GET, GET + b"Host: x", b"GET /healthz HTTP/1.1\nHost: x\n\n",
             b"GET /" + b"a" * 5000]
    bodies = [POST + b"Content-Length: 50\r\n\r\nabc",
              POST + b"Transfer-Encoding: chunked\r\n\r\n5\r\nab",
              POST + b"Expect: 100-continue\r\nContent-Length: 50\r\n\r\n"]
    late = [Wire(impatient).send(data) for data in heads + bodies]
    idle = [Wire(impatient), Wire(impatient).send(GET + HOST + END)]
    try:
        for wire, data in zip(late, heads + bodies):
            answer = wire.answer()
            if answer is not None and answer.status == 100:
                answer = wire.answer()
            assert answer is not None, f"{data[-40:]}: closed without a word"
            assert answer.status in ({400, 408} if b"\n\n" in data else {408}), (data, answer)
            assert json.loads(answer.body)["status"] == answer.status
            assert answer.headers["connection"] == "close" and wire.is_closed()
        assert idle[1].answer().status == 200
        for wire in idle:
            assert wire.is_closed()
    finally:
        for wire in late + idle:
            wire.socket.close()
    assert impatient.get("/healthz").status == 200


@pytest.mark.parametrize("start", [GET + HOST, POST + b"Content-Length: 5000\r\n\r\n"],
                         ids=["head", "body"])
def test_a_client_that_drips_is_cut_off_all_the_same(impatient, start):
    with Wire(impatient) as wire:
        wire.send(start)
        wire.socket.settimeout(0.15)
        for _ in range(60):  # nine seconds at most
            wire.send(b"a")
            try:
                answer = wire.answer()
                break
            except TimeoutError:
                continue
        else:
            raise AssertionError("each byte gave it more time")
        assert answer is not None and answer.status == 408

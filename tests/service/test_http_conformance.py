"""RFC 9110 and 9112 by raw bytes, in the case families of h1spec, one name each. What breaks the
rules gets one problem and the end of the connection; what keeps them is served."""

import json
import os
import shutil
import subprocess

import pytest

from checks import compact
from raw_http import Wire
from test_hostile_http import ask, assert_refused, chunked, still_answering  # noqa: F401

HOST = b"Host: x\r\n"
GET = b"GET /healthz HTTP/1.1\r\n"
UPLOAD = b"POST /v1/examples HTTP/1.1\r\nContent-Type: application/json\r\n" + HOST
CHUNKED = UPLOAD + b"Transfer-Encoding: chunked\r\n\r\n"
BODY = compact({"kind": "discrete"})  # read whole, and then refused with 422


def name_of(value):
    if isinstance(value, bytes):
        return value.decode("latin-1").encode("unicode_escape").decode()[:60] or "empty"
    return None


def served(server, data):
    return [answer.status for answer in ask(server, data + b"\r\n")]


# --- heads

TOKEN = b"!#$%&'*+-.^_`|~0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


@pytest.mark.parametrize("byte", [byte for byte in [*range(0, 128), 0x80, 0xA0, 0xFF]
                                  if bytes([byte]) not in TOKEN and byte not in b":\r\n"],
                         ids="{:#04x}".format)
def test_a_byte_that_no_field_name_has_is_refused(server, byte):
    assert_refused(server, GET + HOST + b"X%cA: b\r\n\r\n" % byte, {400})


@pytest.mark.parametrize("byte", [byte for byte in [*range(0, 32), 127] if byte not in b"\t\r\n"],
                         ids="{:#04x}".format)
def test_a_control_character_in_a_field_value_is_refused(server, byte):
    assert_refused(server, GET + HOST + b"X: a%cb\r\n\r\n" % byte, {400})


@pytest.mark.parametrize("byte", [byte for byte in [*range(0, 33), 127, 128, 255]
                                  if byte not in b"\r\n "], ids="{:#04x}".format)
def test_a_byte_that_no_target_has_is_refused(server, byte):
    assert_refused(server, b"GET /a%cb HTTP/1.1\r\n" % byte + HOST + b"\r\n", {400})


@pytest.mark.parametrize("byte", b"()<>@,;:\\\"/[]?={}", ids="{:c}".format)
def test_a_byte_that_no_method_has_is_refused(server, byte):
    assert_refused(server, b"G%cT /healthz HTTP/1.1\r\n" % byte + HOST + b"\r\n", {400})


def test_all_bytes_that_a_field_name_may_have_are_fine(server):
    assert served(server, GET + HOST + TOKEN + b": b\r\n") == [200]


@pytest.mark.parametrize("field", [
    b"hOST: x", b"HOST: x", b"host: x", b"Host:x", b"Host:\tx\t", b"Host:    x   "], ids=name_of)
def test_field_names_are_of_any_case_and_values_have_space_around(server, field):
    assert served(server, GET + field + b"\r\n") == [200]


@pytest.mark.parametrize("field", [b"X:", b"X: ", b"X:\t", b"X: a\tb", b'X: "a, b"', b"X: \xff"],
                         ids=name_of)
def test_these_field_values_are_fine(server, field):
    assert served(server, GET + HOST + field + b"\r\n") == [200]


@pytest.mark.parametrize("version", [
    b"", b" ", b"HTTP", b"HTTP/", b"HTTP/1", b"HTTP/1.", b"HTTP/.1", b"HTTP/1.1 ", b"HTTP/01.1",
    b"HTTP/1.01", b"HTTP/1,1", b"HTTP/-1.1", b"HTTP/0.9", b"HTTP/2", b"HTTP/2.0", b"HTTP/3.0",
    b"http/1.1", b"Http/1.1", b"HTPP/1.1", b"HTTP /1.1", b"HTTP/ 1.1", b"HTTPS/1.1", b"SHTTP/1.1"],
    ids=name_of)
def test_a_version_that_is_none_of_ours_is_refused(server, version):
    assert_refused(server, b"GET /healthz " + version + b"\r\n" + HOST + b"\r\n", {400, 505})


@pytest.mark.parametrize("prefix", [
    b"\0", b"\x01\x02", b" ", b"\t", b"\n", b"\r", b"\n\n", b"\xef\xbb\xbf", b"garbage ",
    b"garbage\r\n", b"\x80\x2e\x01\x03"], ids=name_of)
def test_a_request_behind_garbage_is_refused(server, prefix):
    assert_refused(server, prefix + GET + HOST + b"\r\n", {400, 505})


@pytest.mark.parametrize("data", [
    b"GET /healthz HTTP/1.1\nHost: x\n\n", b"GET /healthz HTTP/1.1\n" + HOST + b"\r\n",
    GET + b"Host: x\n\r\n", GET + HOST + b"\n\r\n\r\n", GET + HOST + b"X: a\nY: b\r\n\r\n",
    GET + b"Host: x\r\r\n\r\n", GET + HOST + b"X: a\rY: b\r\n\r\n", b"GET /healthz HTTP/1.1\r" +
    HOST + b"\r\n", b"\rGET /healthz HTTP/1.1\r\n" + HOST + b"\r\n", GET + HOST + b"\r\r\n\r\n",
    GET + b"\n" + HOST + b"\r\n"], ids=name_of)
def test_a_line_end_that_is_not_cr_lf_is_refused(server, data):
    with Wire(server) as wire:
        # Some of these have no end that is one, so nothing more will come.
        answer = wire.send(data + b"\r\n\r\n").answer()
        assert answer is not None and answer.status == 400, answer
        assert json.loads(answer.body)["status"] == 400 and wire.is_closed()


@pytest.mark.parametrize("fold", [b"X: a\r\n b", b"X: a\r\n\tb", b"X:\r\n b", b"X: a\r\n ",
                                  b"Transfer-Encoding:\r\n chunked", b"Content-Length:\r\n 5"],
                         ids=name_of)
def test_a_folded_line_is_refused(server, fold):
    assert_refused(server, GET + HOST + fold + b"\r\n\r\n", {400})


@pytest.mark.parametrize("hosts", [b"", HOST + HOST, HOST + b"Host: y\r\n", HOST + b"hOST: x\r\n",
                                   HOST + b"Host:\r\n", b"Host: \r\n" + HOST], ids=name_of)
def test_no_host_or_two_are_refused(server, hosts):
    assert_refused(server, GET + hosts + b"\r\n", {400})


@pytest.mark.parametrize("host", [
    b"a b", b"x/y", b"x, y", b"x,y", b"u@x", b"u:p@x", b"x:abc", b"x:-1", b"x:80:80", b"[::1",
    b"::1", b"[::1]x", b"[x]", b"]", b"x?", b"x#", b"\xff", b"<x>", b'"x"', b"x\\y", b"http://x"],
    ids=name_of)
def test_a_host_that_is_none_is_refused(server, host):
    assert_refused(server, GET + b"Host: " + host + b"\r\n\r\n", {400})


@pytest.mark.parametrize("host", [
    b"", b"x", b"x.", b"X.example.ORG", b"x:80", b"x:", b"x:00080", b"127.0.0.1:8080", b"[::1]",
    b"[::1]:8080", b"[::ffff:127.0.0.1]:1", b"xn--mnchen-3ya.localhost", b"a_b", b"%41"], ids=name_of)
def test_these_hosts_are_fine(server, host):
    assert served(server, GET + b"Host: " + host + b"\r\n") == [200]


def test_http_1_0_needs_no_host(server):
    assert served(server, b"GET /healthz HTTP/1.0\r\n") == [200]


# --- targets and methods

@pytest.mark.parametrize("target", [
    b"http://x/healthz", b"HTTP://x/healthz", b"hTTp://x:80/healthz?", b"http://[::1]/healthz",
    b"http://x", b"http://x?"], ids=name_of)
def test_the_absolute_form_is_served(server, target):
    assert served(server, b"GET " + target + b" HTTP/1.1\r\n" + HOST) == [200]


def test_the_absolute_form_counts_as_its_path(server):
    with Wire(server) as wire:
        answer = wire.send(b"GET http://x/nope?a=/b HTTP/1.1\r\n" + HOST + b"\r\n").answer()
    assert answer.status == 404 and json.loads(answer.body)["instance"] == "/nope"


@pytest.mark.parametrize("target", [
    b"*", b"", b"healthz", b"x:80", b"http:", b"http:/healthz", b"http:///healthz", b"http://",
    b"http://?a", b"http://u@x/healthz", b"http://u:p@x/healthz", b"ftp://x/healthz",
    b"javascript:alert(1)", b"?a", b"#", b"./healthz", b"\\healthz"], ids=name_of)
def test_a_target_of_no_form_is_refused(server, target):
    assert_refused(server, b"GET " + target + b" HTTP/1.1\r\n" + HOST + b"\r\n", {400})


@pytest.mark.parametrize("line", [b"OPTIONS *", b"CONNECT x:80", b"CONNECT /healthz", b"TRACE *",
                                  b"PRI *", b"OPTIONS /nope"], ids=name_of)
def test_what_this_server_does_not_do_gets_one_problem(server, line):
    answers = ask(server, line + b" HTTP/1.1\r\n" + HOST + b"\r\n")
    assert len(answers) == 1 and answers[0].status in (400, 404, 405, 501), answers
    assert answers[0].headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("method", [b"OPTIONS", b"TRACE", b"PUT", b"PATCH", b"DELETE", b"POST",
                                    b"get", b"Get", b"GETT", b"PROPFIND", b"M-SEARCH", TOKEN],
                         ids=name_of)
def test_another_method_is_405_with_what_is_allowed(server, method):
    with Wire(server) as wire:
        answer = wire.send(method + b" /healthz HTTP/1.1\r\n" + HOST + b"\r\n").answer()
        assert answer.status == 405 and answer.headers["allow"] == "GET, HEAD"
        # It was a sound request, so the connection goes on.
        assert wire.send(GET + HOST + b"\r\n").answer().status == 200


@pytest.mark.parametrize("path", [b"/healthz", b"/nope", b"/v1/jobs", b"/openapi.json", b"/"],
                         ids=name_of)
def test_head_is_get_without_the_body(server, path):
    line = b" " + path + b" HTTP/1.1\r\n" + HOST + b"\r\n"
    with Wire(server) as wire:
        head = wire.send(b"HEAD" + line).answer(head_only=True)
        whole = wire.send(b"GET" + line).answer()
    assert head.status == whole.status
    assert head.headers.pop("x-request-id") != whole.headers.pop("x-request-id")
    assert head.headers.pop("date")[-3:] == whole.headers.pop("date")[-3:] == "GMT"
    assert head.headers == whole.headers


@pytest.mark.parametrize("fields", [
    b"Connection: Upgrade\r\nUpgrade: h2c\r\n", b"Connection: Upgrade\r\nUpgrade: websocket\r\n",
    b"Upgrade: TLS/1.0, HTTP/1.1\r\n", b"Connection: X-A\r\nX-A: b\r\n", b"Connection: , ,\r\n",
    b"TE: trailers\r\n", b"Connection: keep-alive, keep-alive\r\n", b"Max-Forwards: 0\r\n"],
    ids=name_of)
def test_what_is_offered_and_not_taken_changes_nothing(server, fields):
    assert served(server, GET + HOST + fields) == [200]


# --- bodies

@pytest.mark.parametrize("coding", [
    b"Chunked", b"CHUNKED", b"chunked ", b" chunked", b"chunked,", b"chunked, ", b"identity, chunked",
    b"chunked, identity", b"deflate", b"compress, chunked", b"chunked\t", b"chunke", b"chunkedd",
    b"x", b"\"chunked\"", b"chunked\x00", b"trailers", b"chunked;a=b"], ids=name_of)
@pytest.mark.parametrize("length", ["none", "before", "behind"])
def test_a_body_is_read_as_chunks_by_the_word_chunked_alone(server, coding, length):
    """And by that in no other case, which another server might not know as the same."""
    field = b"Transfer-Encoding: " + coding + b"\r\n"
    other = b"Content-Length: 5\r\n"
    fields = {"none": field, "before": other + field, "behind": field + other}[length]
    data = UPLOAD + fields + b"\r\n5\r\nabcde\r\n0\r\n\r\n"
    if coding.strip() == b"chunked" and length == "none":
        assert [a.status for a in ask(server, data)] == [400]  # of the JSON
    else:
        assert_refused(server, data, {400, 501})


@pytest.mark.parametrize("length", [
    b"-1", b"-0", b"+5", b"5,5", b"5, 5", b"5,6", b"5 5", b"5;5", b"0x5", b"5h", b"abc", b"", b"5.",
    b".5", b"1e1", b"\xd9\xa5", b"18446744073709551616", b"18446744073709551621",
    b"99999999999999999999999", b"9223372036854775808", b"18446744073709551615", b"4294967301"],
    ids=name_of)
def test_a_length_that_is_none_or_too_much_is_refused(server, length):
    data = UPLOAD + b"Content-Length: " + length + b"\r\n\r\nabcde"
    assert_refused(server, data, {400, 413})


@pytest.mark.parametrize("length", [b"%d", b"%03d", b"%030d", b"  %d\t"], ids=name_of)
def test_a_length_may_have_zeros_and_space_before_it(server, length):
    with Wire(server) as wire:
        wire.send(UPLOAD + b"Content-Length: " + length % len(BODY) + b"\r\n\r\n" + BODY)
        assert wire.answer().status == 422
        assert wire.send(GET + HOST + b"\r\n").answer().status == 200


GOOD_CHUNKS = {
    "one": chunked(BODY, 100), "one byte each": chunked(BODY, 1),
    "upper case": b"A\r\n[1,2,3,4,]\r\n0\r\n\r\n", "zeros before": b"0003\r\n[1]\r\n0000\r\n\r\n",
    "an extension": chunked(BODY, 5, b";a=b"), "extensions": chunked(BODY, 5, b";a;b=c;d"),
    "a quoted extension": chunked(BODY, 5, b';a="b; c"'),
    "space around an extension": chunked(BODY, 5, b" ; a = b"),
    "a long extension": chunked(BODY, 100, b";a=" + b"b" * 8000),
    "a trailer": chunked(BODY, 5, b"", b"X-A: b\r\n"),
    "trailers": chunked(BODY, 5, b"", b"X-A: b\r\n" * 50),
    "a trailer that means nothing here": chunked(BODY, 5, b"", b"Host: y\r\nExpect: x\r\n"),
    "a key as a trailer": chunked(BODY, 5, b"", b"Authorization: Bearer x\r\n"),
}

BAD_CHUNKS = {
    "no size": b"\r\nabc\r\n0\r\n\r\n", "a word for a size": b"g\r\nabc\r\n0\r\n\r\n",
    "a size below zero": b"-3\r\nabc\r\n0\r\n\r\n", "a size with a sign": b"+3\r\n[1]\r\n0\r\n\r\n",
    "a size with 0x": b"0x3\r\n[1]\r\n0\r\n\r\n", "a point": b"3.0\r\n[1]\r\n0\r\n\r\n",
    "space before the size": b" 3\r\n[1]\r\n0\r\n\r\n",
    "17 digits": b"10000000000000003\r\n[1]\r\n0\r\n\r\n",
    "the last size of 64 bits": b"ffffffffffffffff\r\n[1]\r\n0\r\n\r\n",
    "64 bits and a little": b"fffffffffffffffff\r\n[1]\r\n0\r\n\r\n",
    "too short a chunk": b"5\r\n[1]\r\n0\r\n\r\n", "too long a chunk": b"2\r\n[1]\r\n0\r\n\r\n",
    "no line end behind a chunk": b"3\r\n[1]0\r\n\r\n",
    "a bare LF behind a size": b"3\n[1]\r\n0\r\n\r\n",
    "a bare CR behind a size": b"3\r[1]\r\n0\r\n\r\n",
    "a bare LF behind a chunk": b"3\r\n[1]\n0\r\n\r\n",
    "a bare LF in an extension": b"3;a\nb\r\n[1]\r\n0\r\n\r\n",
    "a bare CR in an extension": b"3;a\rb\r\n[1]\r\n0\r\n\r\n",
    "a line end in a quoted extension": b'3;a="b\r\nc"\r\n[1]\r\n0\r\n\r\n',
    "NUL in an extension": b"3;a\0b\r\n[1]\r\n0\r\n\r\n",
    "an extension without a name": b"3;=b\r\n[1]\r\n0\r\n\r\n",
    "an endless extension": b"3;" + b"a" * 300_000,
    "endless zeros": b"0" * 300_000, "an endless trailer": b"0\r\nX: " + b"a" * 300_000,
    "endless trailers": b"0\r\n" + b"X: a\r\n" * 50_000,
    "a trailer without a colon": b"3\r\n[1]\r\n0\r\nX\r\n\r\n",
    "a trailer with a space in its name": b"3\r\n[1]\r\n0\r\nX A: b\r\n\r\n",
    "a bare LF in a trailer": b"3\r\n[1]\r\n0\r\nX: a\nY: b\r\n\r\n",
    "a length as a trailer": b"3\r\n[1]\r\n0\r\nContent-Length: 3\r\n\r\n",
    "a coding as a trailer": b"3\r\n[1]\r\n0\r\nTransfer-Encoding: chunked\r\n\r\n",
}


@pytest.mark.parametrize("name", GOOD_CHUNKS)
def test_these_chunks_are_read_and_the_connection_goes_on(server, name):
    with Wire(server) as wire:
        assert wire.send(CHUNKED + GOOD_CHUNKS[name]).answer().status in (400, 422)
        assert wire.send(GET + HOST + b"\r\n").answer().status == 200


@pytest.mark.parametrize("name", BAD_CHUNKS)
def test_these_chunks_are_refused(server, name):
    assert_refused(server, CHUNKED + BAD_CHUNKS[name], {400, 413})


# --- one after another

@pytest.mark.parametrize("count", [1, 2, 8, 9, 64, 300])
def test_requests_that_come_at_once_are_answered_one_by_one(server, count):
    line = b"GET /nope/%d HTTP/1.1\r\n" + HOST + b"\r\n"
    with Wire(server) as wire:
        wire.send(b"".join(line % number for number in range(count)))
        for number in range(count):
            assert json.loads(wire.answer().body)["instance"] == f"/nope/{number}"


def test_what_comes_behind_a_broken_request_is_not_answered(server):
    good = GET + HOST + b"\r\n"
    with Wire(server) as wire:
        statuses = [answer.status for answer in wire.send(good * 3 + GET + b"\r\n" + good).answers()]
    assert statuses == [200, 200, 200, 400]


def test_what_comes_behind_close_is_not_answered(server):
    good = GET + HOST + b"\r\n"
    data = good + GET + HOST + b"Connection: close\r\n\r\n" + good
    with Wire(server) as wire:
        assert len(wire.send(data).answers()) == 2


# --- slow ones, by slowhttptest

SLOW = {
    "head": ["-H", "-i", "1"], "body": ["-B", "-i", "1", "-s", "8192", "-t", "POST"],
    "read": ["-X", "-r", "200", "-w", "10", "-y", "20", "-n", "1", "-z", "8", "-k", "3"],
}


@pytest.mark.skipif("MODELSYNTH_SLOW" not in os.environ, reason="half a minute each")
@pytest.mark.skipif(shutil.which("slowhttptest") is None, reason="slowhttptest is not installed")
@pytest.mark.parametrize("name", SLOW)
def test_slow_clients_do_not_shut_others_out(make_server, tmp_path, name):
    server = make_server("--head-seconds", 3, "--body-seconds", 3, "--write-seconds", 3)
    path = {"head": "/healthz", "body": "/v1/examples", "read": "/openapi.json"}[name]
    report = subprocess.run(
        ["slowhttptest", *SLOW[name], "-c", "500", "-r", "200", "-l", "15", "-p", "2",
         "-u", server.url + path], cwd=tmp_path, capture_output=True, text=True, timeout=120,
        check=False)
    assert "service available:" in report.stdout, report.stdout + report.stderr
    last = report.stdout.split("service available:")[-1]
    assert "YES" in last.split("\n")[0], last
    assert server.get("/healthz", timeout=5).status == 200

"""HTTPS: everything that HTTP does, certificates that change, and clients that do not speak it."""

import json
import pathlib
import signal
import socket
import ssl
import subprocess
import time

import pytest

from certificate import Certificate
from checks import ENDLESS, make_job
from conftest import BIN_DIR, Server
from websocket_client import CLOSE, WebSocketClient


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tls")


@pytest.fixture(scope="module")
def certificate(folder):
    return Certificate(folder)


@pytest.fixture(scope="module")
def server(folder, certificate):
    shared = Server(folder / "data", *certificate.options, "--head-seconds", 2,
                    "--log-level", "debug")
    shared.tls = certificate.client_context()
    shared.start()
    yield shared
    shared.kill()


def connect(server, context=None, timeout=20):
    raw = socket.create_connection(("127.0.0.1", server.port), timeout=timeout)
    return (context or server.tls).wrap_socket(raw, server_hostname="127.0.0.1")


def read_all(stream):
    data = b""
    while True:
        try:
            more = stream.recv(65536)
        except ConnectionResetError:
            return data
        if not more:
            return data
        data += more


def until(condition, seconds=20):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.02)
    raise AssertionError("it did not come about")


# --- what HTTP does

def test_jobs_and_models_over_tls(server):
    job = make_job(server)
    assert job["state"] == "succeeded"
    whole = server.get(f"/v1/jobs/{job['id']}/model.glb")
    assert whole.status == 200 and len(whole.body) == job["result"]["bytes"]
    part = server.get(f"/v1/jobs/{job['id']}/model.glb", headers={"Range": "bytes=100-1099"})
    assert part.status == 206 and part.body == whole.body[100:1100]


def test_a_large_model_arrives_whole(server):
    job = server.wait(server.submit(size=(60, 10, 60))["id"])
    model = server.get(f"/v1/jobs/{job['id']}/model.glb?profile=merged")
    assert model.status == 200 and len(model.body) > 1 << 20
    assert int.from_bytes(model.body[8:12], "little") == len(model.body)


def test_a_connection_is_kept_and_says_http_1_1(server, certificate):
    context = certificate.client_context()
    context.set_alpn_protocols(["h2", "http/1.1"])
    with connect(server, context) as stream:
        assert stream.selected_alpn_protocol() == "http/1.1"
        assert stream.version() == "TLSv1.3"
        for _ in range(3):
            stream.sendall(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            answer = b""
            while not answer.endswith(b"}"):
                answer += stream.recv(4096)
            assert answer.startswith(b"HTTP/1.1 200 ")
        stream.sendall(b"GET /healthz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n")
        # Ends with a goodbye of TLS, or this would raise.
        assert read_all(stream).startswith(b"HTTP/1.1 200 ")


def test_events_over_tls(server):
    job = server.submit()
    events = server.events(job["id"])
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert events[-1]["type"] == "succeeded"


def test_a_websocket_over_tls(server):
    job = server.submit()
    with WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream?partial=labels",
                         tls=server.tls) as client:
        messages = client.messages()
        assert messages[-1].opcode == CLOSE and messages[-1].close_code == 1000
        events = [message for message in messages if isinstance(message, dict)]
        assert events[-1]["type"] == "succeeded"
        assert any(isinstance(message, bytes) for message in messages)
        assert client.ended()


def test_a_websocket_that_the_client_closes(server):
    with WebSocketClient(server.port, "/v1/stream", tls=server.tls) as client:
        assert client.close(1000) == 1000


def test_a_body_that_is_too_large_is_answered_while_it_comes(server):
    with connect(server) as stream:
        stream.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: "
                       b"application/json\r\nContent-Length: 99999999\r\n\r\n")
        try:
            for _ in range(16):
                stream.sendall(b" " * 65536)
        except OSError:
            pass
        assert stream.recv(65536).startswith(b"HTTP/1.1 413 ")


def test_a_client_that_leaves_is_noticed(server):
    stream = connect(server)
    body = json.dumps({"solver": "discrete", "example": "castle", "parameters": ENDLESS,
                       "tags": {"test": "leaves"}}).encode()
    stream.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nPrefer: wait=60\r\n"
                   b"Content-Type: application/json\r\nContent-Length: %d\r\n\r\n" % len(body) +
                   body)

    def job():
        items = server.get("/v1/jobs?limit=5").json()["items"]
        return next((item for item in items if item["request"]["tags"]), None)

    until(lambda: job() and job()["state"] == "running")
    stream.close()
    until(lambda: job()["state"] == "cancelled")


def test_a_client_that_has_said_all_is_answered(server):
    """One that ends its side of TLS after the request; the answer still comes."""
    context = server.tls
    incoming, outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
    tls = context.wrap_bio(incoming, outgoing, server_hostname="127.0.0.1")
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as raw:
        def step(call):
            while True:
                try:
                    return call()
                except ssl.SSLWantReadError:
                    raw.sendall(outgoing.read())
                    data = raw.recv(65536)
                    assert data, "closed"
                    incoming.write(data)

        step(tls.do_handshake)
        tls.write(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        with pytest.raises(ssl.SSLWantReadError):
            tls.unwrap()
        assert step(lambda: tls.read(65536)).startswith(b"HTTP/1.1 200 ")


def cli(server, *options):
    return subprocess.run([BIN_DIR / "modelsynth", *options, "--server", server.url],
                          capture_output=True, text=True, timeout=60)


def test_the_command_line_client_speaks_it(server, certificate, tmp_path):
    made = cli(server, "run", "--example", "castle", "--size", "20x8x20", "--seed", "7", "-o",
               tmp_path / "castle.glb", "--ca", certificate.certificate)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "castle.glb").read_bytes()[:4] == b"glTF"
    # Whom nobody vouches for is not talked to.
    for roots in ([], ["--ca", Certificate(tmp_path, "other").certificate]):
        refused = cli(server, "list", *roots)
        assert refused.returncode == 3 and "certificate verify failed" in refused.stderr
    wrong_name = subprocess.run(
        [BIN_DIR / "modelsynth", "list", "--ca", certificate.certificate, "--server",
         f"https://127.0.0.2:{server.port}"], capture_output=True, text=True, timeout=60)
    assert wrong_name.returncode == 3


# --- clients that do not speak it

def test_http_on_a_port_of_tls_is_told(server):
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as stream:
        stream.sendall(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        answer = read_all(stream)
    head, body = answer.split(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 400 ") and b"HTTPS" in body
    assert f"Content-Length: {len(body)}".encode() in head


def test_tls_on_a_plain_port_ends_at_once(make_server):
    plain = make_server()
    with pytest.raises(ssl.SSLError):
        connect(plain, ssl.create_default_context(), timeout=5)
    assert plain.get("/healthz").status == 200


@pytest.mark.parametrize("bytes_sent", [
    b"\x00" * 100, b"\x16\x03\x01\xff\xff" + b"\xff" * 300, b"\x16\x03\x01\x00\x05\x01\x00\x00\x01\x00",
    b"\x80\x2e\x01\x00\x02", b"SSH-2.0-x\r\n"])
def test_garbage_costs_nothing(server, bytes_sent):
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as stream:
        stream.sendall(bytes_sent)
        stream.shutdown(socket.SHUT_WR)
        read_all(stream)
    assert server.get("/healthz").status == 200
    assert " error " not in server.log_text() and " warning " not in server.log_text()


def test_a_slow_handshake_has_a_deadline(server):
    begun = time.monotonic()
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as stream:
        stream.sendall(b"\x16\x03\x01\x02\x00\x01")
        assert server.get("/healthz").status == 200  # nobody waits for it
        assert read_all(stream) == b""
    assert 1 < time.monotonic() - begun < 15


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # that is why
@pytest.mark.parametrize("limit", ["old", "h2"])
def test_what_is_not_spoken_is_refused(server, certificate, limit):
    context = certificate.client_context()
    if limit == "old":
        context.minimum_version = ssl.TLSVersion.TLSv1
        context.maximum_version = ssl.TLSVersion.TLSv1_1
        context.set_ciphers("DEFAULT:@SECLEVEL=0")
    else:
        context.set_alpn_protocols(["h2"])
    with pytest.raises(ssl.SSLError):
        connect(server, context)


# --- certificates

def test_a_new_certificate_is_taken_on_sighup(make_server, tmp_path):
    mine = Certificate(tmp_path)
    server = make_server(*mine.options)
    server.tls = mine.client_context()
    before = connect(server)
    kept = mine.digest
    mine.key.write_text("nothing of use")
    server.process.send_signal(signal.SIGHUP)
    until(lambda: "the certificate stays as it was" in server.log_text())
    with connect(server) as stream:
        assert stream.getpeercert(binary_form=True) == kept
    mine = Certificate(tmp_path)
    assert mine.digest != kept
    server.tls = mine.client_context()
    server.process.send_signal(signal.SIGHUP)

    def is_new():
        try:
            with connect(server) as stream:
                return stream.getpeercert(binary_form=True) == mine.digest
        except ssl.SSLError:
            return False

    until(is_new)
    before.sendall(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
    assert before.recv(4096).startswith(b"HTTP/1.1 200 ")
    before.close()
    assert server.stop() == 0


def start_code(tmp_path, *options):
    """What becomes of a server that is started so, and what it says."""
    ended = subprocess.run([BIN_DIR / "modelsynthd", "--data", tmp_path / "data", "--listen",
                            "127.0.0.1:0", *options], capture_output=True, text=True, timeout=30,
                           stdin=subprocess.DEVNULL)
    return ended.returncode, ended.stdout + ended.stderr


def test_files_that_do_not_fit_are_refused(tmp_path, folder):
    one, other = Certificate(tmp_path, "one"), Certificate(tmp_path, "other")
    closed = Certificate(tmp_path, "closed", passphrase="secret")
    text = pathlib.Path(tmp_path / "text")
    text.write_text("no certificate")
    for certificate, key, words in [
            (one.certificate, other.key, "does not fit"), (text, one.key, "the TLS certificate"),
            (one.certificate, text, "the TLS key"), (one.certificate, closed.key, "the TLS key"),
            (tmp_path / "none", one.key, "No such file"), (one.certificate, None, "--tls-key"),
            (None, one.key, "--tls-certificate")]:
        options = ["--tls-certificate", certificate] if certificate else []
        options += ["--tls-key", key] if key else []
        code, said = start_code(tmp_path, *options)
        assert code != 0 and words in said and "listening" not in said, said

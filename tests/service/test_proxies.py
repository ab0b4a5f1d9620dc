"""The samples for nginx and haproxy, with the programs themselves: what streams comes through as it
comes. Where a program is not installed its tests are skipped."""

import copy
import shutil
import socket
import subprocess
import time

import pytest

from certificate import Certificate
from checks import ENDLESS, make_job
from conftest import ROOT, Server
from websocket_client import CLOSE, TEXT, WebSocketClient

SAMPLES = ROOT / "deploy/proxies"


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        return taken.getsockname()[1]


def replaced(text, changes):
    """The sample, with the addresses and files of this machine."""
    for old, new in changes.items():
        assert old in text, old
        text = text.replace(old, str(new))
    return text


def nginx(folder, certificate, port, server):
    site = replaced((SAMPLES / "nginx.conf").read_text(), {
        "listen 443 ssl": f"listen 127.0.0.1:{port} ssl",
        "server 127.0.0.1:8080": f"server 127.0.0.1:{server.port}",
        "models.example.com;": "127.0.0.1;",
        "/etc/ssl/certs/models.example.com.pem": certificate.certificate,
        "/etc/ssl/private/models.example.com.key": certificate.key})
    temporary = "".join(f"{kind}_temp_path {folder}/{kind};\n" for kind in (
        "client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    path = folder / "nginx.conf"
    path.write_text(f"user root;\nerror_log {folder}/error.log;\npid {folder}/pid;\nevents {{}}\n"
                    f"http {{\naccess_log off;\n{temporary}\n{site}\n}}\n")
    return ["nginx", "-g", "daemon off;", "-p", folder, "-c", path]


def haproxy(folder, certificate, port, server):
    both = folder / "both.pem"
    both.write_text(certificate.certificate.read_text() + certificate.key.read_text())
    path = folder / "haproxy.cfg"
    path.write_text(replaced((SAMPLES / "haproxy.cfg").read_text(), {
        "bind :443": f"bind 127.0.0.1:{port}",
        "/etc/haproxy/models.example.com.pem": both,
        "127.0.0.1:8080": f"127.0.0.1:{server.port}"}))
    return ["haproxy", "-db", "-f", path]


@pytest.fixture(scope="module", params=[nginx, haproxy])
def proxy(request, tmp_path_factory):
    """A server as it is seen through the proxy."""
    name = request.param.__name__
    if shutil.which(name) is None:
        pytest.skip(f"{name} is not installed")
    folder = tmp_path_factory.mktemp(name)
    certificate = Certificate(folder)
    server = Server(folder / "data").start()
    seen = copy.copy(server)
    seen.port, seen.tls = free_port(), certificate.client_context()
    process = subprocess.Popen(request.param(folder, certificate, seen.port, server))
    try:
        until = time.monotonic() + 30
        while True:
            try:
                if seen.get("/readyz").status == 200:
                    break
            except OSError:
                assert time.monotonic() < until and process.poll() is None
            time.sleep(0.05)
        yield seen
    finally:
        process.terminate()
        process.wait(30)
        server.kill()


def test_a_job_is_waited_for_and_its_model_comes_whole(proxy):
    job = make_job(proxy)
    model = proxy.get(job["urls"]["model"])
    assert model.status == 200 and len(model.body) == job["result"]["bytes"]
    part = proxy.get(job["urls"]["model"], headers={"Range": "bytes=0-3"})
    assert (part.status, part.body) == (206, b"glTF")


def test_events_come_as_they_are_written(proxy):
    job = proxy.submit()
    events = proxy.events(job["id"])
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert events[-1]["type"] == "succeeded"
    # Of a job without end nothing would come through a proxy that waits for the whole answer.
    endless = proxy.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": "castle", "parameters": ENDLESS}).json()
    connection = proxy.connection(timeout=20)
    try:
        connection.request("GET", f"/v1/jobs/{endless['id']}/events")
        answer = connection.getresponse()
        while not answer.readline().startswith(b"event: block"):
            pass
    finally:
        connection.close()
        proxy.request("POST", endless["urls"]["cancel"])


def test_a_websocket_is_let_through(proxy):
    job = proxy.submit()
    with WebSocketClient(proxy.port, f"/v1/jobs/{job['id']}/stream", tls=proxy.tls) as client:
        frames = []
        while not frames or frames[-1].opcode != CLOSE:
            frames.append(client.receive())
    assert frames[-1].close_code == 1000
    assert b'"succeeded"' in [frame for frame in frames if frame.opcode == TEXT][-1].payload

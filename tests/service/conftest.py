"""A real server for tests: the built binary on a port of its own, with a store of its own.

The binaries are taken from $MODELSYNTH_BIN_DIR, or build/release/bin.
"""

import http.client
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

import pytest

from event_reader import PATIENCE
from webhook_receiver import SECRET

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN_DIR = pathlib.Path(os.environ.get("MODELSYNTH_BIN_DIR", ROOT / "build/release/bin"))


class Answer:
    """An HTTP answer, read whole. Header names are in lower case."""

    def __init__(self, status, headers, body):
        self.status = status
        headers = list(headers)
        self.headers = {name.lower(): value for name, value in headers}
        assert len(self.headers) == len(headers), f"a field stands twice: {headers}"
        self.body = body

    def json(self):
        return json.loads(self.body)


class Server:
    """One modelsynthd process. stop() ends it gently, kill() as a crash would; start() again uses
    the same store. Unless a test says so, running jobs have no time to end when it stops."""

    def __init__(self, data, *options, workers=2):
        self.data = pathlib.Path(data)
        self.bin_dir = BIN_DIR
        self.options = ["--drain-timeout", "0"] if "--drain-timeout" not in options else []
        self.options += [str(option) for option in options]
        self.workers = workers
        self.process = None
        self.port = None
        self.tls = None  # the client's SSLContext, where the server speaks HTTPS

    @property
    def url(self):
        return f"{self.scheme}://127.0.0.1:{self.port}"

    @property
    def scheme(self):
        return "https" if "--tls-key" in self.options else "http"

    def start(self):
        self.data.mkdir(parents=True, exist_ok=True)
        self.log = open(self.data.parent / (self.data.name + ".log"), "ab")
        self.process = subprocess.Popen(
            [self.bin_dir / "modelsynthd", "--data", self.data, "--listen", "127.0.0.1:0",
             "--workers", str(self.workers), *self.options],
            stdout=subprocess.PIPE, stderr=self.log, text=True)
        line = self.process.stdout.readline().strip()
        assert line.startswith(f"listening on {self.scheme}://127.0.0.1:"), line
        self.port = int(line.rsplit(":", 1)[1])
        return self

    def stop(self):
        """Ends the server with SIGTERM and tells its exit code."""
        if self.process is None:
            return None
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=PATIENCE)
        self._forget()
        return code

    def kill(self):
        """Ends the server as a crash would: kill -9."""
        if self.process is None:
            return
        self.process.kill()
        self.process.wait(timeout=PATIENCE)
        self._forget()

    def _forget(self):
        self.process.stdout.close()
        self.log.close()
        self.process = None

    def connection(self, timeout=PATIENCE):
        if self.tls:
            return http.client.HTTPSConnection("127.0.0.1", self.port, timeout=timeout,
                                               context=self.tls)
        return http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)

    def log_text(self):
        return (self.data.parent / (self.data.name + ".log")).read_text()

    def request(self, method, path, body=None, headers=None, timeout=PATIENCE):
        connection = self.connection(timeout)
        headers = dict(headers or {})
        if isinstance(body, (dict, list)):
            body = json.dumps(body)
            headers.setdefault("Content-Type", "application/json")
        try:
            connection.request(method, path, body=body, headers=headers)
            answer = connection.getresponse()
            return Answer(answer.status, answer.getheaders(), answer.read())
        finally:
            connection.close()

    def get(self, path, **kwargs):
        return self.request("GET", path, **kwargs)

    def submit(self, size=(20, 8, 20), seed=7, example="castle", solver="discrete", **more):
        """Submits a job and returns the job."""
        parameters = {"size": list(size), **more.pop("parameters", {})}
        answer = self.request("POST", "/v1/jobs", {
            "solver": solver, "example": example, "seed": seed, "parameters": parameters,
            **more})
        assert answer.status == 202, answer.body
        return answer.json()

    def wait(self, job_id, timeout=PATIENCE):
        """Waits for the job's end and returns the job."""
        until = time.monotonic() + timeout
        while time.monotonic() < until:
            job = self.get(f"/v1/jobs/{job_id}").json()
            if job["state"] in ("succeeded", "failed", "cancelled"):
                return job
            time.sleep(0.02)
        raise AssertionError(f"job {job_id} did not end: {job}")

    def events(self, job_id, after=0, timeout=PATIENCE):
        """All events of the job up to its last one, as the SSE stream gives them."""
        answer = self.get(f"/v1/jobs/{job_id}/events?after={after}", timeout=timeout)
        assert answer.status in (200, 204), answer.body
        return parse_sse(answer.body.decode())


def parse_sse(text):
    """The data of each event of a stream, as dicts; id and event must agree with the data."""
    events = []
    for block in text.split("\n\n"):
        fields = dict(line.split(": ", 1) for line in block.split("\n")
                      if ": " in line and not line.startswith(":"))
        if "data" in fields:
            event = json.loads(fields["data"])
            assert fields["id"] == str(event["seq"])
            assert fields["event"] == event["type"]
            events.append(event)
    return events


# A model that no server finishes at once: for cancelling, killing and watching.
LONG_SIZE = (300, 10, 300)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    report = (yield).get_result()
    if report.when == "call":
        item.has_failed = report.failed


@pytest.fixture
def make_server(request):
    """Makes servers with options of the test's choice; all are ended with the test. What they
    logged stands in the report of a test that failed."""
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-test-"))
    servers = []

    def make(*options, workers=2, name="data"):
        server = Server(directory / name, *options, workers=workers)
        servers.append(server)
        return server.start()

    yield make
    for server in servers:
        server.kill()
        if getattr(request.node, "has_failed", False):
            print(f"--- log of {server.data}\n{server.log_text()[-8000:]}")
    shutil.rmtree(directory, ignore_errors=True)


@pytest.fixture
def hook_server(make_server, tmp_path):
    """Makes servers that may send to this machine; further options after these."""
    secret = tmp_path / "secret"
    secret.write_text(SECRET + "\n")

    def make(*options, private=True, http=True, **more):
        usual = {"--webhook-secret-file": secret, "--webhook-first-delay": "0.001",
                 "--webhook-seconds": "2"}
        server = make_server(
            *(word for name, value in usual.items() if name not in options
              for word in (name, value)),
            *(["--webhook-allow-http"] if http else []),
            *(["--webhook-allow-private"] if private else []), *options, **more)
        server.secret = secret
        return server

    return make


@pytest.fixture(scope="session")
def server():
    """One server for all tests that leave it as they found it."""
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-test-"))
    # Large jobs are what tests hold it up with; none is to wait for another one.
    shared = Server(directory / "data", "--large-choices", 10**15).start()
    yield shared
    shared.kill()
    shutil.rmtree(directory, ignore_errors=True)

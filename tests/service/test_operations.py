"""What whoever operates the server needs: configuration, logs, metrics, and how it stops."""

import contextlib
import hashlib
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import threading
import time

import pytest

import metrics_text
from checks import ENDLESS, STRIPES, assert_problem, job_request
from conftest import BIN_DIR
from raw_http import Wire
from websocket_client import CLOSE, TEXT, HandshakeRefused, WebSocketClient

_ROOT = pathlib.Path(__file__).parents[2]

# Keeps one worker busy for as long as it takes to look around.
SOME_SECONDS = {"size": [100, 10, 100],
                "blocks": {"size": [20, 10, 20], "overlap": 0.75, "passes": 12}}

TRACE = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"


def wait_until(is_true, timeout=60):
    until = time.monotonic() + timeout
    while not is_true():
        assert time.monotonic() < until
        time.sleep(0.02)


def log_text(server):
    return (server.data.parent / (server.data.name + ".log")).read_text()


def log_entries(server, event=None):
    """The lines of a JSON log, each of which must be one object."""
    entries = [json.loads(line) for line in log_text(server).split("\n")[:-1]]
    return [entry for entry in entries if event in (None, entry["event"])]


def entry_of(server, event, **fields):
    """The one line that has these fields, once it is written."""
    def found():
        return [entry for entry in log_entries(server, event) if fields.items() <= entry.items()]
    wait_until(found)
    assert len(found()) == 1
    return found()[0]


def run_daemon(*arguments, environment=None):
    return subprocess.run([BIN_DIR / "modelsynthd", *map(str, arguments)], text=True,
                          capture_output=True, timeout=60,
                          env={**os.environ, **(environment or {})})


def metrics_of(server, **kwargs):
    answer = server.get("/metrics", **kwargs)
    assert answer.status == 200
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
    return metrics_text.check(answer.body.decode())


# --- configuration

def test_options_come_from_the_command_line_the_environment_and_a_file(tmp_path):
    file = tmp_path / "server.conf"
    file.write_text("queue-max = 3\nworkers = 3\nlog-format = json\n")
    printed = run_daemon("--print-config", "--config", file, "--queue-max", 1,
                         environment={"MODELSYNTH_QUEUE_MAX": "2", "MODELSYNTH_WORKERS": "2"})
    assert printed.returncode == 0, printed.stderr
    lines = printed.stdout.split("\n")
    assert 'queue-max = "1"' in lines
    assert 'workers = "2"' in lines
    assert 'log-format = "json"' in lines
    again = tmp_path / "again.conf"
    again.write_text(printed.stdout)
    assert run_daemon("--print-config", "--config", again).stdout == printed.stdout


def test_a_configuration_is_checked_with_the_keys(tmp_path):
    keys = tmp_path / "keys.json"
    digest = hashlib.sha256(b"secret").hexdigest()
    keys.write_text(json.dumps({"keys": [{"name": "a", "sha256": digest, "scopes": ["read"]}]}))
    fine = run_daemon("--check-config", "--keys", keys, "--data", tmp_path / "store")
    assert (fine.returncode, fine.stderr) == (0, "")
    assert not (tmp_path / "store").exists()
    printed = run_daemon("--print-config", "--keys", keys)
    assert str(keys) in printed.stdout and digest not in printed.stdout
    file = tmp_path / "server.conf"
    file.write_text(f"\nkeys = '{keys}'\nworkers = many\n")
    keys.write_text('{"keys": [{"name": "a", "sha256": "12", "scopes": ["read"]}]}')
    wrong = run_daemon("--check-config", "--config", file,
                       environment={"MODELSYNTH_QUEUE_MAX": "none"})
    assert wrong.returncode == 2
    assert f"{file}:3: " in wrong.stderr
    assert "MODELSYNTH_QUEUE_MAX: " in wrong.stderr
    assert "/keys/0/sha256" in wrong.stderr


def test_every_option_is_in_the_help_and_in_the_printed_configuration():
    told = run_daemon("--help").stdout
    options = set(re.findall(r"^ +--([a-z-]+)", told, re.MULTILINE))
    printed = run_daemon("--print-config").stdout
    names = set(re.findall(r"^(?:# )?([a-z-]+) = ", printed, re.MULTILINE))
    assert names == options - {"config", "check-config", "print-config", "version"} - {"help"}
    assert len(names) > 30


# --- limits at their edges

def test_as_many_connections_of_an_address_are_served_as_allowed(make_server):
    server = make_server("--connections-per-address-max", 3)
    with contextlib.ExitStack() as stack:
        wires = [stack.enter_context(Wire(server)) for _ in range(3)]
        for wire in wires:
            wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
            assert wire.answer().status == 200
        refused = stack.enter_context(Wire(server)).answer()
        assert refused.status == 503
        assert "retry-after" in refused.headers and "x-request-id" in refused.headers
        wires[0].socket.close()
        wait_until(lambda: server.get("/healthz").status == 200)
        text = wires[1].send(b"GET /metrics HTTP/1.1\r\nHost: x\r\n\r\n").answer().body.decode()
        assert metrics_text.value(metrics_text.check(text), "modelsynth_rejected_total",
                                  reason="connections-of-address") >= 1


@pytest.mark.parametrize(("option", "limit", "make", "status"), [
    ("--fields-max", 10, lambda n: {f"x-{i}": "1" for i in range(n - 2)}, 431),
    ("--head-bytes-max", 2048, lambda n: {"x": "y" * (n - 100)}, 431),
    ("--target-bytes-max", 300, lambda n: n, 414),
])
def test_the_head_of_a_request_may_be_as_large_as_allowed(make_server, option, limit, make, status):
    server = make_server(option, limit)

    def ask(size):
        made = make(size)
        path, headers = "/healthz", made
        if isinstance(made, int):
            line = "GET /healthz?x HTTP/1.1"
            path, headers = "/healthz?x" + "y" * (made - len(line)), {}
        return server.get(path, headers=headers).status

    # http.client sends Host and Accept-Encoding besides, about 100 bytes.
    assert ask(limit) == 200
    assert ask(limit + (100 if option == "--head-bytes-max" else 1)) == status


def test_json_may_be_as_deep_and_have_as_many_values_as_allowed(make_server):
    server = make_server("--json-depth-max", 10, "--json-nodes-max", 100,
                         "--json-string-bytes-max", 1024)

    def ask(tags):
        body = json.dumps({**job_request(), "tags": tags})
        answer = server.request("POST", "/v1/jobs", body,
                                headers={"Content-Type": "application/json"})
        return answer.status, answer.body

    def nested(depth):
        return {"a": nested(depth - 1)} if depth > 1 else {"a": 1}

    # Too deep or too much to be read is 400; what is read and then refused is 422.
    assert ask(nested(9))[0] == 422
    assert ask(nested(10))[0] == 400
    assert ask({"a": [1] * 200})[0] == 400
    assert ask({"a": "x" * 1024})[0] == 202
    assert ask({"a": "x" * 1025})[0] == 400


def test_a_connection_is_closed_after_as_many_requests_as_allowed(make_server):
    server = make_server("--requests-per-connection-max", 2)
    with Wire(server) as wire:
        wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n" * 3)
        assert [wire.answer().status for _ in range(2)] == [200, 200]
        assert wire.is_closed()


# --- logs

def test_the_log_is_an_object_a_line_whatever_clients_send(make_server, tmp_path):
    secret = "very-secret-key"
    keys = tmp_path / "keys.json"
    keys.write_text(json.dumps({"keys": [
        {"name": "stu\"dio\nforged status=200", "scopes": ["read", "submit", "admin"],
         "sha256": hashlib.sha256(secret.encode()).hexdigest()}]}))
    server = make_server("--log-format", "json", "--keys", keys, "--log-level", "debug")
    bearer = {"Authorization": f"Bearer {secret}"}
    evil = "/v1/jobs/%22%0Ax%22%20status=200%0d%0a%1b[31m%e2%80%a8/events"
    assert server.get(evil, headers=bearer).status == 404
    assert server.get("/v1/jobs?cursor=private", headers=bearer).status in (200, 400)
    ticket = server.request("POST", "/v1/tickets", {}, headers=bearer).json()["ticket"]
    server.get(f"/v1/jobs/none/events?ticket={ticket}")
    server.request("BR\u00cbW".encode("latin-1").decode("ascii", "ignore"), "/v1/jobs")
    server.get("/healthz", headers={"X-Request-Id": "last-one"})
    entry_of(server, "request", request="last-one", level="debug", route="/healthz")
    text = log_text(server)
    assert secret not in text and ticket not in text and "private" not in text
    entries = log_entries(server, "request")
    told = next(entry for entry in entries
                if entry["route"] == "/v1/jobs/{id}/events" and "stu" in entry.get("key", ""))
    assert told["status"] == 404 and told["method"] == "GET" and told["bytes"] > 100
    assert told["key"] == "stu\"dio\nforged status=200"
    assert told["job"].startswith('"\nx" status=200')
    assert all(entry["time"].endswith("Z") and entry["level"] for entry in log_entries(server))


def test_the_text_log_has_a_line_an_event_and_the_first_line_of_output_stays(make_server):
    server = make_server()
    server.get("/v1/jobs/a%0Ab", headers={"X-Request-Id": "the-id"})
    wait_until(lambda: "the-id" in log_text(server))
    line = next(line for line in log_text(server).split("\n") if "request=the-id" in line)
    assert re.fullmatch(
        r'\d{4}-\d\d-\d\dT[\d:]{8}\.\d{3}Z info request method=GET route=/v1/jobs/\{id\} status=404 '
        r'problem=not-found bytes=\d+ seconds=[\d.e-]+ request=the-id job="a\\nb"', line), line


def test_a_log_that_nobody_reads_stops_nothing_and_tells_what_was_lost(tmp_path):
    reader, writer = os.pipe()
    process = subprocess.Popen(
        [BIN_DIR / "modelsynthd", "--data", tmp_path / "data", "--listen", "127.0.0.1:0",
         "--log-lines-max", "10"], stdout=subprocess.PIPE, stderr=writer, text=True)
    os.close(writer)
    try:
        port = int(process.stdout.readline().strip().rsplit(":", 1)[1])
        request = (b"GET /v1/jobs HTTP/1.1\r\nHost: localhost\r\nX-Request-Id: "
                   + b"x" * 64 + b"\r\n\r\n")
        with socket.create_connection(("127.0.0.1", port), timeout=30) as connection:
            # More than a pipe and the lines that may wait hold, in pieces that are all answered.
            for _ in range(20):
                connection.sendall(request * 50)
                seen = 0
                while seen < 50:
                    seen += connection.recv(1 << 16).count(b"HTTP/1.1 200")
            connection.sendall(b"GET /metrics HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
            text = b""
            while piece := connection.recv(1 << 16):
                text += piece
        samples = metrics_text.check(text.split(b"\r\n\r\n", 1)[1].decode())
        assert samples[("modelsynth_log_lines_dropped_total", ())] > 0
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        os.close(reader)


# --- what ties things together

@pytest.mark.parametrize("path", ["/healthz", "/v1/jobs", "/nope", "/v1/jobs/none/events"])
def test_every_answer_has_the_requests_id(server, path):
    assert server.get(path, headers={"X-Request-Id": "a.B_c-9"}).headers["x-request-id"] == "a.B_c-9"
    for bad in ("", "a b", "x" * 65, "a\"b"):
        made = server.get(path, headers={"X-Request-Id": bad}).headers["x-request-id"]
        assert re.fullmatch("[0-9a-f]{16}", made)
    assert (server.get(path).headers["x-request-id"] != server.get(path).headers["x-request-id"])


def test_answers_to_what_is_no_request_have_an_id_too(server):
    for bad in (b"nonsense\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n",
                b"GET /%zz HTTP/1.1\r\nHost: x\r\nX-Request-Id: mine\r\n\r\n"):
        with Wire(server) as wire:
            told = wire.send(bad).answer().headers["x-request-id"]
            assert told == "mine" if b"mine" in bad else re.fullmatch("[0-9a-f]{16}", told)


def test_streams_have_the_requests_id(server):
    job = server.submit(size=(8, 6, 8))
    server.wait(job["id"])
    client = WebSocketClient(server.port, job["urls"]["stream"], headers={"X-Request-Id": "ws-1"})
    assert client.headers["x-request-id"] == "ws-1"
    client.close()
    events = server.get(job["urls"]["events"], headers={"X-Request-Id": "sse-1"})
    assert events.headers["x-request-id"] == "sse-1"
    with pytest.raises(HandshakeRefused) as refused:
        WebSocketClient(server.port, "/v1/jobs/none/stream", headers={"X-Request-Id": "ws-2"})
    assert refused.value.headers["x-request-id"] == "ws-2"


def test_a_trace_goes_from_the_request_to_the_lines_of_its_job(make_server):
    server = make_server("--log-format", "json")
    for traceparent, seed in ((TRACE, 1), ("00-nonsense", 2)):
        answer = server.request("POST", "/v1/jobs", job_request(seed=seed), headers={
            "traceparent": traceparent, "X-Request-Id": f"submit-{seed}", "Prefer": "wait=60"})
        job = answer.json()["id"]
        for event, fields in (("request", {"request": f"submit-{seed}", "job": job}),
                              ("job started", {"job": job}), ("job ended", {"job": job})):
            told = entry_of(server, event, **fields)
            assert told.get("traceparent") == (TRACE if traceparent == TRACE else None)
    assert entry_of(server, "job ended", job=job)["state"] == "succeeded"


def test_a_trace_is_kept_with_the_job_over_a_restart(make_server):
    server = make_server("--log-format", "json", "--drain-timeout", 0, workers=1)
    answer = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": "castle", "parameters": ENDLESS},
        headers={"traceparent": TRACE})
    job = answer.json()["id"]
    entry_of(server, "job started", job=job)
    assert server.stop() == 0
    server.start()
    wait_until(lambda: len(log_entries(server, "job started")) == 2)
    assert [entry["traceparent"] for entry in log_entries(server, "job started")] == [TRACE] * 2
    server.request("POST", f"/v1/jobs/{job}/cancel")


# --- metrics

def test_metrics_tell_what_happened_and_no_name_of_anything(make_server):
    server = make_server(workers=1)
    server.request("POST", "/v1/examples", STRIPES)
    uploaded = server.get("/v1/examples").json()["items"][-1]["id"]
    jobs = [server.submit(size=(12, 6, 12)),
            server.submit(size=(6, 2, 4), example=uploaded)]
    for job in jobs:
        server.wait(job["id"])
        assert server.get(job["urls"]["model"]).status == 200
        assert server.events(job["id"])
    blocks = sum(event["type"] == "block" for event in server.events(jobs[0]["id"]))
    assert server.request("BREW", "/v1/jobs").status == 405
    samples = metrics_of(server)

    def value(name, **labels):
        return metrics_text.value(samples, "modelsynth_" + name, **labels)

    assert value("jobs_total", solver="discrete", result="succeeded") == 2
    assert value("job_seconds_count", solver="discrete") == 2
    assert value("queue_wait_seconds_count") == 2
    assert value("blocks_total", outcome="accepted", example="castle") \
        + value("blocks_total", outcome="reverted", example="castle") == blocks
    assert value("blocks_total", example="uploaded") >= 1
    assert value("http_requests_total", route="/v1/jobs", method="POST", code="202") == 2
    assert value("http_requests_total", route="/v1/jobs/{id}/model.glb", code="200") == 2
    assert value("http_requests_total", route="none", method="other", code="405") == 1
    assert value("http_request_seconds_count", route="/v1/jobs") == 2
    assert value("http_request_seconds_count", route="/v1/jobs/{id}/events") == 0
    assert value("http_response_bytes_total") > 1000
    assert value("connections") == 1
    assert value("jobs_queued") == value("jobs_running") == value("ws_connections") == 0
    assert value("store_commit_seconds_count") >= 4
    assert value("artifact_bytes") > 1000 and value("disk_free_bytes") > 0
    assert value("build_info") == 1
    text = server.get("/metrics").body.decode()
    assert not any(job["id"] in text for job in jobs) and uploaded not in text


def test_metrics_tell_what_is_going_on(make_server):
    server = make_server("--queue-max", 1, workers=1)
    running = server.submit(example="castle", parameters=ENDLESS)
    wait_until(lambda: metrics_text.value(metrics_of(server), "modelsynth_jobs_running") == 1)
    queued = server.submit(size=(8, 6, 8))
    assert_problem(server.request("POST", "/v1/jobs", job_request()), 503, "queue-full")
    client = WebSocketClient(server.port, running["urls"]["stream"])
    samples = metrics_of(server)
    assert metrics_text.value(samples, "modelsynth_jobs_queued") == 1
    assert metrics_text.value(samples, "modelsynth_ws_connections") == 1
    assert metrics_text.value(samples, "modelsynth_rejected_total", reason="queue-full") == 1
    client.close()
    for job in (queued, running):
        server.request("POST", job["urls"]["cancel"])
        server.wait(job["id"])
    wait_until(lambda: metrics_text.value(
        metrics_of(server), "modelsynth_jobs_total", result="cancelled") == 2)
    wait_until(lambda: metrics_text.value(metrics_of(server), "modelsynth_ws_connections") == 0)


def test_what_is_counted_by_reason_begins_at_nothing(make_server):
    """Or a rate would miss the first of each."""
    samples = metrics_of(make_server())
    alerts = (_ROOT / "deploy/prometheus/alerts.yml").read_text()
    watched = {reason for group in re.findall(r'modelsynth_rejected_total\{reason=~?"([^"]*)"', alerts)
               for reason in group.split("|")}
    assert watched
    for reason in (*watched, "unauthorized", "missing-scope", "too-fast", "body-too-large",
                   "connections-of-address"):
        assert metrics_text.value(samples, "modelsynth_rejected_total", reason=reason) == 0
    assert metrics_text.value(samples, "modelsynth_events_dropped_total", reason="slow-reader") == 0


def test_metrics_are_for_administrators(make_server, tmp_path):
    keys = tmp_path / "keys.json"
    keys.write_text(json.dumps({"keys": [
        {"name": name, "scopes": scopes, "sha256": hashlib.sha256(name.encode()).hexdigest()}
        for name, scopes in (("user", ["read", "submit"]), ("admin", ["admin"]))]}))
    server = make_server("--keys", keys)
    assert_problem(server.get("/metrics"), 401, "unauthorized")
    assert_problem(server.get("/metrics", headers={"Authorization": "Bearer user"}), 403,
                   "missing-scope")
    samples = metrics_of(server, headers={"Authorization": "Bearer admin"})
    assert metrics_text.value(samples, "modelsynth_rejected_total", reason="unauthorized") == 1


# --- stopping

class Watcher(threading.Thread):
    """Reads a job's events in the background: SSE to its end."""

    def __init__(self, server, job):
        super().__init__()
        self.server, self.job, self.events = server, job, None
        self.start()

    def run(self):
        self.events = self.server.events(self.job["id"])


def niceness_by_thread(server):
    niceness = {}
    for task in pathlib.Path(f"/proc/{server.process.pid}/task").iterdir():
        name = (task / "comm").read_text(encoding="ascii").strip()
        niceness.setdefault(name, set()).add(os.getpriority(os.PRIO_PROCESS, int(task.name)))
    return niceness


def test_workers_give_way_to_the_threads_that_answer(make_server):
    server = make_server(workers=2)
    own = os.getpriority(os.PRIO_PROCESS, 0)
    # A thread has the name and niceness of the one that started it until it first runs.
    wait_until(lambda: niceness_by_thread(server).get("worker") == {own + 5})
    for name in ("store", "pool"):
        wait_until(lambda name=name: niceness_by_thread(server).get(name) == {own})
    assert niceness_by_thread(server)["modelsynthd"] == {own}


def test_a_drain_lets_running_jobs_end_and_turns_new_ones_away(make_server):
    server = make_server("--drain-delay", 1, "--drain-timeout", 600, workers=1)
    running = server.submit(parameters=SOME_SECONDS)
    queued = server.submit(size=(8, 6, 8))
    wait_until(lambda: server.get(running["urls"]["self"]).json()["state"] == "running")
    watcher = Watcher(server, running)
    idle = Watcher(server, queued)
    client = WebSocketClient(server.port, queued["urls"]["stream"])
    wait_until(lambda: metrics_text.value(metrics_of(server), "modelsynth_connections") >= 4)
    server.process.send_signal(signal.SIGTERM)
    wait_until(lambda: server.get("/readyz").status == 503)
    assert_problem(server.get("/readyz"), 503, "draining")
    refused = server.request("POST", "/v1/jobs", job_request())
    assert_problem(refused, 503, "draining")
    assert int(refused.headers["retry-after"]) >= 1
    alive = server.get("/healthz")
    assert alive.status == 200 and alive.headers["connection"] == "close"
    frames = [client.receive(timeout=60) for _ in range(2)]
    assert frames[0].opcode == TEXT and json.loads(frames[0].payload)["type"] == "queued"
    assert frames[1].opcode == CLOSE and frames[1].close_code == 1001
    client.answer_close(frames[1])
    assert server.process.wait(timeout=60) == 0
    watcher.join()
    assert watcher.events[-1]["type"] == "succeeded"
    idle.join()
    assert [event["type"] for event in idle.events] == ["queued"]
    server.start()
    assert server.get(running["urls"]["self"]).json()["state"] == "succeeded"
    assert server.wait(queued["id"])["state"] == "succeeded"


def test_a_job_that_does_not_end_in_time_goes_on_after_the_next_start(make_server):
    server = make_server("--drain-timeout", 1, workers=1)
    job = server.submit(parameters=ENDLESS)
    wait_until(lambda: server.get(job["urls"]["self"]).json()["progress"]["blocks_done"] > 0)
    watcher = Watcher(server, job)
    wait_until(lambda: metrics_text.value(metrics_of(server), "modelsynth_connections") >= 2)
    assert server.stop() == 0
    watcher.join()
    assert {event["type"] for event in watcher.events} == {"queued", "started", "block"}
    server.start()
    again = server.get(job["urls"]["self"]).json()
    assert again["state"] in ("queued", "running")
    # What the watcher was told is what there is: it was told all before the stream ended.
    assert again["progress"]["blocks_done"] >= watcher.events[-1]["blocks_done"]
    server.request("POST", job["urls"]["cancel"])
    assert server.wait(job["id"])["state"] == "cancelled"


def test_a_second_signal_does_not_wait(make_server):
    server = make_server("--drain-timeout", 600, workers=1)
    job = server.submit(parameters=ENDLESS)
    wait_until(lambda: server.get(job["urls"]["self"]).json()["state"] == "running")
    server.process.send_signal(signal.SIGTERM)
    wait_until(lambda: server.get("/readyz").status == 503)
    server.process.send_signal(signal.SIGTERM)
    assert server.process.wait(timeout=60) != 0


# --- room on the disk

def test_what_exceeds_the_bytes_that_may_be_kept_expires_first(make_server):
    server = make_server("--data-bytes-max", 1)
    job = server.submit(size=(8, 6, 8))
    server.wait(job["id"])
    wait_until(lambda: server.get(job["urls"]["model"]).status == 410)
    assert_problem(server.get(job["urls"]["model"]), 410, "expired")
    wait_until(lambda: metrics_text.value(metrics_of(server), "modelsynth_artifact_bytes") == 0)
    assert server.events(job["id"])[-1]["type"] == "succeeded"


def test_a_disk_that_is_nearly_full_takes_no_work_but_answers(make_server):
    server = make_server("--disk-free-min", 1 << 50)
    ready = server.get("/readyz")
    assert_problem(ready, 503, "unavailable")
    assert "retry-after" in ready.headers
    assert_problem(server.request("POST", "/v1/jobs", job_request()), 503, "unavailable")
    assert_problem(server.request("POST", "/v1/examples", STRIPES), 503, "unavailable")
    assert server.get("/v1/examples/castle").status == 200
    assert server.get("/healthz").status == 200


def test_ended_jobs_are_forgotten_after_their_time(make_server):
    server = make_server("--retention-hours", 0.001, "--forget-hours", 0.001)
    job = server.submit(size=(8, 6, 8))
    server.wait(job["id"])
    # At the latest the next start looks for what has had its time.
    wait_until(lambda: server.get(job["urls"]["model"]).status == 410)
    server.stop()
    server.start()
    wait_until(lambda: server.get(job["urls"]["self"]).status == 404)

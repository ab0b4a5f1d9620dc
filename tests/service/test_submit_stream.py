"""Submitting with Accept: text/event-stream, and what becomes of jobs whose submitter goes away."""

import json
import socket

import pytest

from checks import STRIPES, assert_problem, endless_job, job_request, state_of, wait_until
from event_reader import EventReader, texts
from workload import ENDLESS_JOB, SMALL_JOB


def request_of(job, **more):
    return {"solver": "discrete", "example": job["example"], "seed": 3, **more,
            "parameters": {"size": job["size"], **job["parameters"]}}


def submit_and_watch(server, request, **headers):
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    return EventReader(server.port, None, submission=request, headers=named)


def job_of(server, reader):
    return server.get(reader.headers["location"]).json()


def test_the_answer_is_the_stream_of_the_job_from_its_first_event(server):
    with submit_and_watch(server, request_of(SMALL_JOB)) as reader:
        assert reader.status == 200
        assert reader.headers["content-type"] == "text/event-stream"
        assert reader.headers["cache-control"] == "no-store"
        events = reader.rest()
    job = job_of(server, reader)
    assert job["state"] == "succeeded"
    with EventReader(server.port, job["id"]) as again:
        assert texts(again.rest()) == texts(events)


def test_a_wait_beside_it_is_not_applied(server):
    with submit_and_watch(server, job_request(), Prefer="wait=0") as reader:
        assert reader.status == 200 and "preference-applied" not in reader.headers
        assert reader.rest()[-1]["type"] == "succeeded"


@pytest.mark.parametrize(("accept", "as_events"), [
    ("text/event-stream", True), ("Text/Event-Stream", True), ("text/event-stream;q=0.5", True),
    ("text/event-stream, */*", True), ("text/event-stream, application/json", True),
    ("application/json;q=0.9, text/event-stream", True), ("*/*", False), ("text/*", False),
    ("application/json", False), ("application/json, text/event-stream", False),
    ("text/event-stream;q=0.1, application/json", False), ("text/event-stream;q=0", False),
    ("text/event-streams", False), ("", False)])
def test_accept_decides(server, accept, as_events):
    answer = server.request("POST", "/v1/jobs", job_request(), headers={"Accept": accept})
    assert answer.status == (200 if as_events else 202)
    kind = "text/event-stream" if as_events else "application/json"
    assert answer.headers["content-type"] == kind
    assert server.wait(answer.headers["location"].rsplit("/", 1)[1])["state"] == "succeeded"


def test_what_is_refused_is_refused_with_a_problem(server):
    answer = server.request("POST", "/v1/jobs", job_request({"size": [0, 1, 1]}),
                            headers={"Accept": "text/event-stream"})
    assert_problem(answer, 422, "invalid-request")


def test_the_same_key_gives_the_same_stream_again(server):
    request = request_of(SMALL_JOB)
    with submit_and_watch(server, request, Idempotency_Key="stream-1") as first:
        events = first.rest()
    with submit_and_watch(server, request, Idempotency_Key="stream-1") as again:
        assert again.headers["location"] == first.headers["location"]
        assert again.headers["idempotent-replayed"] == "true"
        assert texts(again.rest()) == texts(events)
    other = server.request("POST", "/v1/jobs", {**request, "seed": 4}, headers={
        "Accept": "text/event-stream", "Idempotency-Key": "stream-1"})
    assert_problem(other, 422, "idempotency-conflict")


# --- whoever leaves


def leave(server, prefer=None, key=None, after=b""):
    """Submits an endless job, leaves while it runs, and gives the job."""
    known = {job["id"] for job in server.get("/v1/jobs").json()["items"]}
    body = json.dumps(request_of(ENDLESS_JOB)).encode()
    head = {"Host": "x", "Content-Length": len(body), "Prefer": prefer, "Idempotency-Key": key,
            "Accept": None if prefer else "text/event-stream"}
    fields = "".join(f"{name}: {value}\r\n" for name, value in head.items() if value is not None)
    with socket.create_connection(("127.0.0.1", server.port), timeout=10) as client:
        client.sendall(f"POST /v1/jobs HTTP/1.1\r\n{fields}\r\n".encode() + body + after)
        return wait_until(lambda: next(
            (job for job in server.get("/v1/jobs?state=running").json()["items"]
             if job["id"] not in known), None))


@pytest.mark.parametrize("prefer", [None, "wait=60"], ids=["stream", "wait"])
def test_a_submitter_who_leaves_leaves_no_work_behind(server, prefer):
    job = leave(server, prefer)
    with EventReader(server.port, job["id"]) as watcher:  # whoever else watches
        assert watcher.rest()[-1]["type"] == "cancelled"


def test_one_who_had_sent_more_than_the_request_counts_as_gone_too(server):
    job = leave(server, "wait=60", after=b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
    assert server.wait(job["id"])["state"] == "cancelled"


@pytest.mark.parametrize("prefer", [None, "wait=60"], ids=["stream", "wait"])
def test_a_submitter_with_a_key_who_leaves_finds_the_job_going_on(server, prefer):
    job = leave(server, prefer, key=f"leaver-{prefer}")
    # Time for the server to notice; one without a key leaves after it and is gone before.
    other = leave(server)
    assert server.wait(other["id"])["state"] == "cancelled"
    assert state_of(server, job) == "running"
    server.request("DELETE", f"/v1/jobs/{job['id']}")


def test_a_submitter_who_leaves_while_the_job_is_queued_leaves_none(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        with submit_and_watch(server, request_of(SMALL_JOB)) as reader:
            assert reader.next()["type"] == "queued"
        assert server.wait(job_of(server, reader)["id"])["state"] == "cancelled"


def test_a_wait_whose_time_is_up_cancels_nothing(server):
    answer = server.request("POST", "/v1/jobs", request_of(ENDLESS_JOB),
                            headers={"Prefer": "wait=1"})
    assert answer.status == 202  # the connection is closed by now
    other = leave(server)
    assert server.wait(other["id"])["state"] == "cancelled"
    assert state_of(server, answer.json()) == "running"
    server.request("DELETE", answer.headers["location"])


def test_who_leaves_the_events_of_another_submission_cancels_nothing(server):
    with endless_job(server) as job:
        with EventReader(server.port, job["id"]) as reader:
            reader.next()
        other = leave(server)
        assert server.wait(other["id"])["state"] == "cancelled"
        assert state_of(server, job) == "running"


def test_a_server_that_stops_cancels_nothing(make_server):
    server = make_server()
    streaming = submit_and_watch(server, request_of(ENDLESS_JOB))
    streaming.until_event(lambda event: event["type"] == "block")
    assert server.stop() == 0
    server.start()
    with streaming:
        assert streaming.rest()[-1]["type"] == "block"
    job = job_of(server, streaming)
    assert job["state"] in ("queued", "running")
    server.request("DELETE", streaming.headers["location"])


# --- cancelling frees the worker


def test_cancelling_a_running_job_lets_the_next_one_start(make_server):
    """How soon, tests/load/cancel.py measures; here it must only come about."""
    server = make_server(workers=1)
    big = server.submit((300, 10, 300), parameters={"blocks": {"size": [20, 10, 20]}})
    wait_until(lambda: state_of(server, big) == "running")
    following = server.submit(STRIPES["size"], example=STRIPES)
    with EventReader(server.port, following["id"]) as reader:
        assert reader.next()["type"] == "queued"
        assert server.request("POST", f"/v1/jobs/{big['id']}/cancel").status == 200
        assert reader.rest()[-1]["type"] == "succeeded"
    # It need not have waited for the end of the one before it, whose worker may linger.
    wait_until(lambda: state_of(server, big) == "cancelled")

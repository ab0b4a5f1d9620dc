"""Jobs over HTTP: submitting, reading, listing, cancelling, deleting, and what they make."""

import json
import re
import socket

import pytest

from checks import (ENDED, ENDLESS, HILLS, STRIPES, Grid, assert_faults, assert_fits,
                    assert_problem, box_places, compact, endless_job, files_of, job_request,
                    make_job, make_model, pointers, resolves, short, state_of, together, wait_until)

TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")
SEED_MAX = 2**53 - 1
SIDE_NAMES = ["bottom", "top", "north", "south", "west", "east"]


def post(server, body, **headers):
    return server.request("POST", "/v1/jobs", body,
                          headers={name.replace("_", "-"): value
                                   for name, value in headers.items()})


# --- submitting

def test_a_submitted_job_is_accepted_with_its_place_and_the_whole_job(server):
    answer = post(server, job_request(tags={"level": "3"}, priority=2, deadline=30.0))
    assert answer.status == 202
    job = answer.json()
    assert answer.headers["location"] == job["urls"]["self"] == f"/v1/jobs/{job['id']}"
    assert re.fullmatch(r"[A-Za-z0-9_-]+", job["id"])
    assert job["state"] in ("queued", "running", "succeeded")
    assert job["solver"] == "discrete" and job["seed"] == 1
    assert job["result"] is None or job["state"] == "succeeded"
    assert job["error"] is None
    assert TIME.fullmatch(job["created"])
    for name in ("self", "events", "stream", "model", "cancel"):
        assert job["urls"][name].startswith(f"/v1/jobs/{job['id']}")
    server.wait(job["id"])


def test_a_finished_job_tells_its_times_progress_and_result(server):
    job = make_job(server, {"size": [12, 2, 12]})
    assert job["state"] == "succeeded"
    for name in ("created", "started", "finished", "expires"):
        assert TIME.fullmatch(job[name]), name
    assert job["created"] <= job["started"] <= job["finished"] < job["expires"]
    assert job["progress"]["blocks_done"] == job["progress"]["blocks_total"] > 0
    assert job["progress"]["fraction"] == 1
    assert job["queue"] is None and job["error"] is None
    result = job["result"]
    assert result["model"] == job["urls"]["model"]
    assert re.fullmatch(r"[0-9a-f]{64}", result["sha256"])
    stats = result["stats"]
    assert stats["blocks_accepted"] + stats["blocks_reverted"] == job["progress"]["blocks_total"]
    assert 0 <= stats["changed"] <= 1
    assert stats["solve_seconds"] >= 0
    assert server.get(job["urls"]["self"]).json() == job


def test_a_request_with_only_solver_and_example_gets_every_default_filled_in(server):
    answer = post(server, {"solver": "discrete", "example": "castle"})
    assert answer.status == 202
    echo = answer.json()["request"]
    server.request("DELETE", answer.headers["location"])
    assert echo["solver"] == "discrete" and echo["example"] == "castle"
    assert 0 <= echo["seed"] <= SEED_MAX and echo["seed"] == answer.json()["seed"]
    assert echo["priority"] == 0 and echo["tags"] == {}
    parameters = echo["parameters"]
    assert set(parameters) == {"size", "blocks", "boundary", "order", "weights", "constraints"}
    assert len(parameters["size"]) == 3
    assert set(parameters["blocks"]) == {"size", "overlap", "passes", "attempts"}
    assert set(parameters["boundary"]) == set(SIDE_NAMES)
    assert parameters["constraints"] == []


def test_the_default_boundary_is_that_of_the_example(server):
    example = {**STRIPES, "boundary": {"bottom": "example", "top": "air", "north": "free",
                                       "south": "free", "west": "red", "east": ["red", "green"]}}
    job = make_job(server, example=example)
    boundary = job["request"]["parameters"]["boundary"]
    as_list = {side: [what] if what in ("air", "red") else what
               for side, what in boundary.items()}
    assert as_list == {**example["boundary"], "top": ["air"], "west": ["red"]}


def test_requests_without_a_seed_get_different_ones(server):
    request = job_request()
    del request["seed"]
    seeds = {post(server, request).json()["seed"] for _ in range(4)}
    assert len(seeds) == 4
    assert all(0 <= seed <= SEED_MAX for seed in seeds)


@pytest.mark.parametrize("seed", [0, 1, SEED_MAX])
def test_a_seed_is_kept_to_the_last_digit(server, seed):
    job = make_job(server, seed=seed)
    assert job["seed"] == job["request"]["seed"] == seed


@pytest.mark.parametrize("request_", [
    {"solver": "discrete", "example": "castle", "parameters": {"size": [14, 5, 11]}},
    job_request({"size": [9, 2, 7], "order": "random", "weights": {"red": 3.5}}),
    job_request({"blocks": None, "boundary": {"west": ["air", "red"], "east": "free"}}),
    job_request({"constraints": [{"kind": "fixed", "pieces": ["green", "blue"],
                                  "box": {"min": [0, 0, 0], "max": [1, 1, 4]},
                                  "cells": [[0, 0, 3]]}]}),
    job_request({"blocks": {"overlap": 0.25}}, priority=-3, deadline=45.5, tags={"a/b": "ü"}),
], ids=["built-in", "weights", "at once", "constraint", "tags"])
def test_the_echoed_request_makes_the_same_model_again(server, request_):
    first = post(server, request_, Prefer="wait=60").json()
    assert first["state"] == "succeeded", first
    again = post(server, first["request"], Prefer="wait=60").json()
    assert again["state"] == "succeeded", again
    assert again["id"] != first["id"]
    assert again["request"] == first["request"]
    assert again["result"]["sha256"] == first["result"]["sha256"]


def test_tags_priority_and_deadline_are_echoed(server):
    tags = {"level": "3", "naïve/~key": "日本\n\"quoted\"", "": "empty name"}
    job = make_job(server, tags=tags, priority=-10, deadline=0.5)
    assert job["request"]["tags"] == tags
    assert job["request"]["priority"] == -10
    assert job["request"]["deadline"] == 0.5


def test_ids_sort_by_time(server):
    ids = [post(server, job_request()).json()["id"] for _ in range(12)]
    assert ids == sorted(ids) and len(set(ids)) == len(ids)


def test_whole_numbers_may_be_written_with_a_fraction_of_zero(server):
    job = make_job(server, {"size": [6.0, 2, 4]}, seed=5.0, priority=1.0)
    assert job["request"]["parameters"]["size"] == [6, 2, 4] and job["seed"] == 5


# --- Prefer: wait (RFC 7240)

@pytest.mark.parametrize(("preference", "applied"), [
    ("wait=20", "wait=20"), ("wait=60", "wait=60"), ("wait=61", "wait=60"),
    ("wait=86400", "wait=60"), ("wait=99999999999999999999999", "wait=60"),
    ("respond-async, wait=9", "wait=9"), ("wait = 9", "wait=9"), ("wait=9; foo=bar", "wait=9"),
    ("Wait=9", "wait=9"),
])
def test_a_preference_to_wait_is_applied_and_capped(server, preference, applied):
    answer = post(server, job_request(), Prefer=preference)
    assert answer.status == 200, answer.body
    assert answer.headers["preference-applied"] == applied
    assert answer.json()["state"] == "succeeded"
    assert answer.headers["location"] == answer.json()["urls"]["self"]


@pytest.mark.parametrize("preference", [
    "wait", "wait=", "wait=soon", "wait=-1", "wait=1.5", "waits=5", "return=minimal", ",", "=",
    "xwait=5", 'foo="a,wait=5,b"',
])
def test_a_malformed_or_other_preference_is_ignored(server, preference):
    answer = post(server, job_request(), Prefer=preference)
    assert answer.status == 202
    assert "preference-applied" not in answer.headers
    server.wait(answer.json()["id"])


def test_waiting_ends_with_202_when_the_time_is_up(server):
    answer = post(server, {"solver": "discrete", "example": "castle", "parameters": ENDLESS},
                  Prefer="wait=0")
    assert answer.status == 202 and answer.headers["preference-applied"] == "wait=0"
    assert answer.json()["state"] in ("queued", "running")
    server.request("DELETE", answer.headers["location"])


def test_a_job_that_fails_while_waited_for_is_answered_with_200(server):
    job = make_job(server, {"boundary": {"bottom": "red", "top": "air"}, "size": [3, 1, 3]})
    assert job["state"] == "failed" and job["result"] is None
    assert job["error"]["type"] == "/problems/contradiction"


def test_a_client_that_stops_waiting_and_gave_a_key_leaves_the_job_in_the_queue(make_server):
    """Without a key: see test_submit_stream.py."""
    server = make_server(workers=1)
    with endless_job(server):
        body = compact(job_request())
        with socket.create_connection(("127.0.0.1", server.port), timeout=10) as client:
            client.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: x\r\nPrefer: wait=60\r\n"
                           b"Idempotency-Key: waiter-1\r\n"
                           b"Content-Length: %d\r\n\r\n" % len(body) + body)
            job = wait_until(lambda: next(
                iter(server.get("/v1/jobs?state=queued").json()["items"]), None))
        assert state_of(server, job) == "queued"
    assert server.wait(job["id"])["state"] == "succeeded"


# --- Idempotency-Key

def test_a_retry_with_the_same_key_gets_the_first_answer(server):
    request = job_request(tags={"test": "retry"})
    del request["seed"]
    first = post(server, request, Idempotency_Key="retry-1")
    again = post(server, dict(reversed(request.items())), Idempotency_Key="retry-1")
    assert (first.status, again.status) == (202, 202)
    assert again.json()["id"] == first.json()["id"]
    assert again.json()["seed"] == first.json()["seed"]
    assert again.headers["location"] == first.headers["location"]
    assert again.headers["idempotent-replayed"] == "true"
    assert "idempotent-replayed" not in first.headers


def test_a_quoted_key_and_a_bare_one_are_the_same_key(server):
    first = post(server, job_request(), Idempotency_Key='"quoted-1"')
    again = post(server, job_request(), Idempotency_Key="quoted-1")
    assert again.json()["id"] == first.json()["id"]


def test_the_same_key_with_another_body_is_a_conflict(server):
    first = post(server, job_request(seed=1), Idempotency_Key="conflict-1")
    assert first.status == 202
    assert_problem(post(server, job_request(seed=2), Idempotency_Key="conflict-1"), 422,
                   "idempotency-conflict", "/v1/jobs")
    assert post(server, job_request(seed=1), Idempotency_Key="conflict-1").json()["id"] == \
        first.json()["id"]


def test_another_key_or_none_makes_another_job(server):
    ids = [post(server, job_request(), **headers).json()["id"] for headers in
           ({"Idempotency_Key": "a-1"}, {"Idempotency_Key": "a-2"}, {}, {})]
    assert len(set(ids)) == 4


@pytest.mark.parametrize("key", ["", '""', "two words", "é", "k" * 256], ids=short)
def test_a_key_that_is_none_is_refused(server, key):
    assert_problem(post(server, job_request(), Idempotency_Key=key.encode("utf-8")), 400)


def test_a_key_of_255_characters_is_taken(server):
    assert post(server, job_request(), Idempotency_Key="k" * 255).status == 202


def test_a_refused_request_does_not_use_its_key_up(server):
    assert post(server, job_request(seed=-1), Idempotency_Key="refused-1").status == 422
    answer = post(server, job_request(), Idempotency_Key="refused-1")
    assert answer.status == 202 and "idempotent-replayed" not in answer.headers


def test_a_key_is_free_again_once_its_job_is_deleted(server):
    first = post(server, job_request(), Idempotency_Key="deleted-1")
    assert server.request("DELETE", first.headers["location"]).status == 204
    second = post(server, job_request(seed=3), Idempotency_Key="deleted-1")
    assert second.status == 202 and second.json()["id"] != first.json()["id"]


def test_a_retry_is_replayed_although_its_example_was_deleted_since(server):
    example = {**STRIPES, "name": "stripes to forget"}
    example_id = server.request("POST", "/v1/examples", example).json()["id"]
    request = job_request(example=example_id)
    first = post(server, request, Idempotency_Key="forgotten-1", Prefer="wait=60")
    assert first.json()["state"] == "succeeded"
    assert server.request("DELETE", f"/v1/examples/{example_id}").status == 204
    again = post(server, request, Idempotency_Key="forgotten-1")
    assert again.status == 202, again.body
    assert again.json()["id"] == first.json()["id"]


def test_a_retry_is_replayed_although_the_queue_is_full(make_server):
    server = make_server("--queue-max", 1, workers=1)
    with endless_job(server):
        first = post(server, job_request(), Idempotency_Key="full-1")
        assert first.status == 202
        assert post(server, job_request(), Idempotency_Key="full-2").status == 503
        assert post(server, job_request(), Idempotency_Key="full-1").json()["id"] == \
            first.json()["id"]
    # It stands in the queue until a worker has seen that the other one ended.
    server.wait(first.json()["id"])
    # The refusal was not kept under its key.
    answer = post(server, job_request(), Idempotency_Key="full-2", Prefer="wait=60")
    assert answer.status == 200


def test_twenty_clients_racing_with_one_key_make_one_job(make_server):
    server = make_server()
    answers = together(20, lambda _: post(server, job_request(), Idempotency_Key="race"))
    assert {answer.status for answer in answers} == {202}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert sum("idempotent-replayed" in answer.headers for answer in answers) == 19
    assert len(server.get("/v1/jobs?limit=100").json()["items"]) == 1


# --- listing

@pytest.fixture(scope="module")
def listed(tmp_path_factory):
    """A server with 23 finished, 4 failed, 3 cancelled jobs, and their ids, oldest first."""
    from conftest import Server
    server = Server(tmp_path_factory.mktemp("list") / "data").start()
    try:
        jobs = [make_job(server, {"size": [4, 2, 4]}, seed=seed) for seed in range(23)]
        jobs += [make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}})
                 for _ in range(4)]
        for _ in range(3):
            with endless_job(server, wait_running=False) as job:
                pass
            jobs.append(job)
        yield server, [job["id"] for job in jobs]
    finally:
        server.kill()


def read_pages(server, query):
    ids = []
    cursor = None
    for _ in range(100):
        page = server.get(f"/v1/jobs?{query}" + (f"&cursor={cursor}" if cursor else "")).json()
        assert set(page) == {"items", "next"}
        ids.append([job["id"] for job in page["items"]])
        cursor = page["next"]
        if cursor is None:
            return ids
    raise AssertionError("the pages do not end")


def test_the_list_is_newest_first_twenty_at_a_time(listed):
    server, ids = listed
    page = server.get("/v1/jobs").json()
    assert [job["id"] for job in page["items"]] == ids[:-21:-1]
    assert isinstance(page["next"], str)


@pytest.mark.parametrize("limit", [1, 7, 15, 30, 100])
def test_all_pages_together_are_all_jobs_once(listed, limit):
    server, ids = listed
    pages = read_pages(server, f"limit={limit}")
    assert [job for page in pages for job in page] == ids[::-1]
    assert all(len(page) == limit for page in pages[:-1])
    assert 0 < len(pages[-1]) <= limit


@pytest.mark.parametrize(("state", "span"), [
    ("succeeded", (0, 23)), ("failed", (23, 27)), ("cancelled", (27, 30)), ("queued", (0, 0)),
    ("running", (0, 0))])
def test_the_list_can_be_filtered_by_state(listed, state, span):
    server, ids = listed
    pages = read_pages(server, f"state={state}&limit=5")
    assert [job for page in pages for job in page] == ids[span[0]:span[1]][::-1]


def test_an_item_of_the_list_is_the_job(listed):
    server, ids = listed
    items = {job["id"]: job for job in server.get("/v1/jobs?limit=100").json()["items"]}
    for job_id in (ids[0], ids[24], ids[29]):
        assert items[job_id] == server.get(f"/v1/jobs/{job_id}").json()


def test_a_cursor_stays_where_it_is_when_jobs_come_and_go(make_server):
    server = make_server()
    ids = [make_job(server, {"size": [4, 2, 4]})["id"] for _ in range(6)]
    page = server.get("/v1/jobs?limit=2").json()
    make_job(server, {"size": [4, 2, 4]})
    server.request("DELETE", f"/v1/jobs/{ids[4]}")  # the one the cursor was made from
    rest = server.get(f"/v1/jobs?limit=10&cursor={page['next']}").json()
    assert [job["id"] for job in rest["items"]] == ids[3::-1]


@pytest.mark.parametrize(("query", "status"), [
    ("limit=0", 422), ("limit=101", 422), ("limit=-1", 422), ("limit=ten", 400), ("limit=", 400),
    ("limit=1.5", 400), ("limit=99999999999999999999", 422), ("cursor=%21%21", 400),
    ("cursor=not-a-cursor", 400), ("state=done", 422), ("state=", 422), ("State=failed", 400),
    ("bogus=1", 400), ("limit=1&limit=2", 400), ("limit=%zz", 400),
])
def test_a_wrong_query_is_refused_not_ignored(server, query, status):
    answer = server.get(f"/v1/jobs?{query}")
    assert_problem(answer, status, instance="/v1/jobs")


# --- reading, cancelling, deleting

UNKNOWN = ["00000000000000000000000000", "nope", "..", "%2e%2e%2f%2e%2e", "%ff%fe", "a" * 3000,
           "%22%3E", "x%20y"]


@pytest.mark.parametrize("path", ["", "/model.glb", "/preview.glb", "/labels.json", "/events"])
@pytest.mark.parametrize("job_id", UNKNOWN, ids=short)
def test_an_unknown_job_is_not_found(server, job_id, path):
    assert_problem(server.get(f"/v1/jobs/{job_id}{path}"), 404, "not-found",
                   f"/v1/jobs/{job_id}{path}")


@pytest.mark.parametrize("job_id", UNKNOWN[:3])
def test_an_unknown_job_cannot_be_cancelled_or_deleted(server, job_id):
    assert_problem(server.request("POST", f"/v1/jobs/{job_id}/cancel"), 404, "not-found")
    assert_problem(server.request("DELETE", f"/v1/jobs/{job_id}"), 404, "not-found")


def test_a_queued_job_is_cancelled_at_once(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        queued = post(server, job_request()).json()
        assert queued["state"] == "queued" and queued["queue"]["position"] == 0
        answer = server.request("POST", queued["urls"]["cancel"])
        assert answer.status == 200
        job = answer.json()
        assert job["state"] == "cancelled" and job["started"] is None
        assert TIME.fullmatch(job["finished"])
        assert job["queue"] is None and job["result"] is None and job["error"] is None
        types = [event["type"] for event in server.events(job["id"])]
        assert types == ["queued", "cancelled"]


@pytest.mark.parametrize("parameters", [ENDLESS, {"size": [160, 40, 160], "blocks": None}],
                         ids=["between blocks", "inside one block"])
def test_a_running_job_is_cancelled_within_the_answer(server, parameters):
    job = post(server, {"solver": "discrete", "example": "castle",
                        "parameters": parameters}).json()
    wait_until(lambda: state_of(server, job) == "running")
    answer = server.request("POST", job["urls"]["cancel"])
    assert answer.status == 200
    assert answer.json()["state"] == "cancelled", "the worker did not let go within a second"
    assert server.get(job["urls"]["self"]).json() == answer.json()
    assert_problem(server.get(job["urls"]["model"]), 409)


@pytest.mark.parametrize("how", ["succeeded", "failed", "cancelled"])
def test_cancelling_an_ended_job_changes_nothing(listed, how):
    server, _ = listed
    job = server.get(f"/v1/jobs?state={how}&limit=1").json()["items"][0]
    events = server.events(job["id"])
    answer = server.request("POST", job["urls"]["cancel"])
    assert answer.status == 200 and answer.json() == job
    assert server.get(job["urls"]["self"]).json() == job
    assert server.events(job["id"]) == events


@pytest.mark.parametrize("was_running", [True, False], ids=["running", "queued"])
def test_a_cancelled_job_tells_when_it_expires(make_server, was_running):
    server = make_server(workers=1)
    with endless_job(server) as running:
        queued = post(server, job_request()).json()
        job = running if was_running else queued
        server.request("POST", job["urls"]["cancel"])
        assert TIME.fullmatch(server.wait(job["id"])["expires"] or "never")


def test_cancel_against_completion_has_one_outcome(server):
    def submit_and_cancel(number):
        job = post(server, job_request({"size": [12, 2, 12]}, seed=number)).json()
        for _ in range(number % 4):
            server.get(job["urls"]["self"])
        answer = server.request("POST", job["urls"]["cancel"])
        assert answer.status == 200
        return job["id"]

    for job_id in together(16, submit_and_cancel):
        job = server.wait(job_id)
        ends = [event["type"] for event in server.events(job_id) if event["type"] in ENDED]
        assert ends == [job["state"]] and job["state"] in ("succeeded", "cancelled")
        assert (job["result"] is not None) == (job["state"] == "succeeded")


@pytest.mark.parametrize("state", ["running", "queued", "succeeded", "failed", "cancelled"])
def test_a_deleted_job_is_gone_with_its_events(make_server, state):
    server = make_server(workers=1)
    if state in ("running", "queued"):
        with endless_job(server, wait_running=True) as running:
            job = running if state == "running" else post(server, job_request()).json()
            assert state_of(server, job) == state
            answer = server.request("DELETE", job["urls"]["self"])
            assert_gone(server, job, answer)
        # The worker is free again.
        assert make_job(server)["state"] == "succeeded"
        return
    if state == "cancelled":
        with endless_job(server) as job:
            pass
    else:
        job = make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}}
                       if state == "failed" else {})
    assert state_of(server, job) == state
    assert_gone(server, job, server.request("DELETE", job["urls"]["self"]))
    wait_until(lambda: not files_of(server, "artifacts", "tmp"))


def assert_gone(server, job, answer):
    assert answer.status == 204 and answer.body == b""
    for path in job["urls"].values():
        if not path.endswith(("stream", "cancel")):
            assert_problem(server.get(path), 404, "not-found", path)
    assert_problem(server.request("POST", job["urls"]["cancel"]), 404, "not-found")
    assert_problem(server.request("DELETE", job["urls"]["self"]), 404, "not-found")
    assert job["id"] not in [item["id"] for item in server.get("/v1/jobs").json()["items"]]


def test_jobs_deleted_at_any_moment_leave_no_file_behind(make_server):
    server = make_server()

    def submit_and_delete(number):
        for turn in range(6):
            job = post(server, job_request({"size": [20, 2, 20]}, seed=6 * number + turn)).json()
            for _ in range((number + turn) % 8):
                server.get(f"{job['urls']['model']}?profile={['nodes', 'merged'][turn % 2]}")
            assert server.request("DELETE", job["urls"]["self"]).status == 204

    together(8, submit_and_delete)
    make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}})
    assert server.get("/v1/jobs?state=running").json()["items"] == []
    wait_until(lambda: not files_of(server, "artifacts", "tmp"), timeout=3)


def test_deleting_a_job_removes_only_artifacts_that_no_other_job_shares(make_server):
    server = make_server()
    first, second = make_job(server, seed=4), make_job(server, seed=4)
    assert first["result"]["sha256"] == second["result"]["sha256"]
    for profile in ("instanced", "merged"):
        assert server.get(f"{first['urls']['model']}?profile={profile}").status == 200
    both = files_of(server, "artifacts")
    assert len(both) >= 3
    assert server.request("DELETE", first["urls"]["self"]).status == 204
    assert server.get(second["urls"]["model"]).status == 200
    assert server.get(second["urls"]["labels"]).status == 200
    assert server.request("DELETE", second["urls"]["self"]).status == 204
    wait_until(lambda: not files_of(server, "artifacts", "tmp"))


# --- the queue

def test_a_full_queue_is_refused_with_when_to_come_back(make_server):
    server = make_server("--queue-max", 2, workers=1)
    with endless_job(server):
        assert server.get("/readyz").status == 200
        queued = [post(server, job_request()).json() for _ in range(2)]
        assert [job["queue"]["position"] for job in queued] == [0, 1]
        answer = post(server, job_request())
        assert_problem(answer, 503, "queue-full", "/v1/jobs")
        assert 1 <= int(answer.headers["retry-after"]) <= 3600
        ready = server.get("/readyz")
        assert_problem(ready, 503)
        assert int(ready.headers["retry-after"]) >= 1
        assert server.get("/healthz").status == 200
        assert len(server.get("/v1/jobs").json()["items"]) == 3
        server.request("POST", queued[0]["urls"]["cancel"])
        assert server.get("/readyz").status == 200
        assert server.get(queued[1]["urls"]["self"]).json()["queue"]["position"] == 0
        assert post(server, job_request()).status == 202


def test_higher_priority_goes_first_and_equal_ones_in_order_of_arrival(make_server):
    server = make_server(workers=1)
    priorities = [0, -10, 10, 0, 5, -10, 10]
    with endless_job(server):
        jobs = [post(server, job_request(priority=priority)).json() for priority in priorities]
        expected = sorted(jobs, key=lambda job: -job["request"]["priority"])
        positions = {job["id"]: server.get(job["urls"]["self"]).json()["queue"]["position"]
                     for job in jobs}
        assert [positions[job["id"]] for job in expected] == list(range(len(jobs)))
    started = [server.wait(job["id"])["started"] for job in expected]
    assert started == sorted(started)


# --- what is refused

GOOD = job_request()
FIXED = {"kind": "fixed", "pieces": ["red"]}


def with_(**parameters):
    return job_request(parameters)


@pytest.mark.parametrize(("request_", "expected"), [
    ({}, ["/solver", "/example"]),
    ([], [""]), (7, [""]), ("text", [""]), (None, [""]), (True, [""]),
    ({"solver": "discrete"}, ["/example"]),
    ({**GOOD, "solver": "quantum"}, ["/solver"]),
    ({**GOOD, "solver": None}, ["/solver"]),
    ({**GOOD, "example": 7}, ["/example"]),
    ({**GOOD, "example": None}, ["/example"]),
    ({**GOOD, "example": "no such example"}, ["/example"]),
    ({**GOOD, "example": "../../etc/passwd"}, ["/example"]),
    ({**GOOD, "example": "n" * 100_000}, ["/example"]),
    ({**GOOD, "seed": -1}, ["/seed"]), ({**GOOD, "seed": 2**53}, ["/seed"]),
    ({**GOOD, "seed": 2**64}, ["/seed"]), ({**GOOD, "seed": 10**40}, ["/seed"]),
    ({**GOOD, "seed": 1.5}, ["/seed"]), ({**GOOD, "seed": "7"}, ["/seed"]),
    ({**GOOD, "seed": None}, ["/seed"]), ({**GOOD, "seed": True}, ["/seed"]),
    ({**GOOD, "priority": 11}, ["/priority"]), ({**GOOD, "priority": -11}, ["/priority"]),
    ({**GOOD, "priority": 0.5}, ["/priority"]), ({**GOOD, "priority": False}, ["/priority"]),
    ({**GOOD, "deadline": 0}, ["/deadline"]), ({**GOOD, "deadline": -1}, ["/deadline"]),
    ({**GOOD, "deadline": "30"}, ["/deadline"]), ({**GOOD, "deadline": 1e300}, ["/deadline"]),
    ({**GOOD, "tags": []}, ["/tags"]), ({**GOOD, "tags": {"a": 1}}, ["/tags/a"]),
    ({**GOOD, "tags": {"a/b~c": None}}, ["/tags/a~1b~0c"]),
    ({**GOOD, "tags": {str(i): "" for i in range(200)}}, ["/tags"]),
    ({**GOOD, "bogus": 1}, ["/bogus"]), ({**GOOD, "a/b~c": 1}, ["/a~1b~0c"]),
    ({**GOOD, "": 1}, ["/"]), ({**GOOD, "Seed": 1}, ["/Seed"]),
    ({**GOOD, "parameters": None}, ["/parameters"]), ({**GOOD, "parameters": []}, ["/parameters"]),
    (with_(colour="red"), ["/parameters/colour"]),
    (with_(size=[6, 2]), ["/parameters/size"]), (with_(size=[6, 2, 4, 1]), ["/parameters/size"]),
    (with_(size="6x2x4"), ["/parameters/size"]), (with_(size=None), ["/parameters/size"]),
    (with_(size=[0, 2, 4]), ["/parameters/size/0"]), (with_(size=[6, -2, 4]),
                                                      ["/parameters/size/1"]),
    (with_(size=[6, 2, 4.5]), ["/parameters/size/2"]),
    (with_(size=[0, "2", None]), [f"/parameters/size/{i}" for i in range(3)]),
    (with_(size=[2**31, 2**32, 2**64]), [f"/parameters/size/{i}" for i in range(3)]),
    (with_(blocks=5), ["/parameters/blocks"]), (with_(blocks=False), ["/parameters/blocks"]),
    (with_(blocks={"size": [0, 1, 1]}), ["/parameters/blocks/size/0"]),
    (with_(blocks={"overlap": 1}), ["/parameters/blocks/overlap"]),
    (with_(blocks={"overlap": -0.1}), ["/parameters/blocks/overlap"]),
    (with_(blocks={"passes": 0}), ["/parameters/blocks/passes"]),
    (with_(blocks={"attempts": 0}), ["/parameters/blocks/attempts"]),
    (with_(blocks={"attempts": "8"}), ["/parameters/blocks/attempts"]),
    (with_(blocks={"stride": 3}), ["/parameters/blocks/stride"]),
    (with_(boundary=[]), ["/parameters/boundary"]), (with_(boundary="free"),
                                                     ["/parameters/boundary"]),
    (with_(boundary={"up": "free"}), ["/parameters/boundary/up"]),
    (with_(boundary={"top": 3}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": None}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": []}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": ["air", 3]}), ["/parameters/boundary/top/1"]),
    (with_(boundary={"top": ["air", "cloud"]}), ["/parameters/boundary/top/1"]),
    (with_(boundary={"top": "cloud"}), ["/parameters/boundary/top"]),
    (with_(boundary={"west": "periodic"}), ["/parameters/boundary/west"]),
    (with_(boundary={"east": "periodic", "west": "red"}), ["/parameters/boundary/east"]),
    (with_(boundary={"south": "periodic"}), ["/parameters/boundary/south"]),
    (with_(boundary={"top": "periodic"}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": "FREE"}), ["/parameters/boundary/top"]),
    (with_(order="spiral"), ["/parameters/order"]), (with_(order=0), ["/parameters/order"]),
    (with_(order=None), ["/parameters/order"]),
    (with_(weights="heavy"), ["/parameters/weights"]), (with_(weights=1), ["/parameters/weights"]),
    (with_(weights={"red": -1}), ["/parameters/weights/red"]),
    (with_(weights={"red": "1"}), ["/parameters/weights/red"]),
    (with_(weights={"cloud": 1}), ["/parameters/weights/cloud"]),
    (with_(weights={"clo/ud~": 1}), ["/parameters/weights/clo~1ud~0"]),
    (with_(constraints={}), ["/parameters/constraints"]),
    (with_(constraints=[3]), ["/parameters/constraints/0"]),
    (with_(constraints=[{}]), ["/parameters/constraints/0/kind",
                               "/parameters/constraints/0/pieces"]),
    (with_(constraints=[FIXED, {**FIXED, "kind": "glued"}]), ["/parameters/constraints/1/kind"]),
    (with_(constraints=[{**FIXED, "pieces": []}]), ["/parameters/constraints/0/pieces"]),
    (with_(constraints=[{**FIXED, "pieces": "red"}]), ["/parameters/constraints/0/pieces"]),
    (with_(constraints=[{**FIXED, "pieces": ["red", "cloud"]}]),
     ["/parameters/constraints/0/pieces/1"]),
    (with_(constraints=[{**FIXED, "where": []}]), ["/parameters/constraints/0/where"]),
    (with_(constraints=[{**FIXED, "box": {"min": [0, 0, 0]}}]),
     ["/parameters/constraints/0/box/max"]),
    (with_(constraints=[{**FIXED, "box": {"min": [0, 0, 0], "max": [7, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [6, 0, 0], "max": [7, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [2, 0, 0], "max": [2, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [-1, 0, 0], "max": [2, 1, 1]}}]),
     ["/parameters/constraints/0/box/min/0"]),
    (with_(constraints=[{**FIXED, "cells": []}]), ["/parameters/constraints/0/cells"]),
    (with_(constraints=[{**FIXED, "cells": [[0, 0, 0], [0, 2, 0], [0, 0, 4]]}]),
     ["/parameters/constraints/0/cells/1", "/parameters/constraints/0/cells/2"]),
    (with_(constraints=[{**FIXED, "cells": [[0, 0]]}]), ["/parameters/constraints/0/cells/0"]),
], ids=short)
def test_a_wrong_request_is_refused_with_a_pointer_to_each_fault(server, request_, expected):
    before = server.get("/v1/jobs?limit=1").json()["items"]
    answer = post(server, json.dumps(request_))
    problem = assert_faults(answer, request_, expected)
    assert problem["type"] == "/problems/invalid-request"
    assert problem["instance"] == "/v1/jobs"
    assert server.get("/v1/jobs?limit=1").json()["items"] == before


def test_all_faults_of_a_request_are_found_at_once(server):
    request = {
        "solver": "quantum", "example": {**STRIPES, "name": 3}, "seed": -1, "priority": 99,
        "deadline": 0, "tags": {"a": 1}, "bogus": 1,
        "parameters": {
            "size": [0, 1, "2"], "order": 3, "weights": {"red": -1}, "bogus": 1,
            "blocks": {"overlap": 2, "passes": 0}, "boundary": {"top": 3, "up": "free"},
            "constraints": [{"kind": "glued", "pieces": []}]}}
    assert_faults(post(server, request), request, [
        "/solver", "/example/name", "/seed", "/priority", "/deadline", "/tags/a", "/bogus",
        "/parameters/size/0", "/parameters/size/2", "/parameters/order",
        "/parameters/weights/red", "/parameters/bogus", "/parameters/blocks/overlap",
        "/parameters/blocks/passes", "/parameters/boundary/top", "/parameters/boundary/up",
        "/parameters/constraints/0/kind", "/parameters/constraints/0/pieces"])


def test_all_unknown_pieces_of_a_request_are_found_at_once(server):
    request = with_(boundary={"west": ["cloud"], "bottom": ["red", "sea"], "south": "periodic"},
                    weights={"mist": 1}, constraints=[{**FIXED, "pieces": ["fog"]},
                                                      {**FIXED, "cells": [[99, 0, 0]]}])
    assert_faults(post(server, request), request, [
        "/parameters/boundary/west/0", "/parameters/boundary/bottom/1",
        "/parameters/boundary/south", "/parameters/weights/mist",
        "/parameters/constraints/0/pieces/0", "/parameters/constraints/1/cells/0"])


def test_faults_of_form_do_not_hide_faults_of_meaning(server):
    request = {**with_(boundary={"west": ["cloud"]}), "bogus": 1, "seed": -1}
    assert_faults(post(server, request), request,
                  ["/bogus", "/seed", "/parameters/boundary/west/0"])


def test_very_many_faults_are_cut_to_a_list_that_can_be_read(server):
    request = {**GOOD, **{f"bogus{number}": 1 for number in range(1000)}}
    problem = assert_problem(post(server, request), 422, "invalid-request")
    assert 10 <= len(problem["errors"]) <= 50
    assert all(resolves(request, pointer) for pointer in pointers(problem))


@pytest.mark.parametrize("text", ["\x00", "\x1f", "\"", "\\", "\u2028", "\U0001F600", "</script>",
                                  "the limit "], ids=repr)
def test_odd_characters_in_a_name_come_back_whole_in_the_problem(server, text):
    request = with_(weights={text: 1})
    problem = assert_faults(post(server, request), request, [f"/parameters/weights/{text}"
                            .replace("</", "<~1")])
    assert problem["type"] == "/problems/invalid-request"


@pytest.mark.parametrize("parameters", [
    {"size": [4096, 4096, 4096]}, {"size": [4096, 1, 4096]},
    {"size": [200, 10, 200], "blocks": {"size": [1, 1, 1]}},
    {"size": [200, 10, 200], "blocks": {"size": [2, 2, 2], "overlap": 0.95, "passes": 100}},
    {"blocks": {"size": [1, 1, 1], "passes": 100}},
], ids=["cells", "cells of one floor", "blocks", "passes", "blocks at the default size"])
def test_what_passes_a_limit_is_refused_at_once_and_the_limit_is_named(server, parameters):
    request = {"solver": "discrete", "example": "castle", "parameters": parameters}
    answer = post(server, request)
    if answer.status == 202:
        server.request("DELETE", answer.headers["location"])
    problem = assert_problem(answer, 422, "too-large")
    assert re.search(r"_max\b", problem["detail"] + str(problem["errors"]))
    assert all(resolves(request, pointer) for pointer in pointers(problem))


def test_the_limit_of_cells_holds_at_its_edge(make_server):
    server = make_server("--model-cells-max", 48)
    assert post(server, job_request({"size": [6, 2, 4]})).status == 202
    assert_problem(post(server, job_request({"size": [7, 2, 4]})), 422, "too-large")
    request = {"solver": "discrete", "example": "castle"}  # its default size is larger
    assert_problem(post(server, request), 422, "too-large")


# --- malformed JSON

@pytest.mark.parametrize(("body", "byte"), [
    (b"", 0), (b" ", 1), (b"{", 1), (b'{"solver":', 10), (b'{"a":1,}', 7), (b"[1 2]", 3),
    (b'{"a" 1}', 5), (b"{'a':1}", 1), (b"{} {}", 3), (b'{"a":1}x', 7), (b"]", 0), (b"[,1]", 1),
    (b'{"a":1 /* b */}', 7), (b'["a\nb"]', 3), (b'["\\x"]', 3), (b'["\xff"]', 2),
    (b'["\xc0\xaf"]', 2), (b'["\xed\xa0\x80"]', 3), (b'{"a":1}\x00', 7), (b'\x00{"a":1}', 0),
    (b'{"\xc3\xa4\xc3\xb6":,}', 8), (b"\xff\xfe{\x00}\x00", 0),
])
def test_broken_json_is_refused_with_the_byte_where_reading_stopped(server, body, byte):
    problem = assert_problem(post(server, body, Content_Type="application/json"), 400,
                             "malformed-json", "/v1/jobs")
    assert re.search(rf"\b{byte}\b", problem["detail"]), problem


@pytest.mark.parametrize("body", [
    b"nul", b"NaN", b"[Infinity]", b"[+1]", b"[.5]", b"[1.]", b"[0x10]", b"[01]", b"[1e]",
    b'["\\ud800"]', b'["\\u12"]', b'{"a":1,"a":2}', b'{"a":{"b":1,"b":1}}', b"{1:2}",
    b"undefined", b"\x1f\x8b\x08\x00", b"solver=discrete&example=castle", b"<job/>",
])
def test_what_is_no_json_is_refused(server, body):
    assert_problem(post(server, body, Content_Type="application/json"), 400, "malformed-json")


@pytest.mark.parametrize("tail", [b"\x00", b"\x00\x00", b"\x00{", b"\x00 garbage", b"\x1a"])
def test_nothing_may_follow_the_json_not_even_after_a_nul(server, tail):
    answer = post(server, compact(GOOD) + tail, Content_Type="application/json")
    assert_problem(answer, 400, "malformed-json")


@pytest.mark.parametrize("number", [b"1e400", b"-1e400", b"9" * 5000, b"1" + b"0" * 400],
                         ids=short)
def test_a_number_beyond_all_numbers_is_refused(server, number):
    body = compact(GOOD).replace(b'"seed":1', b'"seed":' + number)
    answer = post(server, body, Content_Type="application/json")
    assert answer.status in (400, 422)
    assert_problem(answer, answer.status)


@pytest.mark.parametrize("depth", [10_000, 1_000_000])
@pytest.mark.parametrize(("opening", "closing"), [(b"[", b"]"), (b'{"a":', b"}")])
def test_very_deep_json_is_refused(server, opening, closing, depth):
    body = opening * depth + b"1" + closing * depth
    assert_problem(post(server, body, Content_Type="application/json"), 400, "malformed-json")
    assert_problem(post(server, opening * depth, Content_Type="application/json"), 400)


def test_the_limit_of_depth_holds_at_its_edge(server):
    def nested(depth):
        return compact(GOOD)[:-1] + b',"bogus":' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"

    assert_problem(post(server, nested(64)), 422, "invalid-request")
    assert_problem(post(server, nested(65)), 400, "malformed-json")


def test_more_values_than_are_taken_are_refused(server):
    body = b"[" + b"0," * 1_000_000 + b"0]"
    assert_problem(post(server, body, Content_Type="application/json"), 400, "malformed-json")


# --- what a job makes

FREE = dict.fromkeys(SIDE_NAMES, "free")
PERIODIC_X = {"west": "periodic", "east": "periodic"}
PERIODIC_Z = {"north": "periodic", "south": "periodic"}


@pytest.mark.parametrize("parameters", [
    {"size": [7, 4, 5]}, {"size": [1, 4, 9]}, {"size": [13, 4, 1]}, {"size": [30, 4, 17]},
    {"blocks": None}, {"blocks": {"size": [3, 4, 3], "overlap": 0.4}},
    {"blocks": {"size": [5, 2, 4], "overlap": 0}}, {"blocks": {"passes": 3, "attempts": 1}},
    {"blocks": {"size": [1, 1, 1], "overlap": 0}}, {"blocks": {"size": [64, 64, 64]}},
    {"order": "scan"}, {"order": "min_entropy"}, {"order": "random"},
    {"order": "min_entropy", "blocks": None}, {"order": "random", "blocks": None},
    {"weights": "uniform"}, {"weights": "example"}, {"weights": {"tree": 50, "rock": 0.01}},
    {"boundary": FREE}, {"boundary": {**FREE, "top": "air"}},
    {"boundary": dict.fromkeys(SIDE_NAMES, "example")},
    {"boundary": {"west": "air", "bottom": "free"}},
    {"boundary": {"north": ["air", "grass", "path"]}},
    {"boundary": {"east": ["air", "grass"]}}, {"boundary": {"south": "example"}},
    {"boundary": PERIODIC_X}, {"boundary": PERIODIC_Z}, {"boundary": {**PERIODIC_X, **PERIODIC_Z}},
    {"boundary": {**FREE, "top": "periodic", "bottom": "periodic"}},
    {"boundary": {**PERIODIC_X, **PERIODIC_Z}, "blocks": None},
    {"boundary": {**PERIODIC_X, **PERIODIC_Z}, "size": [23, 4, 27], "order": "random"},
], ids=short)
def test_a_model_keeps_to_its_example_and_to_its_boundary(server, parameters):
    job, labels = make_model(server, {"size": [12, 4, 9], **parameters}, example=HILLS, seed=11)
    echo = job["request"]["parameters"]
    assert labels["size"] == echo["size"] == parameters.get("size", [12, 4, 9])
    for name in ("order", "weights"):
        assert name not in parameters or echo[name] == parameters[name]
    if parameters.get("blocks", {}) is None:
        assert echo["blocks"] is None and job["progress"]["blocks_total"] == 1
    else:
        assert echo["blocks"].items() >= parameters.get("blocks", {}).items()
    for side, wanted in parameters.get("boundary", {}).items():
        special = wanted in ("free", "periodic", "example") or isinstance(wanted, list)
        assert echo["boundary"][side] in ([wanted] if special else [wanted, [wanted]])
    assert_fits(labels, HILLS, echo["boundary"])


@pytest.mark.parametrize("example_id", ["castle", "city", "canyon"])
def test_a_model_of_a_built_in_example_keeps_to_it(server, example_id):
    example = server.get(f"/v1/examples/{example_id}").json()
    job, labels = make_model(server, {"size": [15, 10, 12]}, example=example_id)
    assert_fits(labels, example, job["request"]["parameters"]["boundary"])


@pytest.mark.parametrize("size", [[3, 2, 3], [9, 2, 2], [12, 2, 5], [24, 2, 24]])
def test_stripes_close_on_themselves_where_the_size_lets_them(server, size):
    job, labels = make_model(server, {"size": size, "boundary": PERIODIC_X})
    model = assert_fits(labels, STRIPES, job["request"]["parameters"]["boundary"])
    floor = [model.at(x, 0, 0) for x in range(size[0])]
    assert floor == [1 + (x + floor[0] - 1) % 3 for x in range(size[0])]


def test_stripes_that_cannot_close_on_themselves_fail(server):
    job = make_job(server, {"size": [10, 2, 4], "boundary": PERIODIC_X})
    assert job["state"] == "failed" and job["result"] is None
    assert job["error"]["type"] in ("/problems/contradiction", "/problems/gave-up")
    assert_problem(server.get(job["urls"]["model"]), 409)
    assert_problem(server.get(job["urls"]["labels"]), 409)


def test_weights_change_how_often_a_piece_stands(server):
    def trees(weight):
        _, labels = make_model(server, {"size": [24, 4, 24], "weights": {"tree": weight}},
                               example=HILLS, seed=5)
        return labels["cells"].count(3)

    assert trees(0) == 0
    assert trees(0.01) < trees(1) < trees(100)


def test_a_piece_of_weight_nought_in_the_example_s_weights_is_never_chosen(server):
    job, labels = make_model(server, {"size": [20, 4, 20], "weights": {"rock": 0, "tree": 0}},
                             example=HILLS)
    model = assert_fits(labels, HILLS, job["request"]["parameters"]["boundary"])
    assert not {2, 3} & set(model.cells)


def test_passes_go_over_the_model_again(server):
    once = make_job(server, {"size": [20, 4, 20]}, example=HILLS)
    thrice = make_job(server, {"size": [20, 4, 20], "blocks": {"size": [10, 4, 10], "passes": 3}},
                      example=HILLS)
    assert thrice["progress"]["blocks_total"] == 3 * once["progress"]["blocks_total"]


def test_smaller_blocks_are_more_blocks(server):
    totals = [make_job(server, {"size": [20, 4, 20], "blocks": {"size": [side, 4, side]}},
                       example=HILLS)["progress"]["blocks_total"] for side in (5, 10, 20)]
    assert totals[0] > totals[1] > totals[2] == 1


@pytest.mark.parametrize("order", ["scan", "min_entropy", "random"])
def test_the_seed_decides_the_model(server, order):
    def sha(seed):
        job = make_job(server, {"size": [16, 4, 16], "order": order}, example=HILLS, seed=seed)
        return job["result"]["sha256"]

    assert sha(1) == sha(1)
    assert len({sha(seed) for seed in range(4)}) > 1


SIZE = [12, 4, 9]


@pytest.mark.parametrize("constraints", [
    [("fixed", ["rock"], {"cells": [[3, 1, 4]]})],
    [("fixed", ["rock", "tree"], {"box": {"min": [2, 1, 3], "max": [3, 2, 4]}})],
    [("fixed", ["air"], {"box": {"min": [0, 1, 0], "max": [12, 4, 9]}})],
    [("fixed", ["path"], {"box": {"min": [5, 0, 0], "max": [6, 1, 9]}})],
    [("fixed", ["air"], {"box": {"min": [0, 2, 0], "max": [12, 4, 9]}}),
     ("forbidden", ["tree"], {})],
    [("forbidden", ["rock", "path"], {})],
    [("forbidden", ["grass", "rock", "tree"], {"cells": [[0, 0, 0], [11, 0, 8], [5, 0, 4]]})],
    [("forbidden", ["path"], {"box": {"min": [0, 0, 0], "max": [12, 1, 9]}}),
     ("fixed", ["tree"], {"cells": [[6, 1, 4]]})],
    [("fixed", ["path"], {"cells": [[0, 0, 8]], "box": {"min": [0, 0, 0], "max": [1, 1, 2]}})],
], ids=short)
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_fixed_and_forbidden_hold_in_every_cell_they_name(server, constraints, blocks):
    sent = [{"kind": kind, "pieces": pieces, **where} for kind, pieces, where in constraints]
    parameters = {"size": SIZE, "constraints": sent}
    if blocks is None:
        parameters["blocks"] = None
    job, labels = make_model(server, parameters, example=HILLS)
    assert job["request"]["parameters"]["constraints"] == sent
    held = {"fixed": [], "forbidden": []}
    for kind, pieces, where in constraints:
        places = [tuple(cell) for cell in where.get("cells", [])]
        if "box" in where:
            places += box_places(where["box"]["min"], where["box"]["max"])
        held[kind].append((places if where else box_places([0, 0, 0], SIZE), pieces))
    assert_fits(labels, HILLS, job["request"]["parameters"]["boundary"], **held)


@pytest.mark.parametrize(("parameters", "named"), [
    ({"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}}, ["bottom", "top"]),
    ({"boundary": {"bottom": "red", "west": "blue"}}, ["bottom", "west"]),
    ({"boundary": {"north": "red", "east": "air"}}, ["north", "east"]),
    ({"boundary": {"south": ["red", "green"], "top": ["air", "blue"]}}, ["south", "top"]),
    ({"boundary": {"bottom": ["red", "blue"], "west": ["red", "green"],
                   "south": ["green", "blue"]}},
     ["bottom", "west", "south"]),
    ({"boundary": {"west": "example", "east": "blue"}, "size": [1, 2, 4]}, ["west", "east"]),
])
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_sides_that_leave_nothing_where_they_meet_are_a_problem_that_names_them(
        server, parameters, named, blocks):
    job = make_job(server, {**parameters, **({"blocks": None} if blocks is None else {})})
    assert job["state"] == "failed"
    error = job["error"]
    assert error["type"] == "/problems/contradiction"
    assert error["status"] == 422 and error["title"]
    for side in named:
        assert re.search(rf"\b{side}\b", error["detail"]), error["detail"]
    assert job["finished"] is not None
    assert server.events(job["id"])[-1]["error"] == error


@pytest.mark.parametrize("constraints", [
    [{"kind": "fixed", "pieces": ["red"], "cells": [[0, 0, 0]]},
     {"kind": "fixed", "pieces": ["blue"], "cells": [[0, 0, 0]]}],
    [{"kind": "forbidden", "pieces": ["air"]}],
    [{"kind": "fixed", "pieces": ["red"], "box": {"min": [0, 0, 0], "max": [2, 1, 1]}}],
    [{"kind": "forbidden", "pieces": ["air", "red", "green", "blue"]}],
], ids=["two at once", "no air", "neighbours", "nothing left"])
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_constraints_that_nothing_can_meet_are_a_proved_contradiction(server, constraints, blocks):
    job = make_job(server, {"constraints": constraints,
                            **({"blocks": None} if blocks is None else {})})
    assert job["state"] == "failed"
    assert job["error"]["type"] == "/problems/contradiction", job["error"]


def test_a_deadline_fails_the_job_and_keeps_its_preview(server):
    # Seconds of work, of which the first block is done at once, also in the slowest build.
    parameters = {"size": [100, 10, 100], "blocks": {"passes": 100}}
    job = post(server, {"solver": "discrete", "example": "castle", "parameters": parameters,
                        "deadline": 0.3}, Prefer="wait=30").json()
    assert job["state"] == "failed"
    assert job["error"]["type"] == "/problems/deadline-exceeded"
    assert job["progress"]["blocks_done"] < job["progress"]["blocks_total"]
    assert server.get(job["urls"]["preview"]).body[:4] == b"glTF"
    assert_problem(server.get(job["urls"]["model"]), 409)


def test_waiting_in_the_queue_does_not_count_to_the_deadline(make_server):
    server = make_server(workers=1)
    with endless_job(server) as running:
        job = post(server, job_request(deadline=2.0)).json()
        # Over before ten blocks are done, if waiting counted.
        short_one = post(server, job_request(deadline=0.001, priority=-1)).json()
        self_url = running["urls"]["self"]
        wait_until(lambda: server.get(self_url).json()["progress"]["blocks_done"] > 9)
        assert state_of(server, short_one) == "queued"
    assert server.wait(job["id"])["state"] == "succeeded"


def test_the_checker_of_models_sees_every_kind_of_fault(server):
    """The checks of this file are worth something only if they can fail."""
    boundary = {"bottom": "example", "top": ["air"], "north": "free", "south": "free",
                "west": "periodic", "east": "periodic"}
    _, labels = make_model(server, {"size": [6, 2, 4], "boundary": boundary})
    assert_fits(labels, STRIPES, boundary)

    def fails(change=None, boundary=boundary, **held):
        cells = labels["cells"] if change is None else change(list(labels["cells"]))
        with pytest.raises(AssertionError):
            assert_fits({**labels, "cells": cells}, STRIPES, boundary, **held)

    for place in range(len(labels["cells"])):
        fails(lambda cells: cells[:place] + [(cells[place] + 1) % 4] + cells[place + 1:])
    fails(lambda cells: cells[24:] + cells[:24])  # upside down
    fails(lambda cells: cells[::-1])
    fails(boundary={**boundary, "top": ["red"]})
    fails(boundary={**boundary, "north": "red"})
    fails(fixed=[([(0, 1, 0)], ["red"])])
    fails(forbidden=[([(0, 1, 0)], ["air"])])
    _, odd = make_model(server, {"size": [5, 2, 4]})
    assert_fits(odd, STRIPES, {**boundary, "west": "free", "east": "free"})
    with pytest.raises(AssertionError):
        assert_fits(odd, STRIPES, boundary)  # does not close on itself


def test_the_labels_are_laid_out_floor_by_floor(server):
    _, labels = make_model(server, {"size": [5, 4, 3], "boundary": {"bottom": "grass",
                                                                  "top": "air"}}, example=HILLS)
    assert set(labels) == {"size", "pieces", "cells"}
    assert labels["cells"][:15] == [1] * 15 and labels["cells"][-15:] == [0] * 15
    assert Grid(labels["size"], labels["cells"]).at(4, 0, 2) == 1

"""What a submission may ask for besides: Prefer: wait, and an Idempotency-Key."""

import socket

import pytest

from checks import (ENDLESS, STRIPES, assert_problem, compact, endless_job, job_request, make_job,
                    post_job, short, state_of, together, wait_until)


# --- Prefer: wait (RFC 7240)

@pytest.mark.parametrize(("preference", "applied"), [
    ("wait=20", "wait=20"), ("wait=60", "wait=60"), ("wait=61", "wait=60"),
    ("wait=86400", "wait=60"), ("wait=99999999999999999999999", "wait=60"),
    ("respond-async, wait=9", "wait=9"), ("wait = 9", "wait=9"), ("wait=9; foo=bar", "wait=9"),
    ("Wait=9", "wait=9"),
])
def test_a_preference_to_wait_is_applied_and_capped(server, preference, applied):
    answer = post_job(server, job_request(), Prefer=preference)
    assert answer.status == 200, answer.body
    assert answer.headers["preference-applied"] == applied
    assert answer.json()["state"] == "succeeded"
    assert answer.headers["location"] == answer.json()["urls"]["self"]


@pytest.mark.parametrize("preference", [
    "wait", "wait=", "wait=soon", "wait=-1", "wait=1.5", "waits=5", "return=minimal", ",", "=",
    "xwait=5", 'foo="a,wait=5,b"',
])
def test_a_malformed_or_other_preference_is_ignored(server, preference):
    answer = post_job(server, job_request(), Prefer=preference)
    assert answer.status == 202
    assert "preference-applied" not in answer.headers
    server.wait(answer.json()["id"])


def test_waiting_ends_with_202_when_the_time_is_up(server):
    answer = post_job(server, {"solver": "discrete", "example": "castle", "parameters": ENDLESS},
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
    first = post_job(server, request, Idempotency_Key="retry-1")
    again = post_job(server, dict(reversed(request.items())), Idempotency_Key="retry-1")
    assert (first.status, again.status) == (202, 202)
    assert again.json()["id"] == first.json()["id"]
    assert again.json()["seed"] == first.json()["seed"]
    assert again.headers["location"] == first.headers["location"]
    assert again.headers["idempotent-replayed"] == "true"
    assert "idempotent-replayed" not in first.headers


def test_a_quoted_key_and_a_bare_one_are_the_same_key(server):
    first = post_job(server, job_request(), Idempotency_Key='"quoted-1"')
    again = post_job(server, job_request(), Idempotency_Key="quoted-1")
    assert again.json()["id"] == first.json()["id"]


def test_the_same_key_with_another_body_is_a_conflict(server):
    first = post_job(server, job_request(seed=1), Idempotency_Key="conflict-1")
    assert first.status == 202
    assert_problem(post_job(server, job_request(seed=2), Idempotency_Key="conflict-1"), 422,
                   "idempotency-conflict", "/v1/jobs")
    assert post_job(server, job_request(seed=1), Idempotency_Key="conflict-1").json()["id"] == \
        first.json()["id"]


def test_another_key_or_none_makes_another_job(server):
    ids = [post_job(server, job_request(), **headers).json()["id"] for headers in
           ({"Idempotency_Key": "a-1"}, {"Idempotency_Key": "a-2"}, {}, {})]
    assert len(set(ids)) == 4


@pytest.mark.parametrize("key", ["", '""', "two words", "é", "k" * 256], ids=short)
def test_a_key_that_is_none_is_refused(server, key):
    assert_problem(post_job(server, job_request(), Idempotency_Key=key.encode("utf-8")), 400)


def test_a_key_of_255_characters_is_taken(server):
    assert post_job(server, job_request(), Idempotency_Key="k" * 255).status == 202


def test_a_refused_request_does_not_use_its_key_up(server):
    assert post_job(server, job_request(seed=-1), Idempotency_Key="refused-1").status == 422
    answer = post_job(server, job_request(), Idempotency_Key="refused-1")
    assert answer.status == 202 and "idempotent-replayed" not in answer.headers


def test_a_key_is_free_again_once_its_job_is_deleted(server):
    first = post_job(server, job_request(), Idempotency_Key="deleted-1")
    assert server.request("DELETE", first.headers["location"]).status == 204
    second = post_job(server, job_request(seed=3), Idempotency_Key="deleted-1")
    assert second.status == 202 and second.json()["id"] != first.json()["id"]


def test_a_retry_is_replayed_although_its_example_was_deleted_since(server):
    example = {**STRIPES, "name": "stripes to forget"}
    example_id = server.request("POST", "/v1/examples", example).json()["id"]
    request = job_request(example=example_id)
    first = post_job(server, request, Idempotency_Key="forgotten-1", Prefer="wait=60")
    assert first.json()["state"] == "succeeded"
    assert server.request("DELETE", f"/v1/examples/{example_id}").status == 204
    again = post_job(server, request, Idempotency_Key="forgotten-1")
    assert again.status == 202, again.body
    assert again.json()["id"] == first.json()["id"]


def test_a_retry_is_replayed_although_the_queue_is_full(make_server):
    server = make_server("--queue-max", 1, workers=1)
    with endless_job(server):
        first = post_job(server, job_request(), Idempotency_Key="full-1")
        assert first.status == 202
        assert post_job(server, job_request(), Idempotency_Key="full-2").status == 503
        assert post_job(server, job_request(), Idempotency_Key="full-1").json()["id"] == \
            first.json()["id"]
    # It stands in the queue until a worker has seen that the other one ended.
    server.wait(first.json()["id"])
    # The refusal was not kept under its key.
    answer = post_job(server, job_request(), Idempotency_Key="full-2", Prefer="wait=60")
    assert answer.status == 200


def test_twenty_clients_racing_with_one_key_make_one_job(make_server):
    server = make_server()
    answers = together(20, lambda _: post_job(server, job_request(), Idempotency_Key="race"))
    assert {answer.status for answer in answers} == {202}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert sum("idempotent-replayed" in answer.headers for answer in answers) == 19
    assert len(server.get("/v1/jobs?limit=100").json()["items"]) == 1

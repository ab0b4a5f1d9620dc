"""Jobs over HTTP: submitting, reading, cancelling, deleting, and the queue."""

import math
import os
import re
import time

import pytest

from checks import (ENDED, ENDLESS, STRIPES, assert_problem, endless_job, files_of, job_request,
                    make_job, post_job, short, state_of, together, wait_until)

TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")
SEED_MAX = 2**53 - 1
SIDE_NAMES = ["bottom", "top", "north", "south", "west", "east"]


# --- submitting

def test_a_submitted_job_is_accepted_with_its_place_and_the_whole_job(server):
    answer = post_job(server, job_request(tags={"level": "3"}, priority=2, deadline=30.0))
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
    answer = post_job(server, {"solver": "discrete", "example": "castle"})
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
    seeds = {post_job(server, request).json()["seed"] for _ in range(4)}
    assert len(seeds) == 4
    assert all(0 <= seed <= SEED_MAX for seed in seeds)


def test_an_order_chosen_by_trial_is_told_and_is_that_which_can_be_asked_for(server):
    sizes = {"castle": [20, 8, 20], "canyon": [20, 6, 20]}
    for example, size in sizes.items():
        request = {"solver": "discrete", "example": example, "seed": 4}
        chosen = post_job(server, {**request, "parameters": {"size": size, "order": "auto"}},
                          Prefer="wait=60").json()
        assert chosen["request"]["parameters"]["order"] == "auto"
        order = chosen["result"]["stats"]["order"]
        asked_for = post_job(server, {**request, "parameters": {"size": size, "order": order}},
                             Prefer="wait=60").json()
        assert asked_for["result"]["sha256"] == chosen["result"]["sha256"]
        assert "order" not in asked_for["result"]["stats"]


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
    first = post_job(server, request_, Prefer="wait=60").json()
    assert first["state"] == "succeeded", first
    again = post_job(server, first["request"], Prefer="wait=60").json()
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
    ids = [post_job(server, job_request()).json()["id"] for _ in range(12)]
    assert ids == sorted(ids) and len(set(ids)) == len(ids)


def test_whole_numbers_may_be_written_with_a_fraction_of_zero(server):
    job = make_job(server, {"size": [6.0, 2, 4]}, seed=5.0, priority=1.0)
    assert job["request"]["parameters"]["size"] == [6, 2, 4] and job["seed"] == 5


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
        queued = post_job(server, job_request()).json()
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
    job = post_job(server, {"solver": "discrete", "example": "castle",
                            "parameters": parameters}).json()
    wait_until(lambda: state_of(server, job) == "running")
    answer = server.request("POST", job["urls"]["cancel"])
    assert answer.status == 200
    cancelled = answer.json()
    if "MODELSYNTH_SANITIZED" in os.environ:  # ten times slower
        cancelled = server.wait(job["id"])
    assert cancelled["state"] == "cancelled", "the worker did not let go within a second"
    assert server.get(job["urls"]["self"]).json() == cancelled
    assert_problem(server.get(job["urls"]["model"]), 409)


@pytest.mark.parametrize("how", ["succeeded", "failed", "cancelled"])
def test_cancelling_an_ended_job_changes_nothing(server, how):
    if how == "cancelled":
        with endless_job(server) as begun:
            pass
        job = server.wait(begun["id"])
    else:
        impossible = {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}}
        job = make_job(server, impossible if how == "failed" else None)
    assert job["state"] == how
    events = server.events(job["id"])
    answer = server.request("POST", job["urls"]["cancel"])
    assert answer.status == 200 and answer.json() == job
    assert server.get(job["urls"]["self"]).json() == job
    assert server.events(job["id"]) == events


@pytest.mark.parametrize("was_running", [True, False], ids=["running", "queued"])
def test_a_cancelled_job_tells_when_it_expires(make_server, was_running):
    server = make_server(workers=1)
    with endless_job(server) as running:
        queued = post_job(server, job_request()).json()
        job = running if was_running else queued
        server.request("POST", job["urls"]["cancel"])
        assert TIME.fullmatch(server.wait(job["id"])["expires"] or "never")


def test_cancel_against_completion_has_one_outcome(server):
    def submit_and_cancel(number):
        job = post_job(server, job_request({"size": [12, 2, 12]}, seed=number)).json()
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
            job = running if state == "running" else post_job(server, job_request()).json()
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
            request = job_request({"size": [20, 2, 20]}, seed=6 * number + turn)
            job = post_job(server, request).json()
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
    before = time.monotonic()
    server = make_server("--queue-max", 2, workers=1)
    began = time.monotonic()
    with endless_job(server):
        assert server.get("/readyz").status == 200
        queued = [post_job(server, job_request()).json() for _ in range(2)]
        assert [job["queue"]["position"] for job in queued] == [0, 1]
        answer = post_job(server, job_request())
        assert_problem(answer, 503, "queue-full", "/v1/jobs")
        # As long as no job has ended yet, it may well take as long again.
        time.sleep(2)
        for ask in (lambda: post_job(server, job_request())), (lambda: server.get("/readyz")):
            least = time.monotonic() - began
            answer = ask()
            assert_problem(answer, 503, "queue-full")
            most = time.monotonic() - before
            assert least <= int(answer.headers["retry-after"]) <= min(math.ceil(most), 60)
        assert server.get("/healthz").status == 200
        assert len(server.get("/v1/jobs").json()["items"]) == 3
        server.request("POST", queued[0]["urls"]["cancel"])
        assert server.get("/readyz").status == 200
        assert server.get(queued[1]["urls"]["self"]).json()["queue"]["position"] == 0
        assert post_job(server, job_request()).status == 202


def test_higher_priority_goes_first_and_equal_ones_in_order_of_arrival(make_server):
    server = make_server(workers=1)
    priorities = [0, -10, 10, 0, 5, -10, 10]
    with endless_job(server):
        jobs = [post_job(server, job_request(priority=priority)).json() for priority in priorities]
        expected = sorted(jobs, key=lambda job: -job["request"]["priority"])
        positions = {job["id"]: server.get(job["urls"]["self"]).json()["queue"]["position"]
                     for job in jobs}
        assert [positions[job["id"]] for job in expected] == list(range(len(jobs)))
    started = [server.wait(job["id"])["started"] for job in expected]
    assert started == sorted(started)


def test_workers_help_with_a_job_only_when_none_waits(make_server):
    server = make_server("--large-choices", 10**15)

    def threads():
        started = re.findall(r"job started .*threads=(\d+)", server.log_text())
        return [int(count) for count in started]

    for _ in range(5):
        make_job(server)
    # A worker that just looks for a job is not seen as idle; it looks four times a second.
    assert max(threads()) == min(2, os.cpu_count())
    with endless_job(server), endless_job(server):
        waiting = [post_job(server, job_request()).json() for _ in range(20)]
    for job in waiting:
        server.wait(job["id"])
    wait_until(lambda: len(threads()) == 27)
    # The second of the endless ones, and of those that waited all but the last.
    assert set(threads()[6:-2]) == {1}

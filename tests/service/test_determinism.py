"""The same request with the same seed gives the same bytes, whatever the number of workers, the
order of arrival and the company."""

import hashlib
import json
import os
import threading

import pytest

from workload import SMALL_JOB, TILES_JOB, YARD, submit

# Requests as unlike one another as can be: sizes, orders, blocks, weights, boundaries.
_INLINE = {
    "yard": {"example": YARD, "size": (24, 5, 17)},
    "yard, by entropy": {"example": YARD, "size": (16, 5, 16),
                         "parameters": {"order": "min_entropy", "weights": "uniform"}},
    "yard, at random": {"example": YARD, "size": (16, 5, 16),
                        "parameters": {"order": "random", "weights": "uniform"}},
    "yard, all at once": {"example": YARD, "size": (9, 4, 7),
                          "parameters": {"blocks": None, "weights": "uniform"}},
    "yard, small blocks": {"example": YARD, "size": (40, 6, 40), "parameters": {
        "blocks": {"size": [4, 6, 4], "overlap": 0.25, "passes": 2}, "weights": "uniform"}},
    "yard, periodic": {"example": YARD, "size": (20, 5, 20), "parameters": {
        "weights": "uniform", "boundary": dict.fromkeys(
            ("north", "south", "west", "east"), "periodic")}},
    "yard, weighted": {"example": YARD, "size": (20, 5, 20), "parameters": {
        "weights": {"post": 5, "arch": 0.5}}},
    "yard, fixed": {"example": YARD, "size": (20, 5, 20), "parameters": {
        "weights": "uniform", "constraints": [
            {"kind": "forbidden", "pieces": ["door"],
             "box": {"min": [0, 0, 0], "max": [10, 5, 20]}}]}},
    "one column": {"example": YARD, "size": (1, 4, 1)},
    "tiles": TILES_JOB,
    "tiles, by entropy": {**TILES_JOB, "parameters": {
        "order": "min_entropy", "blocks": {"size": [10, 1, 10], "attempts": 2}}},
}


def requests_for(server):
    """The requests above, and some for each example that is built in."""
    requests = dict(_INLINE)
    # Larger ones take ThreadSanitizer five minutes and race no more.
    sizes = ((12, 8, 12),) if "MODELSYNTH_SANITIZED" in os.environ else ((12, 8, 12), (30, 8, 18))
    for example in server.get("/v1/examples").json()["items"]:
        if example["built_in"]:
            for size in sizes:
                requests[f"{example['id']} {size}"] = {
                    "solver": example["kind"], "example": example["id"], "size": size}
    return requests


def send(server, request, seed=11):
    return submit(server, {"parameters": {}, **request}, seed=seed)


def fingerprint(server, job_id):
    """What must be equal: the model's bytes, the labels, the events but for times, the outcome."""
    job = server.wait(job_id)
    events = [{name: value for name, value in event.items()
               if name not in ("time", "result", "position")} for event in server.events(job_id)]
    print_of = {"state": job["state"], "events": events, "request": job["request"]}
    if job["state"] == "succeeded":
        model = server.get(f"/v1/jobs/{job_id}/model.glb").body
        assert hashlib.sha256(model).hexdigest() == job["result"]["sha256"]
        assert len(model) == job["result"]["bytes"]
        stats = dict(job["result"]["stats"])
        del stats["solve_seconds"]
        print_of.update(sha256=job["result"]["sha256"], stats=stats)
        if "labels" in job["urls"]:
            print_of["labels"] = server.get(job["urls"]["labels"]).body
    else:
        print_of["error"] = {name: value for name, value in job["error"].items()
                             if name != "instance"}
    return print_of


@pytest.fixture(scope="module")
def expected(server):
    """Of every request, one by one on the shared server."""
    found = {name: fingerprint(server, send(server, request)["id"])
             for name, request in requests_for(server).items()}
    states = [print_of["state"] for print_of in found.values()]
    assert states.count("succeeded") >= 10
    return found


def check_same(server, jobs, expected):
    for name, job_id in jobs:
        found = fingerprint(server, job_id)
        for part, value in expected[name].items():
            assert found[part] == value, f"{name}: {part} differs"


@pytest.mark.parametrize("workers", [1, 2, 8])
def test_any_number_of_workers_makes_the_same_models(make_server, expected, workers):
    server = make_server(workers=workers)
    jobs = [(name, send(server, request)["id"])
            for name, request in reversed(requests_for(server).items())]
    check_same(server, jobs, expected)


def test_sixteen_jobs_sent_at_the_same_time_come_out_as_if_each_were_alone(make_server, expected):
    server = make_server(workers=4)
    requests = list(requests_for(server).items())
    chosen = [requests[index % len(requests)] for index in range(16)]
    jobs = [None] * 16
    barrier = threading.Barrier(16)

    def run(index):
        barrier.wait(timeout=30)
        jobs[index] = (chosen[index][0], send(server, chosen[index][1])["id"])

    threads = [threading.Thread(target=run, args=(index,)) for index in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert None not in jobs
    assert len({job_id for _, job_id in jobs}) == 16
    check_same(server, jobs, expected)


def test_a_restart_changes_nothing(make_server, expected):
    server = make_server()
    name, request = "tiles", _INLINE["tiles"]
    first = send(server, request)["id"]
    before = fingerprint(server, first)
    assert server.stop() == 0
    server.start()
    assert fingerprint(server, first) == before
    check_same(server, [(name, first), (name, send(server, request)["id"])], expected)


def test_every_profile_is_made_the_same_again(make_server, server):
    jobs = [(each, each.wait(submit(each, SMALL_JOB)["id"])["id"])
            for each in (server, make_server(workers=1))]
    for profile in ("nodes", "instanced", "merged"):
        one, other = (each.get(f"/v1/jobs/{job_id}/model.glb?profile={profile}")
                      for each, job_id in jobs)
        assert one.status == other.status == 200
        assert one.body == other.body
        assert one.headers["etag"] == other.headers["etag"]


def test_another_seed_makes_another_model(server):
    shas = {server.wait(submit(server, SMALL_JOB, seed=seed)["id"])["result"]["sha256"]
            for seed in (0, 1, 2, 2**53 - 1)}
    assert len(shas) == 4


def test_a_job_without_a_seed_tells_the_one_it_got_and_repeats_from_it(server):
    body = {"solver": "discrete", "example": YARD,
            "parameters": {"size": [20, 5, 20], "weights": "uniform"}}
    job = server.wait(server.request("POST", "/v1/jobs", body).json()["id"])
    assert 0 <= job["seed"] < 2**53
    again = server.request("POST", "/v1/jobs", {**body, "seed": job["seed"]}).json()
    assert server.wait(again["id"])["result"]["sha256"] == job["result"]["sha256"]
    other = server.wait(server.request("POST", "/v1/jobs", body).json()["id"])
    assert other["seed"] != job["seed"]


def test_the_request_that_a_job_echoes_reproduces_it(server, expected):
    for name, request in _INLINE.items():
        echo = server.get(f"/v1/jobs/{send(server, request)['id']}").json()["request"]
        answer = server.request("POST", "/v1/jobs", json.dumps(echo),
                                {"Content-Type": "application/json"})
        assert answer.status == 202, answer.body
        check_same(server, [(name, answer.json()["id"])], expected)

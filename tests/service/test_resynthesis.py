"""Jobs that start from a finished one: what is made anew, what keeps its labels, and what becomes of
them when the earlier job goes. The requests of the guide are posted as they stand."""

import json
import pathlib
import re

import jsonschema
import pytest

from checks import (HILLS, STRIPES, assert_faults, assert_fits, assert_problem, box_places,
                    endless_job, files_of, job_request, make_model, post_job, state_of, together,
                    wait_until)
from constraint_oracle import Oracle, grey_png
from event_reader import EventReader
from workload import ENDLESS_JOB, STEADY_JOB, YARD, submit

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "resynthesis.md"
_OF_GRIDS = _GUIDE.read_text().partition("## Solids")[0]
_FIRST, *_REQUESTS = [json.loads(text) for text in
                      re.findall(r"```json\n(.*?)```", _OF_GRIDS, re.DOTALL)]

SIZE = [12, 4, 11]
BOX = {"min": [3, 0, 2], "max": [9, 4, 8]}
HILLS_REQUEST = {"solver": "discrete", "example": HILLS, "seed": 5, "parameters": {"size": SIZE}}
UNIFORM = {"weights": "uniform"}
# All of its pieces have neighbours on all sides, so that what stands at a border can grow.
YARD_REQUEST = {"solver": "discrete", "example": YARD, "seed": 5,
                "parameters": {"size": SIZE, **UNIFORM}}


def make(server, request):
    """The job, succeeded, and its labels.json."""
    answer = post_job(server, request, Prefer="wait=60")
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job, labels_of(server, job)


def labels_of(server, job):
    return server.get(f"/v1/jobs/{job['id']}/labels.json").json()


def from_job(job, seed=6, parameters=None, **place):
    request = {"from": {"job": job["id"], **place}, "seed": seed}
    if parameters is not None:
        request["parameters"] = parameters
    return request


def by_place(labels):
    width, height, depth = labels["size"]
    return {(x, y, z): labels["cells"][x + width * (z + depth * y)]
            for x in range(width) for y in range(height) for z in range(depth)}


def differing(before, after, at=(0, 0, 0)):
    """The places of the new model that the older one has, and that hold something else."""
    new = by_place(after)
    moved = {tuple(p + a for p, a in zip(place, at)): label
             for place, label in by_place(before).items()}
    assert moved.keys() <= new.keys()
    return {place for place, label in moved.items() if new[place] != label}


def places_of(box):
    return set(box_places(box["min"], box["max"]))


@pytest.fixture(scope="module")
def hills(server):
    """A finished job and its labels."""
    return make(server, HILLS_REQUEST)


@pytest.fixture(scope="module")
def yard(server):
    return make(server, YARD_REQUEST)


# --- the guide

@pytest.fixture(scope="module")
def castle(server):
    return make(server, _FIRST)


@pytest.mark.parametrize("request_", _REQUESTS, ids=range(len(_REQUESTS)))
def test_the_guides_requests_keep_all_but_what_they_name(server, castle, request_):
    earlier, before = castle
    request = {**request_, "from": {**request_["from"], "job": earlier["id"]}}
    job, after = make(server, request)
    changed = differing(before, after, request["from"].get("at", (0, 0, 0)))
    assert changed and changed <= places_of(request["from"]["box"])
    echo = job["request"]
    assert {**echo["from"], **request["from"]} == echo["from"]
    assert (echo["solver"], echo["example"]) == ("discrete", "castle")
    example = server.get("/v1/examples/castle").json()
    assert_fits(after, example, echo["parameters"]["boundary"])
    oracle = Oracle(after, echo["parameters"]["boundary"])
    assert all(oracle.violation(one) is None for one in echo["parameters"]["constraints"])


def test_the_guides_well_goes_with_the_model_that_grows(server, castle):
    grown = {**_REQUESTS[-1], "from": {**_REQUESTS[-1]["from"], "job": castle[0]["id"]}}
    job, _ = make(server, grown)
    assert _FIRST["parameters"]["constraints"][0]["cells"] == [[12, 0, 12]]
    assert [one["cells"] for one in job["request"]["parameters"]["constraints"]] == [[[16, 0, 16]]]


# --- what is made anew

@pytest.mark.parametrize("place", [
    {"box": BOX},
    {"cells": [list(place) for place in box_places(BOX["min"], BOX["max"])]},
    {"mask": grey_png([[255 if 3 <= x < 9 and 2 <= z < 8 else 0 for x in range(12)]
                       for z in range(11)])},
    {"voxels": {"size": [12, 1, 11], "values": [
        0.5 if 3 <= x < 9 and 2 <= z < 8 else 0.49 for z in range(11) for x in range(12)]}},
], ids=lambda place: next(iter(place)))
def test_only_the_region_is_made_anew_however_it_is_named(server, hills, place):
    earlier, before = hills
    ever_changed = set()
    for seed in range(8):
        job, after = make(server, from_job(earlier, seed, UNIFORM, **place))
        changed = differing(before, after)
        assert changed <= places_of(BOX)
        assert_fits(after, HILLS, job["request"]["parameters"]["boundary"])
        share = len(changed) / len(before["cells"])
        assert job["result"]["stats"]["changed"] == pytest.approx(share, abs=1e-6)
        ever_changed |= changed
    # Something grows wherever something may: of the ground all, of the air above none.
    assert len(ever_changed) > len(places_of(BOX)) / 8


def test_without_a_region_everything_is_made_anew(server, hills):
    earlier, before = hills
    ever_changed = set()
    for seed in range(8):
        job, after = make(server, from_job(earlier, seed, UNIFORM))
        assert_fits(after, HILLS, job["request"]["parameters"]["boundary"])
        changed = differing(before, after)
        share = len(changed) / len(before["cells"])
        assert job["result"]["stats"]["changed"] == pytest.approx(share, abs=1e-6)
        ever_changed |= changed
    assert ever_changed - places_of(BOX), "nothing outside of some box was made anew"


def test_a_region_that_holds_no_cell_changes_nothing(server, hills):
    earlier, before = hills
    job, after = make(server, from_job(earlier, mask=grey_png([[0]])))
    assert after == before
    assert job["result"]["stats"]["changed"] == 0


def test_a_constraint_of_the_new_job_alone_holds_where_things_are_made_anew(server, hills):
    earlier, before = hills
    tree = before["pieces"].index("tree")
    floor = {"min": BOX["min"], "max": [BOX["max"][0], 2, BOX["max"][2]]}
    wanted = {"kind": "forbidden", "pieces": ["tree", "rock"], "box": BOX}
    held = 0
    for seed in range(8):
        _, free = make(server, from_job(earlier, seed, UNIFORM, box=BOX))
        held += any(by_place(free)[place] == tree for place in places_of(floor))
        job, after = make(server, from_job(earlier, seed, {**UNIFORM, "constraints": [wanted]},
                                           box=BOX))
        assert differing(before, after) <= places_of(BOX)
        assert Oracle(after, job["request"]["parameters"]["boundary"]).violation(wanted) is None
    assert held, "without the constraint there is no tree either, so this shows nothing"


# --- growing

@pytest.mark.parametrize("at", [(0, 0, 0), (5, 0, 0), (2, 0, 3), (5, 0, 6)])
def test_a_model_that_grows_stays_in_its_place(server, yard, at):
    earlier, before = yard
    beyond = set()
    for seed in range(4):
        job, after = make(server, from_job(earlier, seed, {"size": [17, 4, 17]}, at=at))
        assert after["size"] == [17, 4, 17]
        assert differing(before, after, at) == set()
        assert_fits(after, YARD, job["request"]["parameters"]["boundary"])
        assert job["request"]["from"]["at"] == list(at)
        high = [a + s for a, s in zip(at, SIZE)]
        beyond |= {label for place, label in by_place(after).items()
                   if not all(a <= p < h for p, a, h in zip(place, at, high))}
    assert len(beyond) >= 4, "what lies beyond the older model is all the same"


def test_a_model_that_grows_may_be_made_anew_in_part(server, yard):
    earlier, before = yard
    box = {"min": [3, 0, 4], "max": [9, 4, 10]}
    changed = set()
    for seed in range(4):
        _, after = make(server, from_job(earlier, seed, {"size": [17, 4, 17]},
                                         at=[2, 0, 3], box=box))
        changed |= differing(before, after, (2, 0, 3))
    assert changed and changed <= places_of(box)


def test_a_model_that_grows_gets_the_usual_blocks_of_its_size(server, yard):
    job, _ = make(server, from_job(yard[0], parameters={"size": [12, 6, 11]}))
    assert yard[0]["request"]["parameters"]["blocks"]["size"] == [10, 4, 10]
    assert job["request"]["parameters"]["blocks"]["size"] == [10, 6, 10]


# --- what the job tells, and what it comes to

def test_what_is_not_given_is_as_it_was(server):
    parameters = {"size": [12, 4, 12], "order": "random", "weights": {"tree": 3},
                  "blocks": {"size": [6, 4, 6], "overlap": 0.25, "passes": 2, "attempts": 3},
                  "boundary": {"west": "example"},
                  "constraints": [{"kind": "count", "pieces": ["tree"], "min": 1}]}
    earlier, _ = make(server, {**HILLS_REQUEST, "parameters": parameters, "tags": {"a": "b"}})
    job, _ = make(server, from_job(earlier, box=BOX))
    assert job["solver"] == "discrete"
    for name in ("solver", "example", "parameters"):
        assert job["request"][name] == earlier["request"][name]
    assert job["request"]["tags"] == {}
    assert job["request"]["from"] == {
        "job": earlier["id"], "size": [12, 4, 12], "at": [0, 0, 0], "box": BOX}
    job, _ = make(server, from_job(earlier, parameters={"order": "scan"}, box=BOX))
    assert job["request"]["parameters"] == {**earlier["request"]["parameters"], "order": "scan"}


def test_the_echo_makes_the_same_model_while_the_earlier_job_is_there(server):
    earlier, _ = make(server, HILLS_REQUEST)
    job, _ = make(server, from_job(earlier, parameters=UNIFORM, box=BOX))
    again, _ = make(server, job["request"])
    assert again["request"] == job["request"]
    assert again["result"]["sha256"] == job["result"]["sha256"]
    server.request("DELETE", f"/v1/jobs/{earlier['id']}")
    assert_faults(post_job(server, job["request"]), job["request"], ["/from/job"])


def test_the_same_request_gives_the_same_bytes_whatever_the_workers(make_server):
    request = {"solver": "discrete", "example": YARD, "seed": 3,
               "parameters": {"size": [30, 6, 30], **UNIFORM}}
    made = set()
    for workers in (1, 3):
        server = make_server(workers=workers, name=f"workers{workers}")
        earlier, _ = make(server, request)
        jobs = together(3, lambda _, at=server, of=earlier: make(at, from_job(
            of, seed=9, box={"min": [4, 0, 4], "max": [25, 6, 20]})))
        made |= {job["result"]["sha256"] for job, _ in jobs}
        other, _ = make(server, from_job(earlier, seed=10, box={"min": [4, 0, 4],
                                                                "max": [25, 6, 20]}))
        assert other["result"]["sha256"] not in made
    assert len(made) == 1


def test_a_job_without_a_seed_gets_one_and_tells_it(server, hills):
    request = {"from": {"job": hills[0]["id"], "box": BOX}, "parameters": UNIFORM}
    job, labels = make(server, request)
    _, again = make(server, {**request, "seed": job["seed"]})
    assert again == labels


def test_an_idempotency_key_answers_when_the_earlier_job_is_gone(server):
    earlier, _ = make(server, HILLS_REQUEST)
    request = from_job(earlier, box=BOX)
    first = post_job(server, request, Idempotency_Key="from-1")
    assert first.status == 202
    server.request("DELETE", f"/v1/jobs/{earlier['id']}")
    again = post_job(server, request, Idempotency_Key="from-1")
    assert again.status == 202 and again.json()["id"] == first.json()["id"]
    assert_faults(post_job(server, request), request, ["/from/job"])


# --- the example

def test_an_example_that_came_with_the_request_goes_on(server):
    earlier, before = make(server, HILLS_REQUEST)
    job, after = make(server, from_job(earlier, box=BOX))
    assert job["request"]["example"] == HILLS
    assert after["pieces"] == before["pieces"]


def test_another_example_with_the_same_pieces_may_be_given(server, hills):
    steeper = {**HILLS, "name": "steeper",
               "adjacency": {"y": [["rock", "rock"], ["rock", "air"]]}}
    job, after = make(server, {**from_job(hills[0], box=BOX), "example": steeper})
    assert job["request"]["example"] == steeper
    assert differing(hills[1], after) <= places_of(BOX)
    swapped = {**HILLS, "pieces": [HILLS["pieces"][i] for i in (0, 2, 1, 3, 4)]}
    for other in (swapped, STRIPES, "castle"):
        request = {**from_job(hills[0], box=BOX), "example": other}
        assert_faults(post_job(server, request), request, ["/example"])


def test_an_uploaded_example_that_was_deleted_stays_with_its_jobs(make_server):
    server = make_server(workers=1)
    example = server.request("POST", "/v1/examples", HILLS).json()["id"]
    earlier, before = make(server, {**HILLS_REQUEST, "example": example})
    assert server.request("DELETE", f"/v1/examples/{example}").status == 204
    with endless_job(server):
        waiting = post_job(server, from_job(earlier, box=BOX)).json()
        assert server.request("DELETE", f"/v1/jobs/{earlier['id']}").status == 204
        server.kill()
        server.start()
        assert state_of(server, waiting) == "queued"
    job = server.wait(waiting["id"])
    assert job["state"] == "succeeded", job["error"]
    assert job["request"]["example"] == example
    assert differing(before, labels_of(server, job)) <= places_of(BOX)
    assert server.get(f"/v1/jobs/{job['id']}/model.glb?profile=merged").status == 200
    # And the next one has it from there.
    make(server, from_job(job, box=BOX))
    named = {**from_job(job, box=BOX), "example": example}
    make(server, named)
    assert_faults(post_job(server, job_request(example=example)), job_request(), ["/example"])


def test_an_uploaded_example_of_the_new_jobs_own_stays_with_it(make_server):
    server = make_server()
    flat, high = (server.request("POST", "/v1/examples", {**HILLS, "cell": [1, height, 1]})
                  .json()["id"] for height in (1, 3))
    earlier, _ = make(server, {**HILLS_REQUEST, "example": flat})
    jobs = [make(server, {**from_job(earlier, box=BOX), "example": high})[0] for _ in range(2)]
    files = [f"/v1/jobs/{job['id']}/model.glb?profile=merged" for job in jobs]
    expected = server.get(files[0]).body
    for example in (flat, high):
        assert server.request("DELETE", f"/v1/examples/{example}").status == 204
    assert server.get(files[1]).status == 200 and server.get(files[1]).body == expected


# --- the earlier job goes

def test_a_model_has_a_successor_that_has_one(server):
    first, before = make(server, YARD_REQUEST)
    left, right = ({"min": [low, 0, 0], "max": [low + 4, 4, 11]} for low in (1, 7))
    second, between = make(server, from_job(first, 1, box=left))
    third, after = make(server, from_job(second, 2, box=right))
    assert differing(before, between) <= places_of(left)
    assert differing(between, after) <= places_of(right)
    assert third["request"]["from"]["job"] == second["id"]
    for job in (first, second):
        server.request("DELETE", f"/v1/jobs/{job['id']}")
    fourth, last = make(server, from_job(third, 3, {"size": [14, 4, 11]}))
    assert differing(after, last) == set()
    assert fourth["request"]["from"]["size"] == SIZE


def test_the_earlier_job_may_be_deleted_while_the_new_one_waits(make_server):
    server = make_server(workers=1)
    earlier, before = make(server, HILLS_REQUEST)
    expected, _ = make(server, from_job(earlier, parameters=UNIFORM, box=BOX))
    with endless_job(server):
        waiting = post_job(server, from_job(earlier, parameters=UNIFORM, box=BOX)).json()
        assert server.request("DELETE", f"/v1/jobs/{earlier['id']}").status == 204
        server.kill()
        server.start()
        assert state_of(server, waiting) == "queued"
        assert server.get(f"/v1/jobs/{earlier['id']}").status == 404
    job = server.wait(waiting["id"])
    assert job["state"] == "succeeded", job["error"]
    assert job["result"]["sha256"] == expected["result"]["sha256"]
    assert differing(before, labels_of(server, job)) <= places_of(BOX)


def test_a_job_that_goes_while_another_is_made_from_it_was_there_or_was_not(make_server):
    server = make_server()
    statuses = set()
    for round_ in range(20):
        earlier, before = make(server, {**HILLS_REQUEST, "seed": round_})
        request = from_job(earlier, box=BOX)
        answer, gone = together(2, lambda number, request=request, job=earlier: (
            post_job(server, request) if number == 0
            else server.request("DELETE", f"/v1/jobs/{job['id']}")))
        assert gone.status == 204
        statuses.add(answer.status)
        if answer.status == 202:
            job = server.wait(answer.json()["id"])
            assert job["state"] == "succeeded", job["error"]
            assert differing(before, labels_of(server, job)) <= places_of(BOX)
        else:
            assert_faults(answer, request, ["/from/job"])
    assert 202 in statuses


def test_what_a_job_started_from_goes_with_it(make_server):
    server = make_server()
    earlier, _ = make(server, HILLS_REQUEST)
    job, _ = make(server, from_job(earlier, parameters=UNIFORM, box=BOX))
    for one in (earlier, job):
        assert files_of(server, "artifacts")
        assert server.request("DELETE", f"/v1/jobs/{one['id']}").status == 204
    wait_until(lambda: not files_of(server, "artifacts"))


def test_the_earlier_job_may_expire_while_the_new_one_waits(make_server):
    server = make_server("--retention-hours", "0.001", workers=1)  # 3.6 seconds
    earlier, before = make(server, HILLS_REQUEST)
    with endless_job(server) as endless:
        waiting = post_job(server, from_job(earlier, box=BOX)).json()
        wait_until(lambda: server.get(f"/v1/jobs/{earlier['id']}/labels.json").status == 410)
        assert_problem(post_job(server, from_job(earlier, box=BOX)), 410, "expired", "/v1/jobs")
        # What has expired is taken at the start, before any job is.
        server.kill()
        server.start()
        wait_until(lambda: state_of(server, endless) == "running")
        assert state_of(server, waiting) == "queued"
    job = server.wait(waiting["id"])
    assert job["state"] == "succeeded", job["error"]
    assert differing(before, labels_of(server, job)) <= places_of(BOX)


@pytest.mark.parametrize("fraction", [0, 0.4])
def test_a_job_that_was_killed_goes_on_to_the_same_model(make_server, fraction):
    server = make_server(workers=1)
    earlier = server.wait(submit(server, STEADY_JOB)["id"])
    request = from_job(earlier, seed=8, box={"min": [5, 0, 5], "max": [95, 6, 95]})
    expected, _ = make(server, request)
    job = post_job(server, request).json()
    assert server.request("DELETE", f"/v1/jobs/{earlier['id']}").status == 204
    with EventReader(server.port, job["id"]) as reader:
        reader.until_event(lambda event: event.get("fraction", -1) > fraction)
        server.kill()
    server.start()
    ended = server.wait(job["id"])
    assert ended["state"] == "succeeded", ended["error"]
    assert ended["result"]["sha256"] == expected["result"]["sha256"]
    events = server.events(job["id"])
    assert [event["type"] for event in events].count("started") == 2
    blocks = [event["index"] for event in events if event["type"] == "block"]
    assert blocks == list(range(len(blocks))) and blocks


# --- what cannot be

def test_a_job_that_has_no_model_cannot_be_started_from(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB), submit(server, ENDLESS_JOB)
    for job in (running, waiting):
        problem = assert_problem(post_job(server, from_job(job)), 409, "not-finished", "/v1/jobs")
        assert [error["pointer"] for error in problem["errors"]] == ["/from/job"]
    for job in (waiting, running):
        server.request("POST", f"/v1/jobs/{job['id']}/cancel")
        server.wait(job["id"])
        assert_problem(post_job(server, from_job(job)), 409, "no-model", "/v1/jobs")
    failed = server.wait(submit(server, ENDLESS_JOB, deadline=0.05)["id"])
    assert failed["state"] == "failed"
    assert_problem(post_job(server, from_job(failed)), 409, "no-model", "/v1/jobs")
    server.request("DELETE", f"/v1/jobs/{failed['id']}")
    assert_faults(post_job(server, from_job(failed)), from_job(failed), ["/from/job"])
    # What is wrong with the request itself goes first.
    wrong = {**from_job(running), "seed": -1}
    assert_faults(post_job(server, wrong), wrong, ["/seed", "/from/job"])


@pytest.mark.parametrize("change, expected", [
    ({"from": None}, ["/from"]),
    ({"from": "JOB"}, ["/from"]),
    ({"from": {}}, ["/from/job"]),
    ({"from": {"job": None}}, ["/from/job"]),
    ({"from": {"job": ""}}, ["/from/job"]),
    ({"from": {"job": "none"}}, ["/from/job"]),
    ({"from": {"job": "../JOB"}}, ["/from/job"]),
    ({"from": {"job": "JOB\0"}}, ["/from/job"]),
    ({"from": {"job": "' OR ''='"}}, ["/from/job"]),
    ({"from": {"job": "x" * 129}}, ["/from/job"]),
    ({"from": {"job": ["JOB"]}}, ["/from/job"]),
    ({"from": {"job": "JOB", "jobs": 1}}, ["/from/jobs"]),
    ({"from": {"job": "JOB", "size": [12, 4, 12]}}, ["/from/size"]),
    ({"from": {"job": "JOB", "size": [0, 4, 11]}}, ["/from/size/0"]),
    ({"from": {"job": "JOB", "at": [1, 0, 0]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [0, 0, -1]}}, ["/from/at/2"]),
    ({"from": {"job": "JOB", "at": [0, 0, 2147483647]}}, ["/from/at/2"]),
    ({"from": {"job": "JOB", "at": [0, 0]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [1, 0, 0]}, "parameters": {"size": [12, 9, 19]}}, ["/from/at"]),
    ({"parameters": {"size": [11, 4, 11]}}, ["/parameters/size"]),
    ({"parameters": {"size": [0, 4, 11]}}, ["/parameters/size/0"]),
    ({"from": {"job": "JOB", "box": {"min": [0, 0, 0], "max": [13, 1, 1]}}}, ["/from/box"]),
    ({"from": {"job": "JOB", "box": {"min": [1, 0, 0], "max": [1, 1, 1]}}}, ["/from/box"]),
    ({"from": {"job": "JOB", "box": [0, 0, 0]}}, ["/from/box"]),
    ({"from": {"job": "JOB", "cells": []}}, ["/from/cells"]),
    ({"from": {"job": "JOB", "cells": [[0, 0, 0], [0, 4, 0]]}}, ["/from/cells/1"]),
    ({"from": {"job": "JOB", "mask": "data:image/png;base64,AAAA"}}, ["/from/mask"]),
    ({"from": {"job": "JOB", "voxels": {"size": [1, 1, 1], "values": [2]}}},
     ["/from/voxels/values/0"]),
    ({"solver": "quantum"}, ["/solver"]),
    ({"example": "none"}, ["/example"]),
    ({"example": None}, ["/example"]),
    ({"parameters": {"weights": {"none": 1}, "order": "up"}}, ["/parameters/weights/none",
                                                              "/parameters/order"]),
    ({"parameters": {"boundary": {"east": "periodic"}}}, ["/parameters/boundary/east"]),
], ids=lambda value: json.dumps(value)[:70])
def test_faults_are_named_with_their_place(server, hills, change, expected):
    text = json.dumps({"from": {"job": "JOB"}, **change})
    request = json.loads(text.replace("JOB", hills[0]["id"]))
    assert_faults(post_job(server, request), request, expected)


def test_a_size_over_the_limit_is_too_large(server, hills):
    request = from_job(hills[0], parameters={"size": [4096, 4, 4096]})
    problem = assert_faults(post_job(server, request), request, ["/parameters/size"])
    assert problem["type"] == "/problems/too-large"


# --- the schema

def test_the_schema_of_from_says_what_the_server_takes(server, hills):
    schema = server.get("/v1/solvers/discrete").json()["from"]
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    job = {"job": hills[0]["id"]}
    verdicts = set()
    for value in (
            None, [], "x", {}, job, {"job": 7}, {"job": ""}, {**job, "more": 1},
            {**job, "size": SIZE}, {**job, "size": [12, 4]}, {**job, "size": None},
            {**job, "at": [0, 0, 0]}, {**job, "at": [0, 0, -1]}, {**job, "at": [0, 0, 0.5]},
            {**job, "box": BOX}, {**job, "box": {"min": [0, 0, 0]}}, {**job, "box": None},
            {**job, "cells": [[0, 0, 0]]}, {**job, "cells": []}, {**job, "cells": [[0, 0]]},
            {**job, "mask": grey_png([[0]])}, {**job, "mask": 1},
            {**job, "voxels": {"size": [1, 1, 1], "values": [1]}},
            {**job, "voxels": {"size": [1, 1, 1], "values": [1.5]}}, {**job, "voxels": {}}):
        answer = post_job(server, {"from": value, "seed": 1})
        assert (answer.status == 202) == validator.is_valid(value), (value, answer.body)
        verdicts.add(answer.status)
    assert verdicts == {202, 422}
    job, _ = make_model(server, example=HILLS, parameters={"size": SIZE})
    echo = post_job(server, from_job(job, box=BOX)).json()["request"]["from"]
    validator.validate(echo)

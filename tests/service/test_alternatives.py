"""Several different models of one request. The requests of the guide are posted as they stand."""

import hashlib
import json
import pathlib
import re

import pytest

from checks import (HILLS, assert_faults, assert_fits, assert_problem, endless_job, job_request, short, state_of,
                    wait_until)
from event_reader import EventReader, texts
from test_websocket import check_order, connect
from websocket_client import LabelGrid, StateFrame
from workload import STEADY_PASSES, YARD, submit

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "alternatives.md"
_REQUEST, _FROM = [json.loads(text) for text in
                   re.findall(r"```json\n(.*?)```", _GUIDE.read_text(), re.DOTALL)]

SIZE = [12, 4, 11]
HILLS_REQUEST = {"solver": "discrete", "example": HILLS, "seed": 5, "parameters": {"size": SIZE}}

# Two models of any size: which of the two pieces stands in the corner.
CHECKERS = {
    "kind": "discrete", "name": "checkers", "pieces": [{"name": "black"}, {"name": "white"}],
    "adjacency": {axis: [["black", "white"], ["white", "black"]] for axis in "xyz"},
}
# No two a side by side: so many as are asked for below are found from some seeds only.
APART = {"kind": "discrete", "name": "apart", "pieces": [{"name": "a"}, {"name": "b"}],
         "adjacency": {axis: [["a", "b"], ["b", "a"], ["b", "b"]] for axis in "xyz"}}
# A model with none: the corner has to be both.
IMPOSSIBLE = [{"kind": "fixed", "pieces": [piece], "cells": [[0, 0, 0]]}
              for piece in ("black", "white")]

# Three models with time to do something meanwhile.
LONG_SERIES = {"example": YARD, "size": (60, 6, 60), "alternatives": 3, "parameters": {
    "weights": "uniform", "blocks": {"size": [20, 6, 20], "overlap": 0.75,
                                     "passes": max(2, STEADY_PASSES // 3)}}}

# The same with few blocks that take long, so that whoever reads the frames is there for each.
SLOW_SERIES = {**LONG_SERIES, "size": (120, 10, 120), "parameters": {
    "weights": "uniform", "blocks": {"size": [60, 10, 60], "overlap": 0, "passes": 3}}}


def post(server, request):
    return server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})


def make(server, request):
    answer = post(server, request)
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def labels_of(server, job, alternative=None):
    query = "" if alternative is None else f"?alternative={alternative}"
    answer = server.get(f"/v1/jobs/{job['id']}/labels.json{query}")
    assert answer.status == 200, answer.body
    return answer.json()


def model_of(server, job, query=""):
    answer = server.get(f"/v1/jobs/{job['id']}/model.glb{query}")
    assert answer.status == 200, answer.body
    return answer.body


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def events_of_type(events, kind):
    return [event for event in events if event["type"] == kind]


@pytest.fixture(scope="module")
def series(server):
    """A job of three hills and its events."""
    job = make(server, {**HILLS_REQUEST, "alternatives": 3})
    return job, server.events(job["id"])


# --- what is made


def test_the_request_of_the_guide_makes_three_castles(server):
    job = make(server, _REQUEST)
    entries = job["result"]["alternatives"]
    assert [entry["alternative"] for entry in entries] == [0, 1, 2]
    assert len({entry["sha256"] for entry in entries}) == 3
    for entry in entries:
        model = server.get(entry["model"])
        assert model.status == 200
        assert sha256(model.body) == entry["sha256"]
        assert len(model.body) == entry["bytes"]


def test_each_alternative_is_a_model_of_its_own(server, series):
    job, _ = series
    models = [labels_of(server, job, k) for k in range(3)]
    assert len({json.dumps(model["cells"]) for model in models}) == 3
    for model in models:
        assert model["size"] == SIZE
        assert_fits(model, HILLS, job["request"]["parameters"]["boundary"])


def test_the_first_is_the_model_of_the_request_without_alternatives(server, series):
    job, _ = series
    alone = make(server, HILLS_REQUEST)
    assert model_of(server, job) == model_of(server, alone) == model_of(server, job, "?alternative=0")
    assert labels_of(server, job) == labels_of(server, alone) == labels_of(server, job, 0)
    result = {**job["result"]}
    entries = result.pop("alternatives")
    times = [stats.pop("solve_seconds") for stats in (result["stats"], alone["result"]["stats"])]
    assert all(time >= 0 for time in times)
    for name in ("model", "labels"):
        assert result.pop(name).startswith(f"/v1/jobs/{job['id']}/")
        alone["result"].pop(name)
    assert result == alone["result"]
    assert entries[0]["seed"] == job["seed"] == 5


def test_each_seed_gives_its_alternative_alone(server, series):
    job, _ = series
    for entry in job["result"]["alternatives"]:
        alone = make(server, {**HILLS_REQUEST, "seed": entry["seed"]})
        assert alone["result"]["sha256"] == entry["sha256"]


def test_equal_requests_give_equal_alternatives_on_any_number_of_workers(make_server, series):
    job, _ = series
    for workers in (1, 4):
        server = make_server(workers=workers, name=f"data{workers}")
        again = make(server, {**HILLS_REQUEST, "alternatives": 3})
        assert [entry["sha256"] for entry in again["result"]["alternatives"]] == \
               [entry["sha256"] for entry in job["result"]["alternatives"]]


def test_a_longer_series_begins_with_the_shorter_one(server, series):
    job, _ = series
    longer = make(server, {**HILLS_REQUEST, "alternatives": 5})
    assert [entry["sha256"] for entry in longer["result"]["alternatives"][:3]] == \
           [entry["sha256"] for entry in job["result"]["alternatives"]]


def test_one_alternative_is_a_list_of_one(server):
    job = make(server, {**HILLS_REQUEST, "alternatives": 1})
    assert len(job["result"]["alternatives"]) == 1
    assert job["request"]["alternatives"] == 1


def test_a_job_that_asks_for_none_tells_of_none(server):
    job = make(server, HILLS_REQUEST)
    assert "alternatives" not in job["result"]
    assert "alternatives" not in job["request"]
    assert all("alternative" not in event for event in server.events(job["id"]))
    assert server.get(f"/v1/jobs/{job['id']}/model.glb?alternative=0").status == 200
    assert_problem(server.get(f"/v1/jobs/{job['id']}/model.glb?alternative=1"), 404, "not-found")


def test_a_request_with_two_models_has_two_alternatives_however_many_are_asked_for(server):
    job = make(server, {"solver": "discrete", "example": CHECKERS, "seed": 1, "alternatives": 5,
                        "parameters": {"size": [4, 1, 4], "blocks": None}})
    models = [labels_of(server, job, entry["alternative"])["cells"]
              for entry in job["result"]["alternatives"]]
    assert sorted(model[0] for model in models) == [0, 1]
    ends = events_of_type(server.events(job["id"]), "alternative")
    assert [end["candidate"] for end in ends] == list(range(len(ends)))
    # The last eight brought nothing new, and each says what it is equal to.
    assert ["result" in end for end in ends[-9:]] == [True] + 8 * [False]
    for end in ends:
        assert ("result" in end) != ("same_as" in end)
        if "same_as" in end:
            assert end["same_as"] in range(len(models))
    assert_problem(server.get(f"/v1/jobs/{job['id']}/model.glb?alternative=2"), 404, "not-found")


def test_what_is_proved_impossible_fails_at_once(server):
    answer = post(server, {
        "solver": "discrete", "example": CHECKERS, "alternatives": 5,
        "parameters": {"size": [4, 1, 4], "blocks": None, "constraints": IMPOSSIBLE}})
    job = answer.json()
    assert job["state"] == "failed"
    assert job["error"]["type"] == "/problems/contradiction"
    assert events_of_type(server.events(job["id"]), "alternative") == []


def test_a_candidate_that_is_given_up_is_replaced(server):
    request = {"solver": "discrete", "example": APART, "seed": 0, "parameters": {
        "size": [9, 1, 9], "constraints": [{"kind": "count", "pieces": ["a"], "min": 35}]}}
    job = make(server, {**request, "alternatives": 3})
    assert len(job["result"]["alternatives"]) == 3
    events = server.events(job["id"])
    assert [event["type"] for event in events[:2]] == ["queued", "started"]
    ends = events_of_type(events, "alternative")
    failed = [end for end in ends if "error" in end]
    assert failed, "no candidate was given up"
    for end in failed:
        assert end["error"]["type"] == "/problems/gave-up"
        alone = post(server, {**request, "seed": end["seed"]}).json()
        assert alone["error"]["type"] == end["error"]["type"]
    assert len(ends) == 3 + len(failed)
    blocks = events_of_type(events, "block")
    assert [block["index"] for block in blocks] == list(range(len(blocks)))
    assert blocks[-1]["blocks_done"] == blocks[-1]["blocks_total"] == len(blocks)


# --- events and progress


def test_the_events_count_the_blocks_of_all_and_tell_each_end(series):
    job, events = series
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    blocks = events_of_type(events, "block")
    total = events_of_type(events, "started")[0]["blocks_total"]
    assert len(blocks) == total and total % 3 == 0
    assert [block["index"] for block in blocks] == list(range(total))
    assert [block["blocks_done"] for block in blocks] == list(range(1, total + 1))
    assert {block["blocks_total"] for block in blocks} == {total}
    assert blocks[-1]["fraction"] == 1
    assert [block["alternative"] for block in blocks] == sorted(list(range(3)) * (total // 3))
    ends = events_of_type(events, "alternative")
    assert [end["result"] for end in ends] == job["result"]["alternatives"]
    assert [(end["alternative"], end["candidate"]) for end in ends] == [(0, 0), (1, 1), (2, 2)]
    # Each end stands right after its last block.
    for end in ends:
        assert events[end["seq"] - 2]["type"] == "block"
        assert events[end["seq"] - 2]["alternative"] == end["alternative"]
    assert job["progress"] == {"blocks_done": total, "blocks_total": total, "fraction": 1}


def models_of(messages, size):
    """The models that the frames build up, by alternative, each begun with a whole state. A client
    who is behind is led to the model in hand, so that of an earlier one the end or all may be
    missing; such a one is left out."""
    ends = [message["seq"] for message in messages
            if isinstance(message, dict) and message["type"] == "alternative"]
    last_blocks = {message["alternative"]: message["seq"] for message in messages
                   if isinstance(message, dict) and message.get("outcome") == "accepted"}
    grids, newest = {}, {}
    for message in messages:
        if not isinstance(message, bytes):
            continue
        frame = StateFrame(message)
        # A state at an end is what the next model begins with, but for the last one's.
        model = sum(end <= frame.seq for end in ends[:-1])
        if model not in grids:
            assert frame.is_whole, "a new model begins with a whole state"
            assert not grids or max(grids) < model
            grids[model] = LabelGrid(size)
        grids[model].apply(frame)
        newest[model] = frame.seq
    return {model: grid.cells for model, grid in grids.items()
            if newest[model] >= last_blocks[model]}


@pytest.mark.parametrize("request_", [LONG_SERIES, SLOW_SERIES],
                         ids=["a client behind", "a client that keeps up"])
def test_label_frames_give_each_model_anew(server, request_):
    with endless_job(server), endless_job(server):  # no worker is free before the client is there
        job = submit(server, request_)
        client = connect(server, job, partial="labels")
    with client:
        messages = client.messages()
    check_order(messages)
    wanted = {k: labels_of(server, job, k)["cells"] for k in range(3)}
    models = models_of(messages, request_["size"])
    assert 2 in models
    assert models == {k: wanted[k] for k in models}


@pytest.mark.parametrize("restarted", [False, True])
def test_who_comes_after_the_end_sees_the_last_model(make_server, restarted):
    server = make_server()
    job = make(server, {**HILLS_REQUEST, "alternatives": 3})
    if restarted:  # then nothing of it is left in memory
        server.stop()
        server.start()
    with connect(server, job, partial="labels") as client:
        messages = client.messages()
    check_order(messages)
    assert models_of(messages, SIZE) == {2: labels_of(server, job, 2)["cells"]}


# --- while the job goes on


def first_end(server, job_id):
    with EventReader(server.port, job_id) as reader:
        return reader.until_event(lambda event: event["type"] == "alternative")[-1]


def test_an_alternative_can_be_had_while_the_job_goes_on(server):
    job = submit(server, {**LONG_SERIES, "alternatives": 40})
    end = first_end(server, job["id"])
    url = f"/v1/jobs/{job['id']}/model.glb"
    assert sha256(model_of(server, job, "?alternative=0")) == end["result"]["sha256"]
    assert server.get(f"{url}?alternative=0&profile=instanced").status == 200
    assert labels_of(server, job, 0)["size"] == [60, 6, 60]
    assert state_of(server, job) == "running"
    assert_problem(server.get(url), 409, "not-finished")
    assert_problem(server.get(f"{url}?alternative=39"), 409, "not-finished")
    assert_problem(server.get(f"{url}?alternative=40"), 404, "not-found")
    assert server.get(f"/v1/jobs/{job['id']}/preview.glb").status == 200
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")


def test_what_was_made_stays_when_the_job_is_cancelled(server):
    job = submit(server, {**LONG_SERIES, "alternatives": 40})
    end = first_end(server, job["id"])
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")
    assert server.wait(job["id"])["state"] == "cancelled"
    assert sha256(model_of(server, job, "?alternative=0")) == end["result"]["sha256"]
    assert_fits(labels_of(server, job, 0), YARD, job["request"]["parameters"]["boundary"])
    assert_problem(server.get(f"/v1/jobs/{job['id']}/model.glb"), 409, "no-model")
    assert_problem(server.get(f"/v1/jobs/{job['id']}/model.glb?alternative=39"), 409, "no-model")
    assert server.get(f"/v1/jobs/{job['id']}/preview.glb").status == 200
    assert server.request("DELETE", f"/v1/jobs/{job['id']}").status == 204
    assert_problem(server.get(f"/v1/jobs/{job['id']}/model.glb?alternative=0"), 404, "not-found")


def test_deleting_the_job_takes_the_files_of_all_alternatives(make_server):
    server = make_server()
    job = make(server, {**HILLS_REQUEST, "alternatives": 3})
    for k in range(3):
        model_of(server, job, f"?alternative={k}&profile=merged")
    files = [path for path in server.data.glob("artifacts/**/*") if path.is_file()]
    assert len(files) >= 9
    assert server.request("DELETE", f"/v1/jobs/{job['id']}").status == 204
    wait_until(lambda: not [path for path in server.data.glob("artifacts/**/*") if path.is_file()])


@pytest.mark.parametrize("moment", [("started", 1), ("block", 3), ("alternative", 1),
                                    ("alternative", 2)], ids=short)
def test_killed_anywhere_the_series_goes_on_to_the_same_models(make_server, moment):
    server = make_server()
    undisturbed = server.wait(submit(server, LONG_SERIES)["id"], timeout=120)
    assert undisturbed["state"] == "succeeded"
    job = submit(server, LONG_SERIES)
    kind, times = moment
    seen = []
    with EventReader(server.port, job["id"]) as reader:
        for _ in range(times):
            seen += reader.until_event(lambda event: event["type"] == kind)
    server.kill()
    server.start()
    ended = server.wait(job["id"], timeout=120)
    assert ended["state"] == "succeeded", ended["error"]
    assert [entry["sha256"] for entry in ended["result"]["alternatives"]] == \
           [entry["sha256"] for entry in undisturbed["result"]["alternatives"]]
    with EventReader(server.port, job["id"]) as reader:
        events = reader.rest()
    assert texts(events)[:len(seen)] == texts(seen)
    blocks = events_of_type(events, "block")
    assert [block["index"] for block in blocks] == list(range(blocks[0]["blocks_total"]))
    assert [end["candidate"] for end in events_of_type(events, "alternative")] == [0, 1, 2]
    for k in range(3):
        assert sha256(model_of(server, ended, f"?alternative={k}")) == \
            ended["result"]["alternatives"][k]["sha256"]


def test_a_deadline_leaves_what_was_made(server):
    job = submit(server, {**LONG_SERIES, "alternatives": 40, "deadline": 1.5})
    ended = server.wait(job["id"])
    assert ended["state"] == "failed"
    assert ended["error"]["type"] == "/problems/deadline-exceeded"
    made = len(events_of_type(server.events(job["id"]), "alternative"))
    for k in range(made):
        assert server.get(f"/v1/jobs/{job['id']}/labels.json?alternative={k}").status == 200


def test_an_expired_alternative_is_gone(make_server):
    server = make_server("--retention-hours", "0.001")  # 3.6 seconds
    job = make(server, {**HILLS_REQUEST, "alternatives": 2})
    url = f"/v1/jobs/{job['id']}/model.glb?alternative=1"
    assert server.get(url).status == 200
    wait_until(lambda: server.get(url).status == 410, timeout=10)
    for what in ("model.glb", "labels.json"):
        answer = server.get(f"/v1/jobs/{job['id']}/{what}?alternative=1")
        assert_problem(answer, 410, "expired")


# --- starting from one


def test_a_job_starts_from_the_alternative_that_it_names(server, series):
    job, _ = series
    for k in (0, 2):
        start = {"from": {"job": job["id"], "alternative": k,
                          "box": {"min": [3, 0, 2], "max": [9, 4, 8]}}, "seed": 3}
        made = make(server, start)
        assert made["request"]["from"].get("alternative", 0) == k
        assert "alternatives" not in made["request"], "it is asked for anew by each request"
        before, after = labels_of(server, job, k), labels_of(server, made)
        width, height, depth = SIZE
        outside = [x + width * (z + depth * y) for x in range(width) for y in range(height)
                   for z in range(depth) if not (3 <= x < 9 and 2 <= z < 8)]
        assert [after["cells"][i] for i in outside] == [before["cells"][i] for i in outside]
        # Sent again, what the job shows of its request gives the same model.
        assert make(server, made["request"])["result"]["sha256"] == made["result"]["sha256"]


def test_the_request_of_the_guide_starts_from_the_third(server):
    job = make(server, _REQUEST)
    request = {**_FROM, "from": {**_FROM["from"], "job": job["id"]}}
    made = make(server, request)
    assert made["request"]["from"]["alternative"] == 2


def test_alternatives_of_a_part_made_anew(server, series):
    job, _ = series
    box = {"min": [3, 0, 2], "max": [9, 4, 8]}
    made = make(server, {"from": {"job": job["id"], "box": box}, "seed": 3, "alternatives": 3})
    assert len(made["result"]["alternatives"]) == 3


def test_an_alternative_that_the_job_does_not_have_is_a_fault(server, series):
    job, _ = series
    for k in (3, 64, -1):
        request = {"from": {"job": job["id"], "alternative": k}}
        assert_faults(post(server, request), request, ["/from/alternative"])


# --- bad requests


@pytest.mark.parametrize("value", [0, 65, -1, 1.5, "3", None, [], {}])
def test_alternatives_must_be_from_1_to_64(server, value):
    request = job_request(alternatives=value)
    assert_faults(post(server, request), request, ["/alternatives"])


def test_64_alternatives_are_made(server):
    job = make(server, {**HILLS_REQUEST, "alternatives": 64})
    assert len(job["result"]["alternatives"]) == 64
    assert len({entry["sha256"] for entry in job["result"]["alternatives"]}) == 64


def test_all_together_keep_to_the_limits_of_one(server):
    size = [500, 8, 500]  # 2 000 000 cells; two of them are just allowed
    answer = server.request("POST", "/v1/jobs", job_request(
        alternatives=2, parameters={"size": size}, deadline=0.01))
    assert answer.status == 202, answer.body
    problem = assert_problem(
        post(server, job_request(alternatives=3, parameters={"size": size})), 422, "too-large")
    assert [error["pointer"] for error in problem["errors"]] == ["/alternatives"]
    blocks = {"size": [2, 2, 2], "overlap": 0}
    problem = assert_problem(post(server, job_request(
        alternatives=33, parameters={"size": [200, 2, 250], "blocks": blocks})), 422, "too-large")
    assert [error["pointer"] for error in problem["errors"]] == ["/alternatives"]


@pytest.mark.parametrize("query,status", [
    ("alternative=-1", 422), ("alternative=x", 400), ("alternative=", 400), ("alternative=1.0", 400),
    ("alternative=64", 422), ("alternatives=1", 400)])
@pytest.mark.parametrize("what", ["model.glb", "labels.json"])
def test_a_bad_alternative_in_the_query_is_refused(server, series, what, query, status):
    job, _ = series
    assert_problem(server.get(f"/v1/jobs/{job['id']}/{what}?{query}"), status)


def test_the_schema_tells_of_alternatives(server):
    solver = server.get("/v1/solvers/discrete").json()
    assert solver["alternatives"]["maximum"] == 64
    assert solver["from"]["properties"]["alternative"]["maximum"] == 63

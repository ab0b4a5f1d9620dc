"""Every constraint, asked for over HTTP and checked on the model by other code than the solver's.
The requests are those of the documentation."""

import json
import pathlib
import re

import pytest

from checks import assert_faults, assert_fits, job_request, make_job, state_of, wait_until
from constraint_oracle import Oracle, grey_png

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "constraints.md"
_REQUESTS = [json.loads(text) for text in
             re.findall(r"```json\n(.*?)```", _GUIDE.read_text(), re.DOTALL)]


def _name(request):
    return "+".join(one["kind"] for one in request["parameters"]["constraints"])


def make(server, request):
    answer = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job, server.get(f"/v1/jobs/{job['id']}/labels.json").json()


@pytest.mark.parametrize("request_", _REQUESTS, ids=_name)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_guides_request_gives_what_it_asks_for(server, request_, seed):
    job, labels = make(server, {**request_, "seed": seed})
    echoed = job["request"]["parameters"]
    oracle = Oracle(labels, echoed["boundary"])
    assert len(echoed["constraints"]) == len(request_["parameters"]["constraints"])
    for asked, told in zip(request_["parameters"]["constraints"], echoed["constraints"]):
        found = {"mirror": told["mirror"]} if told["kind"] == "symmetry" else {}
        assert oracle.violation({**asked, **found}) is None, asked
        if asked.get("mirror") == "auto":
            asked = {**asked, **found}
        assert _tells(told, asked), "the echo tells something else"
    example = request_["example"]
    if isinstance(example, str):
        example = server.get(f"/v1/examples/{example}").json()
    assert_fits(labels, example, echoed["boundary"])


def _tells(told, asked):
    """Whether all that was asked is told, perhaps with defaults beside it."""
    if isinstance(asked, dict):
        return all(name in told and _tells(told[name], value) for name, value in asked.items())
    if isinstance(asked, list):
        return len(asked) == len(told) and all(map(_tells, told, asked))
    return told == asked


def test_the_guide_has_every_kind(server):
    schema = server.get("/v1/solvers/discrete").json()["parameters"]
    kinds = {one["properties"]["kind"]["const"] for one in
             schema["$defs"]["constraint"]["oneOf"]}
    shown = {one["kind"] for request in _REQUESTS for one in request["parameters"]["constraints"]}
    assert shown == kinds


@pytest.mark.parametrize("request_", _REQUESTS, ids=_name)
def test_without_the_constraint_some_model_violates_it(server, request_):
    """Or the checks above would show nothing."""
    parameters = {name: value for name, value in request_["parameters"].items()
                  if name != "constraints"}
    told = make(server, request_)[0]["request"]["parameters"]["constraints"]
    violated = []
    for seed in range(1, 9):
        job, labels = make(server, {**request_, "seed": seed, "parameters": parameters})
        oracle = Oracle(labels, job["request"]["parameters"]["boundary"])
        violated += [one for one in told if oracle.violation(one) is not None]
    assert violated or all(_asks_nothing_sharp(one)
                           for one in request_["parameters"]["constraints"])


def _asks_nothing_sharp(constraint):
    return constraint["kind"] in ("resemblance", "best_of") or constraint.get("weight", 0) > 0


def test_a_resemblance_makes_windows_those_of_the_example(server):
    """Cells of more labels than two may have neighbours that never stood together in threes."""
    example = {"kind": "discrete", "name": "weave",
               "pieces": [{"name": name} for name in "abcd"], "size": [6, 1, 6],
               "cells": [0, 1, 2, 3, 0, 1, 1, 2, 3, 0, 1, 2, 2, 3, 0, 1, 2, 3,
                         0, 0, 1, 1, 2, 2, 0, 1, 0, 1, 0, 1, 3, 3, 2, 2, 1, 1]}

    def windows(size, cells):
        return [tuple(cells[x + i + size * (z + j)] for i in range(3) for j in range(3))
                for x in range(size - 2) for z in range(size - 2)]
    known = set(windows(6, example["cells"]))
    shares = {}
    for name, constraints in (("without", []), ("with", [{"kind": "resemblance"}])):
        found = []
        for seed in range(1, 6):
            job = make_job(server, {"size": [20, 1, 20], "constraints": constraints},
                           example=example, seed=seed)
            cells = server.get(f"/v1/jobs/{job['id']}/labels.json").json()["cells"]
            found += [window in known for window in windows(20, cells)]
        shares[name] = sum(found) / len(found)
    assert shares["with"] > 1.5 * shares["without"], shares


@pytest.mark.parametrize("term", [
    {"term": "density", "pieces": ["red"], "target": 0.25},
    {"term": "count", "pieces": ["red"], "target": 40},
    {"term": "height_profile", "pieces": ["red"], "profile": [1, 0.5, 0]},
    {"term": "shape", "pieces": ["red"]},
], ids=lambda term: term["term"])
@pytest.mark.parametrize("temperature", [0, 0.001])
def test_an_objective_is_come_close_to_and_told(server, term, temperature):
    example = anything_goes("red", "green")
    region = {"box": {"min": [2, 0, 2], "max": [8, 6, 8]}}
    constraint = {"kind": "objective", "terms": [term], "temperature": temperature, **region}
    job = make_job(server, {"size": [10, 6, 10], "constraints": [constraint],
                            "blocks": {"size": [2, 2, 2], "passes": 6}}, example=example)
    labels = server.get(f"/v1/jobs/{job['id']}/labels.json").json()
    told = job["result"]["stats"]
    reached = Oracle(labels, job["request"]["parameters"]["boundary"]).sum_of(constraint)
    assert told["objective"] == pytest.approx(reached, abs=1e-9)
    assert told["blocks_declined"] > 0
    assert told["blocks_declined"] <= told["blocks_reverted"]
    # A model drawn without the objective is half red everywhere.
    assert reached < {"density": 0.02, "count": 2, "height_profile": 0.05, "shape": 0.25}[
        term["term"]], reached


def test_the_best_of_several_is_the_best(server):
    constraint = {"kind": "best_of", "n": 6,
                  "terms": [{"term": "count", "pieces": ["red"], "weight": 2}]}
    example = anything_goes("red", "green")
    best = make_job(server, {"constraints": [constraint]}, example=example, seed=5)
    plain = make_job(server, {"constraints": []}, example=example, seed=5)
    stats = best["result"]["stats"]
    assert len(stats["candidates"]) == 6 and len(set(stats["candidates"])) > 1
    assert stats["objective"] == min(stats["candidates"])
    for job, value in ((best, stats["objective"]), (plain, stats["candidates"][0])):
        labels = server.get(f"/v1/jobs/{job['id']}/labels.json").json()
        oracle = Oracle(labels, job["request"]["parameters"]["boundary"])
        assert oracle.sum_of(constraint) == value


def anything_goes(*pieces):
    return {"kind": "discrete", "name": "any", "pieces": [{"name": name} for name in pieces],
            "adjacency": {axis: [[a, b] for a in pieces for b in pieces] for axis in "xyz"}}


def test_a_probability_changes_how_often_pieces_stand(server):
    """Ten times the weight in one half of the model, a tenth in the other."""
    example = anything_goes("red", "green")
    west, east = ({"min": [low, 0, 0], "max": [low + 20, 1, 40]} for low in (0, 20))
    job = make_job(server, {"size": [40, 1, 40], "constraints": [
        {"kind": "probability", "pieces": ["red"], "weight": 10, "box": west},
        {"kind": "probability", "pieces": ["red"], "weight": 0.1, "box": east}]}, example=example)
    labels = server.get(f"/v1/jobs/{job['id']}/labels.json").json()
    cells = labels["cells"]
    red = {side: sum(cells[x + 40 * z] == 0 for x in xs for z in range(40)) / 800
           for side, xs in (("west", range(20)), ("east", range(20, 40)))}
    # 10/11 and 1/11 of 800 cells; the standard deviation is 0.01.
    assert abs(red["west"] - 10 / 11) < 0.05 and abs(red["east"] - 1 / 11) < 0.05, red


RED = {"pieces": ["red"]}


@pytest.mark.parametrize("constraint, expected", [
    ({"kind": "count", **RED}, [""]),
    ({"kind": "count", **RED, "min": -1}, ["/min"]),
    ({"kind": "count", **RED, "min": 5, "max": 4}, ["/max"]),
    ({"kind": "count", **RED, "min": 49}, ["/min"]),
    ({"kind": "count", **RED, "min": 1, "distance": 1}, ["/distance"]),
    ({"kind": "separation", **RED}, ["/distance"]),
    ({"kind": "separation", **RED, "distance": 0}, ["/distance"]),
    ({"kind": "separation", **RED, "distance": 65}, ["/distance"]),
    ({"kind": "max_run", **RED, "axis": "w"}, ["/max", "/axis"]),
    ({"kind": "probability", **RED}, ["/weight"]),
    ({"kind": "probability", **RED, "weight": -0.5}, ["/weight"]),
    ({"kind": "path", **RED, "from": [0, 0, 0]}, ["/to"]),
    ({"kind": "path", **RED, "from": [0, 0, 0], "to": [6, 0, 0]}, ["/to"]),
    ({"kind": "path", **RED, "from": [0, 0, 0], "to": [5, 0, 0],
      "box": {"min": [0, 0, 0], "max": [5, 2, 4]}}, ["/to"]),
    ({"kind": "connected", "pieces": ["purple"]}, ["/pieces/0"]),
    ({"kind": "acyclic", **RED, "min": 1}, ["/min"]),
    ({"kind": "fixed", **RED, "voxels": {"size": [2, 1, 1], "values": [1]}}, ["/voxels/values"]),
    ({"kind": "fixed", **RED, "voxels": {"size": [1, 1, 1], "values": [1.5]}},
     ["/voxels/values/0"]),
    ({"kind": "fixed", **RED, "voxels": {"size": [0, 1, 1], "values": []}},
     ["/voxels/size/0", "/voxels/values"]),
    ({"kind": "symmetry"}, [""]),
    ({"kind": "symmetry", "reflect": "x", "rotate": 2}, [""]),
    ({"kind": "symmetry", "reflect": "y"}, ["/reflect"]),
    ({"kind": "symmetry", "rotate": 3}, ["/rotate"]),
    ({"kind": "symmetry", "rotate": 4}, ["/rotate"]),  # the model is not square
    ({"kind": "symmetry", "translate": [0, 0, 0]}, ["/translate"]),
    ({"kind": "symmetry", "translate": [1, 0]}, ["/translate"]),
    ({"kind": "symmetry", "reflect": "x", "pieces": ["red"]}, ["/pieces"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"red": "purple"}}, ["/mirror/red"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"red": 1}}, ["/mirror/red"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": "found"}, ["/mirror"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"red": "blue", "green": "blue"}},
     ["/mirror"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"red": "green", "green": "blue"}},
     ["/mirror"]),
    ({"kind": "resemblance", "window": 4}, ["/window"]),
    ({"kind": "resemblance", "threshold": -1}, ["/threshold"]),
    ({"kind": "resemblance", "box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, ["/box"]),
    ({"kind": "objective"}, ["/terms"]),
    ({"kind": "objective", "terms": []}, ["/terms"]),
    ({"kind": "objective", "terms": [{"term": "beauty"}]}, ["/terms/0/term"]),
    ({"kind": "objective", "terms": [{"term": "shape"}]}, ["/terms/0/term"]),
    ({"kind": "objective", "terms": [{"term": "height_profile"}]}, ["/terms/0/profile"]),
    ({"kind": "objective", "terms": [{"term": "density", "target": 2}]}, ["/terms/0/target"]),
    ({"kind": "objective", "terms": [{"term": "density", "profile": [1]}]}, ["/terms/0/profile"]),
    ({"kind": "objective", "terms": [{"term": "count", "pieces": ["purple"]}]},
     ["/terms/0/pieces/0"]),
    ({"kind": "objective", "terms": [{"term": "count"}], "temperature": -1}, ["/temperature"]),
    ({"kind": "best_of", "terms": [{"term": "count"}]}, ["/n"]),
    ({"kind": "best_of", "terms": [{"term": "count"}], "n": 65}, ["/n"]),
    ({"kind": "fixed", **RED, "mask": [[1]]}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": "data:image/jpeg;base64,AAAA"}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": grey_png([[1]])[:-8]}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": grey_png([[1]]).replace(",", ",?")}, ["/mask"]),
], ids=lambda value: json.dumps(value)[:60])
def test_faults_are_named_with_their_place(server, constraint, expected):
    request = job_request({"constraints": [constraint]})
    answer = server.request("POST", "/v1/jobs", request)
    assert_faults(answer, request, ["/parameters/constraints/0" + place for place in expected])


def test_some_kinds_stand_once_and_an_objective_needs_blocks(server):
    best = {"kind": "best_of", "n": 1, "terms": [{"term": "count"}]}
    for constraints, blocks, place in (
            ([best, best], {}, "/1/kind"),
            ([{"kind": "resemblance"}] * 2, {}, "/1/kind"),
            ([{"kind": "objective", "terms": [{"term": "count"}]}], None, "/0/kind")):
        request = job_request({"constraints": constraints, "blocks": blocks})
        answer = server.request("POST", "/v1/jobs", request)
        assert_faults(answer, request, ["/parameters/constraints" + place])


def test_the_number_of_constraints_that_span_the_model_is_limited(server):
    one = {"kind": "count", "pieces": ["red"], "min": 0}
    assert make_job(server, {"constraints": [one] * 32})["state"] == "succeeded"
    request = job_request({"constraints": [one] * 33})
    assert_faults(server.request("POST", "/v1/jobs", request), request, ["/parameters/constraints"])


@pytest.mark.parametrize("given, told", [
    ({"mirror": "auto"}, {"start": "end", "end": "start"}),
    ({}, {}),
    ({"mirror": {"start": "end"}}, {"start": "end"}),
], ids=["found", "own", "named"])
def test_the_echo_tells_the_images_of_pieces(server, given, told):
    example = {"kind": "discrete", "name": "walls",
               "pieces": [{"name": name} for name in ("grass", "start", "wall", "end")],
               "size": [6, 1, 3], "cells": [0] * 7 + [1, 2, 2, 3] + [0] * 7}
    job = make_job(server, {"constraints": [{"kind": "symmetry", "reflect": "x", **given}]},
                   example=example)
    assert job["request"]["parameters"]["constraints"][0]["mirror"] == told


def test_the_number_of_symmetries_is_limited(server):
    one = {"kind": "symmetry", "reflect": "x"}
    example = anything_goes("red", "green")
    job = make_job(server, {"constraints": [one] * 8}, example=example)
    assert job["state"] == "succeeded"
    request = job_request({"constraints": [one] * 9}, example=example)
    answer = server.request("POST", "/v1/jobs", request)
    problem = assert_faults(answer, request, ["/parameters/constraints"])
    assert problem["type"] == "/problems/too-large"


def test_masks_are_limited_in_size_and_number(server):
    fits = {"kind": "probability", **RED, "weight": 1, "mask": grey_png([[0] * 1024])}
    assert make_job(server, {"constraints": [fits] * 16})["state"] == "succeeded"
    for constraints, place in (([fits] * 17, ""),
                               ([{**fits, "mask": grey_png([[0] * 1025])}], "/0/mask")):
        request = job_request({"constraints": constraints})
        answer = server.request("POST", "/v1/jobs", request)
        problem = assert_faults(answer, request, ["/parameters/constraints" + place])
        assert problem["type"] == "/problems/too-large"


def test_a_mask_lies_with_its_first_row_in_the_north_and_its_first_pixel_in_the_west(server):
    example = anything_goes("dark", "light")
    rows = [[255, 0, 0], [0, 0, 255]]
    job = make_job(server, {"size": [6, 2, 4], "constraints": [
        {"kind": "fixed", "pieces": ["light"], "mask": grey_png(rows)},
        {"kind": "fixed", "pieces": ["dark"],
         "mask": grey_png([[255 - value for value in row] for row in rows])}]}, example=example)
    cells = server.get(f"/v1/jobs/{job['id']}/labels.json").json()["cells"]
    floor = [1, 1, 0, 0, 0, 0] * 2 + [0, 0, 0, 0, 1, 1] * 2
    assert cells == floor * 2


@pytest.mark.parametrize("constraints, kind, words", [
    ([{"kind": "count", "pieces": ["red"], "max": 0},
      {"kind": "path", "pieces": ["red", "green"], "from": [0, 0, 0], "to": [5, 0, 3]}],
     "contradiction", "constraint 0 (count of \"red\")"),
    ([{"kind": "path", "pieces": ["red"], "from": [0, 0, 0], "to": [1, 0, 0]}],
     "contradiction", None),
])
def test_what_cannot_hold_is_said_to_be_impossible(server, constraints, kind, words):
    job = make_job(server, {"constraints": constraints})
    assert job["state"] == "failed"
    assert job["error"]["type"] == f"/problems/{kind}", job["error"]
    assert words is None or words in job["error"]["detail"], job["error"]


def test_a_search_of_the_whole_under_constraints_can_be_stopped(server):
    """Each of its choices asks for the connections of everything: without end, seen from here."""
    streets = _REQUESTS[[_name(one) for one in _REQUESTS].index("connected")]
    job = server.request("POST", "/v1/jobs", {**streets, "parameters": {
        **streets["parameters"], "size": [400, 10, 400], "blocks": None}}).json()
    wait_until(lambda: state_of(server, job) == "running")
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")
    assert server.wait(job["id"])["state"] == "cancelled"


def test_the_same_request_gives_the_same_model(server):
    for request in _REQUESTS:
        first, second = (make(server, {**request, "seed": 9})[0] for _ in range(2))
        assert first["result"]["sha256"] == second["result"]["sha256"]

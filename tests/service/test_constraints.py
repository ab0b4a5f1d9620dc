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
        assert oracle.violation(asked) is None, asked
        assert {**told, **asked} == told, "the echo tells something else"
    example = server.get(f"/v1/examples/{request_['example']}").json()
    assert_fits(labels, example, echoed["boundary"])


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
    violated = []
    for seed in range(1, 9):
        job, labels = make(server, {**request_, "seed": seed, "parameters": parameters})
        oracle = Oracle(labels, job["request"]["parameters"]["boundary"])
        violated += [one for one in request_["parameters"]["constraints"]
                     if oracle.violation(one) is not None]
    asks_nothing_sharp = all(one["kind"] == "probability" and one["weight"] > 0
                             for one in request_["parameters"]["constraints"])
    assert violated or asks_nothing_sharp


def test_a_probability_changes_how_often_pieces_stand(server):
    """Ten times the weight in one half of the model, a tenth in the other."""
    pieces = ["red", "green"]
    example = {"kind": "discrete", "name": "any", "pieces": [{"name": name} for name in pieces],
               "adjacency": {axis: [[a, b] for a in pieces for b in pieces] for axis in "xyz"}}
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
    ({"kind": "fixed", **RED, "mask": [[1]]}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": "data:image/jpeg;base64,AAAA"}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": grey_png([[1]])[:-8]}, ["/mask"]),
    ({"kind": "fixed", **RED, "mask": grey_png([[1]]).replace(",", ",?")}, ["/mask"]),
], ids=lambda value: json.dumps(value)[:60])
def test_faults_are_named_with_their_place(server, constraint, expected):
    request = job_request({"constraints": [constraint]})
    answer = server.request("POST", "/v1/jobs", request)
    assert_faults(answer, request, ["/parameters/constraints/0" + place for place in expected])


def test_the_number_of_constraints_that_span_the_model_is_limited(server):
    one = {"kind": "count", "pieces": ["red"], "min": 0}
    assert make_job(server, {"constraints": [one] * 32})["state"] == "succeeded"
    request = job_request({"constraints": [one] * 33})
    assert_faults(server.request("POST", "/v1/jobs", request), request, ["/parameters/constraints"])


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
    tiles = ["dark", "light"]
    example = {"kind": "discrete", "name": "any", "pieces": [{"name": name} for name in tiles],
               "adjacency": {axis: [[a, b] for a in tiles for b in tiles] for axis in "xyz"}}
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

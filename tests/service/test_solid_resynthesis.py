"""Jobs of solids that start from a finished one, by the corners of what is made."""

import json
import pathlib
import re

import jsonschema
import pytest

from checks import assert_faults, job_request
from constraint_oracle import grey_png
from test_continuous import HUT, model_of, triangles_by_material

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "resynthesis.md"
_OF_SOLIDS = _GUIDE.read_text().partition("## Solids")[2]
_FIRST, *_REQUESTS = [json.loads(text) for text in
                      re.findall(r"```json\n(.*?)```", _OF_SOLIDS, re.DOTALL)]

SIZE = [16.0, 5.0, 14.0]
BOX = {"min": [0, 0, 0], "max": [9, 5, 14]}
HUTS = {"solver": "continuous", "example": HUT, "seed": 4,
        "parameters": {"size": SIZE, "density": 0.7}}


def post(server, request):
    return server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})


def make(server, request):
    answer = post(server, request)
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def from_job(job, seed=6, parameters=None, **place):
    request = {"from": {"job": job["id"], **place}, "seed": seed}
    if parameters is not None:
        request["parameters"] = parameters
    return request


def corners(server, job, material=None, at=(0, 0, 0)):
    """Where triangles of the material, or of all above the ground, have corners, moved."""
    triangles = triangles_by_material(model_of(server, job))
    chosen = sum(triangles.values(), []) if material is None else triangles.get(material, [])
    return {tuple(round(p + a, 3) for p, a in zip(corner, at))
            for triangle in chosen for corner in triangle
            if material is not None or max(y for _, y, _ in triangle) > 0}


@pytest.fixture(scope="module")
def huts(server):
    return make(server, HUTS)


@pytest.fixture(scope="module")
def village(server):
    return make(server, _FIRST)


@pytest.mark.parametrize("request_", _REQUESTS, ids=range(len(_REQUESTS)))
def test_the_guides_requests_keep_all_but_what_they_name(server, village, request_):
    request = {**request_, "from": {**request_["from"], "job": village["id"]}}
    job = make(server, request)
    assert {**job["request"]["from"], **request["from"]} == job["request"]["from"]
    assert job["result"]["stats"]["changed"] > 0
    at = request["from"].get("at", (0, 0, 0))
    box = request["from"].get("box", {"min": [0, 0, 0], "max": at})
    older, newer = corners(server, village, at=at), corners(server, job)
    wide = 0.5

    def is_kept(corner):
        """Inside of the older model, where new things may not touch it, and beyond the box, further
        than a moulding is wide."""
        x, _, z = (p - a for p, a in zip(corner, at))
        width, _, depth = _FIRST["parameters"]["size"]
        return wide < x < width - wide and wide < z < depth - wide and \
            any(p > most + wide for p, most in zip(corner, box["max"]))
    kept = set(filter(is_kept, older))
    assert kept and kept == set(filter(is_kept, newer))
    assert newer != older
    for rule in request.get("parameters", {}).get("constraints", []):
        assert not any(all(low + wide < p < high - wide for p, low, high in
                           zip(corner, rule["box"]["min"], rule["box"]["max"]))
                       for corner in newer)


@pytest.mark.parametrize("place", [
    {"box": BOX},
    {"mask": grey_png([[255] * 9 + [0] * 7])},
    {"voxels": {"size": [16, 1, 1], "values": [0.5] * 9 + [0.49] * 7}},
], ids=lambda place: next(iter(place)))
def test_only_the_region_is_made_anew_however_it_is_named(server, huts, place):
    job = make(server, from_job(huts, **place))
    older, newer = corners(server, huts, "wall"), corners(server, job, "wall")
    assert {one for one in older if one[0] > 9} == {one for one in newer if one[0] > 9}
    assert older != newer
    echo = job["request"]
    assert {key: value for key, value in echo["from"].items() if key not in place} == \
        {"job": huts["id"], "size": SIZE, "at": [0.0, 0.0, 0.0]}
    assert echo["parameters"] == huts["request"]["parameters"]
    assert (echo["solver"], echo["example"]) == ("continuous", huts["request"]["example"])
    again = make(server, echo)
    assert again["result"]["sha256"] == job["result"]["sha256"]
    assert again["request"] == echo


def test_places_of_constraints_go_with_a_model_that_grows(server):
    rule = {"kind": "forbidden", "objects": ["wall"],
            "box": {"min": [0.0, 0.0, 0.0], "max": [4.0, 5.0, 4.0]}}
    earlier = make(server, {**HUTS, "parameters": {**HUTS["parameters"], "constraints": [rule]}})
    job = make(server, from_job(earlier, at=[3, 0, 2], parameters={"size": [20, 5, 18]}))
    told = job["request"]["parameters"]
    assert told["constraints"] == [
        {**rule, "box": {"min": [3.0, 0.0, 2.0], "max": [7.0, 5.0, 6.0]}}]
    assert told["density"] == 0.7
    older = corners(server, earlier, "wall", (3, 0, 2))
    assert older <= corners(server, job, "wall")


@pytest.mark.parametrize("rule", [
    {"kind": "probability", "objects": ["wall"], "weight": 0.5, "mask": grey_png([[255, 0]])},
    {"kind": "symmetry", "reflect": "x"},
], ids=lambda rule: rule["kind"])
def test_what_was_for_a_model_of_its_size_has_to_be_given_anew(server, rule):
    earlier = make(server, {**HUTS, "parameters": {**HUTS["parameters"], "constraints": [rule]}})
    request = from_job(earlier, parameters={"size": [20, 5, 18]})
    assert_faults(post(server, request), {**request, "parameters": {"constraints": [], "size": 1}},
                  ["/parameters/constraints"])
    request["parameters"]["constraints"] = []
    make(server, request)
    if rule["kind"] == "symmetry":  # of the same size it stays about the middle
        box = {"min": [0, 0, 3], "max": [16, 5, 11]}
        walls = corners(server, make(server, from_job(earlier, box=box)), "wall")
        assert walls == {(16 - x, y, z) for x, y, z in walls}


def test_the_earlier_job_and_its_example_may_be_deleted(server):
    uploaded = server.request("POST", "/v1/examples", {**HUT, "name": "hut of one's own"}).json()
    earlier = make(server, {**HUTS, "example": uploaded["id"]})
    middle = make(server, from_job(earlier, box=BOX))
    for path in (f"/v1/jobs/{earlier['id']}", f"/v1/examples/{uploaded['id']}"):
        assert server.request("DELETE", path).status == 204
    job = make(server, from_job(middle, seed=7, box=BOX))
    kept = {one for one in corners(server, middle, "wall") if one[0] > 9}
    assert kept == {one for one in corners(server, job, "wall") if one[0] > 9}


@pytest.mark.parametrize("change, expected", [
    ({"from": {"job": "JOB", "size": [16, 5, 15]}}, ["/from/size"]),
    ({"from": {"job": "JOB", "size": [0, 5, 14]}}, ["/from/size/0"]),
    ({"from": {"job": "JOB", "at": [1, 0, 0]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [0, 0, -1]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [0, 0]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [0, 0, "1"]}}, ["/from/at/2"]),
    ({"from": {"job": "JOB", "at": [0.5, 0, 0]}, "parameters": {"size": [20, 5, 14]}}, ["/from/at"]),
    ({"from": {"job": "JOB", "at": [0, 1, 0]}, "parameters": {"size": [16, 9, 14]}}, ["/from/at"]),
    ({"parameters": {"size": [15, 5, 14]}}, ["/parameters/size"]),
    ({"parameters": {"spacing": 0.5}}, ["/from/job"]),
    ({"parameters": {"offsets": [{"normal": [1, 0, 0], "offsets": [1, 2, 3]}]}}, ["/from/job"]),
    ({"from": {"job": "JOB", "box": {"min": [1, 0, 0], "max": [1, 1, 1]}}}, ["/from/box"]),
    ({"from": {"job": "JOB", "cells": [[0, 0, 0]]}}, ["/from/cells"]),
    ({"from": {"job": "JOB", "mask": "data:image/png;base64,AAAA"}}, ["/from/mask"]),
    ({"solver": "discrete"}, ["/solver"]),
    ({"solver": "quantum"}, ["/solver"]),
    ({"solver": None}, ["/solver"]),
    ({"solver": "quantum", "from": {"job": "JOB", "at": [0, 0, 0]}, "example": "castle"},
     ["/solver", "/example"]),
    ({"example": "houses"}, ["/example"]),
    ({"example": "castle"}, ["/example"]),
    ({"parameters": {"weights": {"none": 1}}}, ["/parameters/weights/none"]),
    ({"parameters": {"density": 0}}, ["/parameters/density"]),
], ids=lambda value: json.dumps(value)[:70])
def test_faults_are_named_with_their_place(server, huts, change, expected):
    text = json.dumps({"from": {"job": "JOB"}, **change})
    request = json.loads(text.replace("JOB", huts["id"]))
    assert_faults(post(server, request), request, expected)


def test_solvers_cannot_be_changed_on_the_way(server, huts):
    grid = make(server, job_request())
    request = {**from_job(grid), "solver": "continuous"}
    assert_faults(post(server, request), request, ["/solver"])
    request = {**from_job(huts), "solver": "discrete", "example": "castle"}
    assert_faults(post(server, request), request, ["/solver"])


def test_what_can_be_said_of_it_is_in_the_schema(server):
    schema = server.get("/v1/solvers/continuous").json()["from"]
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    for good in [{"job": "a"}, {"job": "a", "alternative": 1, "size": [1, 2.5, 3], "at": [0, 0, 1],
                               "box": BOX, "voxels": {"size": [1, 1, 1], "values": [1]}}]:
        assert validator.is_valid(good)
    for bad in [{}, {"job": "a", "cells": [[0, 0, 0]]}, {"job": "a", "at": [-1, 0, 0]},
                {"job": "a", "size": [0, 1, 1]}, {"job": ""}]:
        assert not validator.is_valid(bad)
    for _, request in enumerate(_REQUESTS):
        assert validator.is_valid(request["from"])

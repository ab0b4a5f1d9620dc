"""Constraints of solids through the API: asked for, echoed, refused with their places, and the same
model whatever happens on the way."""

import json
import pathlib
import re

import pytest

from checks import assert_faults, assert_problem, state_of, wait_until
from constraint_oracle import grey_png
from test_continuous import HUT, model_of, triangles_by_material

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "continuous.md"

SIZE = [12.0, 5.0, 12.0]
WEST = {"min": [0, 0, 0], "max": [6, 5, 12]}
IMAGE = grey_png([[255, 0], [255, 0]])  # white in the west

# Blocks of two kinds, in the open.
BLOCKS = {
    "kind": "continuous", "name": "blocks", "spacing": 1, "density": 0.9,
    "objects": [{"name": "red"}, {"name": "blue"}],
    "connected": [["red"]],
    "polyhedra": [
        {"object": name,
         "vertices": [[x, 0, 0], [x + 2, 0, 0], [x + 2, 2, 0], [x, 2, 0],
                      [x, 0, 3], [x + 2, 0, 3], [x + 2, 2, 3], [x, 2, 3]],
         "faces": HUT["polyhedra"][0]["faces"]} for name, x in (("red", 0), ("blue", 4))],
}


def request_of(constraints, example=HUT, **parameters):
    asked = {} if constraints is None else {"constraints": constraints}
    return {"solver": "continuous", "example": example, "seed": 4,
            "parameters": {"size": SIZE, "density": 0.6, **parameters, **asked}}


def make(server, request):
    answer = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def corners_of(server, job, name):
    triangles = triangles_by_material(model_of(server, job)).get(name, [])
    return [corner for triangle in triangles for corner in triangle]


def pieces_of(triangles):
    """How many of them hang together at their corners."""
    parent = {}

    def root(point):
        parent.setdefault(point, point)
        while parent[point] != point:
            parent[point] = parent[parent[point]]
            point = parent[point]
        return point
    for first, *others in triangles:
        for other in others:
            parent[root(other)] = root(first)
    return len({root(point) for point in parent})


CONSTRAINTS = {
    "dimension": ({"kind": "dimension", "object": "wall", "normal": [1, 0, 0], "spacings": 2}, {}),
    "dimension by default": ({"kind": "dimension", "object": "wall", "normal": [0, 0, 1]},
                             {"spacings": 1}),
    "connected": ({"kind": "connected", "objects": ["wall", "roof"], "components": 2}, {}),
    "connected by default": ({"kind": "connected", "objects": ["wall"]}, {"components": 1}),
    "fixed": ({"kind": "fixed", "objects": ["wall"],
               "box": {"min": [4, 0, 4], "max": [6, 1, 7]}}, {}),
    "fixed and empty": ({"kind": "fixed", "objects": ["empty"], "box": WEST}, {}),
    "forbidden": ({"kind": "forbidden", "objects": ["wall"], "mask": IMAGE}, {}),
    "probability": ({"kind": "probability", "objects": ["wall", "roof"], "weight": 0.25,
                     "voxels": {"size": [2, 1, 1], "values": [1, 0.5]}}, {}),
    "reflection": ({"kind": "symmetry", "reflect": "z"}, {"mirror": {}}),
    "turn": ({"kind": "symmetry", "rotate": 2, "mirror": {"wall": "wall"}}, {}),
    "translation": ({"kind": "symmetry", "translate": [5, 0, 0]}, {"mirror": {}}),
    "bounding volume": ({"kind": "bounding_volume", "object": "wall", "even": ["x", "z"],
                         "vertices": [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]],
                         "faces": [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]},
                        {"smooth": 40}),
}


@pytest.mark.parametrize("name", CONSTRAINTS)
def test_the_echo_tells_all_of_a_constraint_and_makes_the_same_model(server, name):
    constraint, defaults = CONSTRAINTS[name]
    job = make(server, request_of([constraint]))
    told = job["request"]["parameters"]["constraints"]
    assert told == [{**constraint, **defaults}]
    again = make(server, job["request"])
    assert again["result"]["sha256"] == job["result"]["sha256"]
    assert again["request"] == job["request"]
    without = make(server, request_of([]))
    assert without["result"]["sha256"] != job["result"]["sha256"]


def test_every_kind_is_in_the_schema_and_in_the_guide(server):
    schema = server.get("/v1/solvers/continuous").json()["parameters"]
    kinds = {one["properties"]["kind"]["const"]
             for one in schema["$defs"]["constraint"]["oneOf"]}
    assert kinds == {constraint["kind"] for constraint, _ in CONSTRAINTS.values()}
    shown = {one["kind"]
             for text in re.findall(r"```json\n(.*?)```", _GUIDE.read_text(), re.DOTALL)
             for one in json.loads(text)["parameters"].get("constraints", [])}
    assert shown == kinds


def test_what_is_fixed_stands_there(server):
    job = make(server, request_of([{"kind": "fixed", "objects": ["wall"],
                                    "box": {"min": [4, 0, 4], "max": [6, 1, 7]}},
                                   {"kind": "fixed", "objects": ["empty"],
                                    "box": {"min": [7, 0, 0], "max": [12, 5, 12]}}]))
    walls = corners_of(server, job, "wall")
    assert min(x for x, _, _ in walls) <= 4 and max(x for x, _, _ in walls) <= 7
    assert min(z for _, _, z in walls) <= 4 and max(z for _, _, z in walls) >= 7


@pytest.mark.parametrize("region", [
    {"box": WEST}, {"mask": IMAGE}, {"voxels": {"size": [2, 1, 1], "values": [1, 0]}},
], ids=lambda region: next(iter(region)))
@pytest.mark.parametrize("rule", [{"kind": "forbidden"}, {"kind": "probability", "weight": 0}],
                         ids=lambda rule: rule["kind"])
def test_what_may_not_be_in_the_west_is_in_the_east(server, rule, region):
    job = make(server, request_of([{**rule, "objects": ["wall", "roof"], **region}]))
    walls = corners_of(server, job, "wall")
    assert walls and min(x for x, _, _ in walls) >= 6
    free = corners_of(server, make(server, request_of([])), "wall")
    assert min(x for x, _, _ in free) < 6


@pytest.mark.parametrize("rule,moved", [
    ({"reflect": "x"}, lambda x, z: (12 - x, z)),
    ({"reflect": "z"}, lambda x, z: (x, 12 - z)),
    ({"rotate": 2}, lambda x, z: (12 - x, 12 - z)),
], ids=["x", "z", "half turn"])
def test_corners_have_their_image(server, rule, moved):
    walls = corners_of(server, make(server, request_of([{"kind": "symmetry", **rule}])), "wall")
    corners = {(round(x, 3), round(y, 3), round(z, 3)) for x, y, z in walls}
    assert len(corners) > 8
    for x, y, z in corners:
        there_x, there_z = moved(x, z)
        assert (round(there_x, 3), y, round(there_z, 3)) in corners


def test_what_the_example_says_hangs_together_does_unless_it_is_told_otherwise(server):
    def pieces(constraints):
        job = make(server, request_of(constraints, BLOCKS))
        return pieces_of(triangles_by_material(model_of(server, job))["red"])
    assert pieces(None) == 1
    assert pieces([{"kind": "forbidden", "objects": ["blue"], "box": WEST}]) == 1
    assert pieces([]) > 1
    assert pieces([{"kind": "connected", "objects": []}]) > 1
    assert 1 < pieces([{"kind": "connected", "objects": ["red"], "components": 3}]) <= 3
    uploaded = server.request("POST", "/v1/examples", BLOCKS).json()
    assert uploaded["connected"] == [["red"]]


@pytest.mark.parametrize("constraint,pointers", [
    ({"kind": "connected", "objects": ["wall", "door"]}, ["objects/1"]),
    ({"kind": "connected", "objects": ["empty"]}, ["objects/0"]),
    ({"kind": "connected", "objects": ["wall"], "components": 0}, ["components"]),
    ({"kind": "connected", "objects": ["wall"], "box": WEST}, ["box"]),
    ({"kind": "connected"}, ["objects"]),
    ({"kind": "fixed", "box": WEST}, ["objects"]),
    ({"kind": "fixed", "objects": []}, ["objects"]),
    ({"kind": "fixed", "objects": ["wall"], "weight": 1}, ["weight"]),
    ({"kind": "fixed", "objects": ["wall"], "box": {"min": [0, 0, 0], "max": [6, 0, 6]}}, ["box"]),
    ({"kind": "fixed", "objects": ["wall"], "box": {"min": [0, 0, 0]}}, ["box/max"]),
    ({"kind": "forbidden", "objects": ["wall"], "mask": "data:text/plain,white"}, ["mask"]),
    ({"kind": "forbidden", "objects": ["wall"], "mask": 1}, ["mask"]),
    ({"kind": "forbidden", "objects": ["wall"], "voxels": {"size": [2, 1, 1], "values": [1]}},
     ["voxels/values"]),
    ({"kind": "forbidden", "objects": ["wall"], "cells": [[0, 0, 0]]}, ["cells"]),
    ({"kind": "probability", "objects": ["wall"]}, ["weight"]),
    ({"kind": "probability", "objects": ["wall"], "weight": -1}, ["weight"]),
    ({"kind": "probability", "objects": ["empty"], "weight": 2}, ["objects/0"]),
    ({"kind": "dimension", "object": "wall", "normal": [1, 0, 0], "spacings": 0}, ["spacings"]),
    ({"kind": "dimension", "object": "empty", "normal": [1, 0, 0]}, ["object"]),
    ({"kind": "dimension", "objects": ["wall"], "normal": [1, 0, 0]}, ["object", "objects"]),
    ({"kind": "path", "objects": ["wall"]}, ["kind"]),
    ({"kind": "symmetry"}, [""]),
    ({"kind": "symmetry", "reflect": "x", "rotate": 2}, [""]),
    ({"kind": "symmetry", "reflect": "y"}, ["reflect"]),
    ({"kind": "symmetry", "rotate": 3}, ["rotate"]),
    ({"kind": "symmetry", "translate": [1, 0]}, ["translate"]),
    ({"kind": "symmetry", "translate": [0, 0, 0]}, ["translate"]),
    ({"kind": "symmetry", "translate": [0.5, 0, 0]}, ["translate"]),
    ({"kind": "symmetry", "reflect": "x", "objects": ["wall"]}, ["objects"]),
    ({"kind": "symmetry", "reflect": "x", "box": WEST}, ["box"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": ["wall"]}, ["mirror"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": "none"}, ["mirror"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"wall": 1}}, ["mirror/wall"]),
    ({"kind": "symmetry", "reflect": "x", "mirror": {"wall": "door"}}, ["mirror/wall"]),
    ({"objects": ["wall"]}, ["kind"]),
], ids=str)
def test_what_cannot_be_asked_for(server, constraint, pointers):
    request = request_of([{"kind": "connected", "objects": ["wall"]}, constraint])
    assert_faults(server.request("POST", "/v1/jobs", request), request,
                  [f"/parameters/constraints/1/{pointer}".rstrip("/") for pointer in pointers])


def test_faults_are_told_at_the_place_of_their_constraint(server):
    request = request_of([{"kind": "path"}, {"kind": "dimension", "normal": [1, 0, 0]},
                          {"kind": "fixed", "objects": ["door"]}])
    assert_faults(server.request("POST", "/v1/jobs", request), request,
                  [f"/parameters/constraints/{pointer}"
                   for pointer in ("0/kind", "1/object", "2/objects/0")])


@pytest.mark.parametrize("constraint,most", [
    ({"kind": "connected", "objects": ["wall"]}, 32),
    ({"kind": "forbidden", "objects": ["wall"], "mask": IMAGE}, 16),
    ({"kind": "symmetry", "reflect": "x"}, 8),
], ids=["connected", "masks", "symmetries"])
def test_more_than_the_limit_is_too_large(server, constraint, most):
    request = request_of([constraint] * (most + 1))
    answer = server.request("POST", "/v1/jobs", request)
    assert_problem(answer, 422, "too-large")
    assert_faults(answer, request, ["/parameters/constraints"])
    answer = server.request("POST", "/v1/jobs", request_of([constraint] * most))
    assert answer.status == 202, answer.body
    server.request("POST", f"/v1/jobs/{answer.json()['id']}/cancel")
    server.wait(answer.json()["id"])


def test_a_contradiction_tells_its_place_in_metres(server):
    request = request_of([{"kind": "fixed", "objects": ["wall"],
                           "box": {"min": [9, 0, 4], "max": [12, 2, 6]}}])
    job = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"}).json()
    assert job["state"] == "failed" and job["error"]["type"] == "/problems/contradiction"
    place = re.search(r"\[([^\]]*)\] \(metres\)", job["error"]["detail"])
    x, y, z = map(float, place[1].split(","))
    assert 8 <= x <= 12 and 0 <= y <= 3 and 3 <= z <= 7


NETWORK = {"solver": "continuous", "example": "roads", "seed": 3,
           "parameters": {"size": [90, 9, 90], "blocks": {"size": [10, 6, 10], "passes": 4}}}


def test_a_connected_job_goes_on_after_a_crash_whatever_the_workers(make_server):
    server = make_server(workers=1)
    job = server.request("POST", "/v1/jobs", NETWORK).json()
    wait_until(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["blocks_done"] > 10)
    server.kill()
    server.start()
    assert state_of(server, job) in ("queued", "running")
    wait_until(lambda: state_of(server, job) == "succeeded", timeout=60)
    again = server.get(f"/v1/jobs/{job['id']}").json()
    others = make_server(workers=8, name="others")
    whole = make(others, NETWORK)
    assert again["result"]["sha256"] == whole["result"]["sha256"]
    assert model_of(server, again) == model_of(others, whole)

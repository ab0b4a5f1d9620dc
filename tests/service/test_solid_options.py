"""What requests ask of models of solids besides constraints: free sides, variants, nudged faces,
jitter and perturbation, through the API."""

import collections
import math

import pytest

from checks import assert_faults
from test_continuous import model_of, triangles_by_material
from test_shapes import box

GABLE = {
    "kind": "continuous", "name": "gable", "spacing": 1, "density": 0.5, "ground": "grass",
    "objects": [{"name": "grass"}, {"name": "house"}],
    "polyhedra": [{
        "object": "house",
        "vertices": [[0, 0, 0], [4, 0, 0], [4, 2, 0], [2, 4, 0], [0, 2, 0],
                     [0, 0, 5], [4, 0, 5], [4, 2, 5], [2, 4, 5], [0, 2, 5]],
        "faces": [[0, 4, 3, 2, 1], [5, 6, 7, 8, 9], [0, 1, 6, 5], [1, 2, 7, 6], [2, 3, 8, 7],
                  [3, 4, 9, 8], [4, 0, 5, 9]]}],
}
PENTAGON = [[2 * math.cos(i * math.tau / 5), 2 * math.sin(i * math.tau / 5)] for i in range(5)]
TENT = {
    "kind": "continuous", "name": "tent", "spacing": 1, "ground": "grass",
    "objects": [{"name": "grass"}, {"name": "tent"}, {"name": "block", "weight": 0.1}],
    "polyhedra": [
        {"object": "tent",
         "vertices": [[x, 0, z] for x, z in PENTAGON] + [[0, 1.7, 0]],
         "faces": [[0, 1, 2, 3, 4]] + [[(i + 1) % 5, i, 5] for i in range(5)]},
        box("block", (5, 0, 0), (6, 1, 1))],
}


def asking(example, **parameters):
    return {"solver": "continuous", "example": example, "seed": 3,
            "parameters": {"size": [18, 6, 18], **parameters}}


def post(server, example, **parameters):
    request = asking(example, **parameters)
    return server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})


def make(server, example, **parameters):
    answer = post(server, example, **parameters)
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def remake(server, job, **parameters):
    """A part of the job's model, with other parameters if any are given."""
    request = {"from": {"job": job["id"], "box": {"min": [4, 0, 4], "max": [10, 6, 10]}},
               "seed": 5, "parameters": parameters}
    return server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})


def triangles_of(server, job):
    return triangles_by_material(model_of(server, job))


def normal_of(triangle):
    a, b, c = triangle
    u = [b[i] - a[i] for i in range(3)]
    v = [c[i] - a[i] for i in range(3)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in n))
    return [x / length for x in n]


def assert_closed(triangles):
    edges = collections.Counter((a, b) for one in triangles for a, b in zip(one, one[1:] + one[:1]))
    assert all(edges[a, b] == edges[b, a] for a, b in edges)


def test_defaults_are_told_in_the_echo(server):
    parameters = make(server, GABLE)["request"]["parameters"]
    sides = ["west", "east", "bottom", "top", "north", "south"]
    assert parameters["boundary"] == {side: "closed" for side in sides}
    assert parameters["variants"] == {"turns": 1, "mirrors": []}
    assert (parameters["nudge"], parameters["jitter"], parameters["perturbation"]) == (0, 0, 0)


def test_models_go_on_beyond_free_sides(server):
    def extent(job):
        corners = [corner for one in triangles_of(server, job)["house"] for corner in one]
        return [(min(c[axis] for c in corners), max(c[axis] for c in corners)) for axis in (0, 2)]
    closed = make(server, GABLE)
    assert all(low >= 1 and high <= 17 for low, high in extent(closed))
    free = make(server, GABLE, boundary={"west": "free", "south": "free"})
    (west, east), (north, south) = extent(free)
    assert west < 0.01 and south > 17.99
    assert east <= 17 and north >= 1
    for triangles in triangles_of(server, free).values():
        assert_closed(triangles)


def test_variants_stand_turned(server):
    def slopes(job):
        return {max((0, 2), key=lambda axis: abs(normal_of(one)[axis]))
                for one in triangles_of(server, job)["house"] if 0.1 < normal_of(one)[1] < 0.9}
    assert slopes(make(server, GABLE)) == {0}
    assert slopes(make(server, GABLE, variants={"turns": 4})) == {0, 2}


def test_names_mean_variants_too(server):
    wall = {**GABLE, "objects": [{"name": "grass"}, {"name": "wall"}],
            "polyhedra": [box("wall", (0, 0, 0), (6, 2, 1))],
            "dimensions": [{"object": "wall", "normal": [0, 0, 1]}]}
    job = make(server, wall, variants={"turns": 2, "mirrors": ["x"]},
               weights={"wall turned 180": 3, "wall mirrored": 2})
    assert job["request"]["parameters"]["variants"] == {"turns": 2, "mirrors": ["x"]}
    nothing = make(server, wall, variants={"turns": 4}, weights={"wall": 0})
    assert "wall" not in triangles_of(server, nothing)
    unknown = {"weights": {"wall turned 180": 3}}
    assert_faults(post(server, wall, **unknown), asking(wall, **unknown),
                  ["/parameters/weights/wall turned 180"])


def test_faces_are_nudged_and_the_angle_is_told(server):
    def peaks(job):
        meeting = collections.defaultdict(set)
        for one in triangles_of(server, job).get("tent", []):
            n = tuple(round(x, 3) for x in normal_of(one))
            for corner in one:
                if 0.1 < n[1] < 0.9:
                    meeting[corner].add(n)
        return sum(len(normals) == 5 for normals in meeting.values())
    plain = make(server, TENT)
    assert peaks(plain) == 0
    nudged = make(server, TENT, nudge=5)
    assert peaks(nudged) > 0
    turned = [text for text in nudged["result"]["stats"]["warnings"] if "degrees" in text]
    assert len(turned) == 1 and turned[0].startswith("faces are turned by up to")
    assert not any("no place" in text for text in nudged["result"]["stats"]["warnings"])


def test_rows_are_broken_by_jitter_and_by_perturbation(server):
    def columns(job):
        return {round(corner[0], 2) for one in triangles_of(server, job)["windows"]
                for corner in one}
    size = [30, 10, 30]
    neat = make(server, "skyscrapers", size=size)
    assert all(x == round(x) for x in columns(neat))
    jittered = make(server, "skyscrapers", size=size, jitter=0.4, constraints=[])
    perturbed = make(server, "skyscrapers", size=size, perturbation=0.25)
    for job in (jittered, perturbed):
        odd = [x for x in columns(job) if x != round(x)]
        assert len(odd) > 0.8 * len(columns(job))
        assert_closed(triangles_of(server, job)["windows"])
    assert len(columns(perturbed)) > len(columns(neat))
    again = make(server, "skyscrapers", size=size, perturbation=0.25)
    assert again["result"]["sha256"] == perturbed["result"]["sha256"]


@pytest.mark.parametrize("parameters, pointer", [
    ({"boundary": {"west": "open"}}, "/parameters/boundary/west"),
    ({"boundary": {"left": "free"}}, "/parameters/boundary/left"),
    ({"boundary": "free"}, "/parameters/boundary"),
    ({"variants": {"turns": 3}}, "/parameters/variants/turns"),
    ({"variants": {"turns": 8}}, "/parameters/variants/turns"),
    ({"variants": {"mirrors": ["y"]}}, "/parameters/variants/mirrors/0"),
    ({"variants": {"mirror": []}}, "/parameters/variants/mirror"),
    ({"nudge": 15.1}, "/parameters/nudge"),
    ({"nudge": -1}, "/parameters/nudge"),
    ({"jitter": 0.51}, "/parameters/jitter"),
    ({"perturbation": 0.31}, "/parameters/perturbation"),
    ({"jitter": 0.1, "constraints": [{"kind": "symmetry", "reflect": "x"}]}, "/parameters/jitter"),
    ({"perturbation": 0.1, "constraints": [{"kind": "symmetry", "reflect": "x"}]},
     "/parameters/perturbation"),
])
def test_what_is_wrong_is_told_where_it_is(server, parameters, pointer):
    assert_faults(post(server, GABLE, **parameters), asking(GABLE, **parameters), [pointer])


def test_too_many_variants_are_refused(server):
    many = {"kind": "continuous", "name": "many", "objects": [
        {"name": f"object {i}"} for i in range(100)],
        "polyhedra": [box("object 0", (0, 0, 0), (1, 1, 1))],
        "dimensions": [{"object": f"object {i}", "normal": [1, 0, 0]} for i in range(100)]}
    answer = post(server, many, variants={"turns": 4})
    assert answer.status == 422
    assert answer.json()["errors"][0]["pointer"] == "/parameters/variants"


def test_a_job_from_one_with_other_options_is_refused(server):
    first = make(server, GABLE, boundary={"west": "free"}, variants={"turns": 4})
    same = remake(server, first)
    assert same.status == 200 and same.json()["state"] == "succeeded", same.body
    assert same.json()["request"]["parameters"]["variants"]["turns"] == 4
    for parameters in ({"boundary": {}}, {"variants": {}}, {"nudge": 3},
                       {"size": [24, 6, 18]}):
        answer = remake(server, first, **parameters)
        assert answer.status in (400, 422), (parameters, answer.body)
        assert answer.json()["errors"], answer.body


def test_even_boxes_without_a_mesh_keep_their_ratio(server):
    slab = {"kind": "continuous", "name": "slabs", "spacing": 1, "density": 0.9, "ground": "floor",
            "objects": [{"name": "floor"}, {"name": "slab", "shape": {"even": ["x", "y"]}}],
            "polyhedra": [box("slab", (0, 0, 0), (4, 2, 3))]}
    parent = {}

    def root(point):
        parent.setdefault(point, point)
        while parent[point] != point:
            point = parent[point]
        return point
    for one in triangles_of(server, make(server, slab))["slab"]:
        for corner in one[1:]:
            parent[root(corner)] = root(one[0])
    pieces = collections.defaultdict(list)
    for point in list(parent):
        pieces[root(point)].append(point)
    assert pieces
    for points in pieces.values():
        wide, high = (max(p[a] for p in points) - min(p[a] for p in points) for a in (0, 1))
        assert wide == pytest.approx(2 * high)


def test_an_example_may_have_constraints_of_its_own(server):
    """They hold unless a request says otherwise, and are refused where the example cannot mean
    them."""
    keep = {"kind": "probability", "objects": ["house"], "weight": 0,
            "box": {"min": [0, 0, 0], "max": [9, 6, 18]}}
    example = {**GABLE, "constraints": [keep]}

    def west(job):
        return min(corner[0] for one in triangles_of(server, job)["house"] for corner in one)
    assert west(make(server, example)) >= 9
    assert west(make(server, example, constraints=[])) < 9
    uploaded = server.request("POST", "/v1/examples", example)
    assert uploaded.status == 201, uploaded.body
    stored = server.request("GET", f"/v1/examples/{uploaded.json()['id']}").json()
    assert stored["constraints"][0]["objects"] == ["house"]
    assert west(make(server, stored["id"])) >= 9
    for wrong, place in (({**keep, "objects": ["hut"]}, "/objects/0"),
                         ({"kind": "dimension", "object": "house", "normal": [1, 2, 3]}, "/normal")):
        request = {**GABLE, "constraints": [keep, wrong]}
        answer = server.request("POST", "/v1/examples", request)
        assert_faults(answer, request, [f"/constraints/1{place}"])


def test_letters_stand_where_their_masks_say(server):
    job = make(server, "letters", size=[152, 8, 56])
    parts = triangles_of(server, job)
    third = {"stone": (0, 52), "windows": (52, 100), "glass": (100, 152)}
    for material, (low, high) in third.items():
        xs = [corner[0] for one in parts[material] for corner in one]
        assert low < min(xs) and max(xs) < high

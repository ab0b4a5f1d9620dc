"""Shapes that stand in for boxes, through the API."""

import collections
import json

import pytest

from checks import assert_faults
from test_continuous import HUT, model_of, triangles_by_material

BOX_FACES = HUT["polyhedra"][0]["faces"]


def box(name, low, high):
    (x, y, z), (a, b, c) = low, high
    return {"object": name, "faces": BOX_FACES,
            "vertices": [[x, y, z], [a, y, z], [a, b, z], [x, b, z],
                         [x, y, c], [a, y, c], [a, b, c], [x, b, c]]}


# A bipyramid of four sides.
SHAPE = {"vertices": [[1, 0, 1], [2, 1, 1], [1, 1, 0], [0, 1, 1], [1, 1, 2], [1, 2, 1]],
         "faces": [[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4],
                   [5, 1, 2], [5, 2, 3], [5, 3, 4], [5, 4, 1]]}
GEMS = {
    "kind": "continuous", "name": "gems", "spacing": 1, "density": 0.9, "ground": "floor",
    "objects": [{"name": "floor"}, {"name": "gem", "shape": {**SHAPE, "even": ["x", "y", "z"]}}],
    "polyhedra": [box("gem", (0, 0, 0), (2, 2, 2))],
}


def post(server, example, size=(14, 5, 14), **more):
    request = {"solver": "continuous", "example": example, "seed": 2,
               "parameters": {"size": list(size)}, **more}
    return request, server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})


def make(server, example, **more):
    _, answer = post(server, example, **more)
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def gems_of(triangles):
    """The boxes of what hangs together."""
    parent = {}

    def root(point):
        parent.setdefault(point, point)
        while parent[point] != point:
            point = parent[point]
        return point
    for first, *others in triangles:
        for other in others:
            parent[root(other)] = root(first)
    pieces = collections.defaultdict(list)
    for point in list(parent):
        pieces[root(point)].append(point)
    return [tuple(max(axis) - min(axis) for axis in zip(*points)) for points in pieces.values()]


def test_models_have_the_shape_in_the_place_of_its_boxes(server):
    job = make(server, GEMS)
    triangles = triangles_by_material(model_of(server, job))["gem"]
    sizes = gems_of(triangles)
    assert sizes and len(triangles) == 8 * len(sizes)
    assert all(x == y == z for x, y, z in sizes)
    edges = collections.Counter((a, b) for one in triangles for a, b in zip(one, one[1:] + one[:1]))
    assert all(edges[a, b] == edges[b, a] for a, b in edges)


def test_boxes_grow_as_they_like_without_even(server):
    free = {**GEMS, "objects": [GEMS["objects"][0], {"name": "gem", "shape": SHAPE}]}
    sizes = gems_of(triangles_by_material(model_of(server, make(server, free)))["gem"])
    assert any(len(set(size)) > 1 for size in sizes)


def test_an_example_is_shown_and_sent_again_as_it_came(server):
    uploaded = server.request("POST", "/v1/examples", GEMS).json()
    told = server.get(f"/v1/examples/{uploaded['id']}").json()
    assert [one["name"] for one in told["objects"]] == ["floor", "gem"]
    assert told["objects"][1]["shape"] == {**SHAPE, "vertices": [
        [float(v) for v in vertex] for vertex in SHAPE["vertices"]],
        "smooth": 40.0, "even": ["x", "y", "z"]}
    assert len(told["polyhedra"]) == 1
    job = make(server, uploaded["id"])
    same = {key: told[key] for key in (
        "kind", "name", "spacing", "density", "ground", "objects", "polyhedra")}
    assert make(server, same)["result"]["sha256"] == job["result"]["sha256"]
    picture = server.get(f"/v1/examples/{uploaded['id']}/model.glb").body
    assert len(triangles_by_material(picture)["gem"]) == 8


def test_constraints_name_it_as_one_object(server):
    rule = {"kind": "forbidden", "objects": ["gem"], "box": {"min": [0, 0, 0], "max": [7, 5, 14]}}
    job = make(server, GEMS, parameters={"size": [14, 5, 14], "constraints": [rule]})
    triangles = triangles_by_material(model_of(server, job))["gem"]
    assert triangles and min(x for one in triangles for x, _, _ in one) >= 7


# A wedge that is high in the north-west: not like any image of it.
WEDGE = {"vertices": [[0, 0, 0], [2, 0, 0], [2, 0, 2], [0, 0, 2], [0, 1, 0]],
         "faces": [[0, 1, 2], [0, 2, 3], [0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]}
MOTIONS = {
    "x": ({"reflect": "x"}, lambda x, y, z: (14 - x, y, z)),
    "z": ({"reflect": "z"}, lambda x, y, z: (x, y, 14 - z)),
    "half turn": ({"rotate": 2}, lambda x, y, z: (14 - x, y, 14 - z)),
    "quarter turn": ({"rotate": 4}, lambda x, y, z: (z, y, 14 - x)),
}


def corners_of(triangles):
    return collections.Counter(
        frozenset(tuple(round(part, 3) for part in corner) for corner in one)
        for one in triangles)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("shape", [
    {**SHAPE, "even": ["x", "y", "z"]}, {**SHAPE, "even": ["x", "z"]}, WEDGE,
    {**WEDGE, "even": ["y", "z"]}], ids=["gem", "column", "wedge", "cut wedge"])
def test_shapes_are_turned_and_mirrored_as_models_are(server, shape, motion):
    rule, move = MOTIONS[motion]
    example = {**GEMS, "objects": [GEMS["objects"][0], {"name": "gem", "shape": shape}]}
    parameters = {"size": [14, 4, 14], "constraints": [{"kind": "symmetry", **rule}]}
    job = make(server, example, parameters=parameters)
    triangles = triangles_by_material(model_of(server, job))["gem"]
    found = corners_of(triangles)
    assert found and found == corners_of([[move(*corner) for corner in one] for one in triangles])
    # All of them are shapes: none is left as its box.
    assert len(triangles) % sum(len(face) - 2 for face in shape["faces"]) == 0
    echo = job["request"]["parameters"]
    again = make(server, example, parameters=echo)
    assert again["request"]["parameters"] == echo
    assert again["result"]["sha256"] == job["result"]["sha256"]


def test_shapes_follow_a_symmetry_of_the_example(server):
    rule = {"kind": "symmetry", "reflect": "x"}
    size = {"parameters": {"size": [14, 4, 14]}}
    of_example = make(server, {**GEMS, "constraints": [rule]}, **size)
    of_request = make(server, GEMS, parameters={"size": [14, 4, 14], "constraints": [rule]})
    assert of_example["result"]["sha256"] == of_request["result"]["sha256"]


def test_the_image_of_a_shape_is_no_other_object(server):
    rule = {"kind": "symmetry", "reflect": "x", "mirror": {"gem": "post"}}
    example = {**GEMS, "objects": [*GEMS["objects"], {"name": "post"}],
               "polyhedra": [*GEMS["polyhedra"], box("post", (5, 0, 0), (6, 2, 1))]}
    request, answer = post(server, example, parameters={"constraints": [rule]})
    assert_faults(answer, request, ["/parameters/constraints/0/mirror"])


@pytest.mark.parametrize("change, expected", [
    ({}, ["/vertices", "/faces"]),
    ({**SHAPE, "even": ["x"]}, ["/even"]),
    ({**SHAPE, "even": ["x", "x"]}, ["/even"]),
    ({**SHAPE, "even": ["x", "w"]}, ["/even/1"]),
    ({**SHAPE, "smooth": 181}, ["/smooth"]),
    ({**SHAPE, "more": 1}, ["/more"]),
    ({**SHAPE, "vertices": SHAPE["vertices"][:3]}, None),
    ({**SHAPE, "faces": SHAPE["faces"][:7]}, None),
    ({**SHAPE, "faces": [[0, 1, 9]] + SHAPE["faces"][1:]}, ["/faces/0/2"]),
    ({**SHAPE, "vertices": [[x, 1, z] for x, _, z in SHAPE["vertices"]]}, None),
], ids=lambda value: json.dumps(value)[:60])
def test_faults_are_named_with_their_place(server, change, expected):
    """All of them; None: whatever is wrong, it is in the shape."""
    example = {**GEMS, "objects": [GEMS["objects"][0], {"name": "gem", "shape": change}]}
    request, answer = post(server, example)
    if expected is None:
        assert answer.status == 422, answer.body
        assert all(error["pointer"].startswith("/example/objects/1/shape")
                   for error in answer.json()["errors"])
        return
    assert_faults(answer, request, [f"/example/objects/1/shape{one}" for one in expected])


@pytest.mark.parametrize("polyhedra, expected", [
    ([box("gem", (0, 0, 0), (2, 2, 2)), box("gem", (2, 0, 0), (4, 2, 2))], ["/example/polyhedra/1"]),
    ([box("gem", (0, 0, 0), (2, 2, 2)), {**HUT["polyhedra"][1], "object": "gem"}],
     ["/example/polyhedra/1"]),
], ids=["touching", "no box"])
def test_its_solids_are_boxes_apart(server, polyhedra, expected):
    request, answer = post(server, {**GEMS, "polyhedra": polyhedra})
    assert_faults(answer, request, expected)

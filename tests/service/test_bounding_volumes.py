"""A request that puts meshes in the place of an example's boxes: the models of an example that has
these shapes itself, whatever else is asked for."""

import copy
import math

import pytest

from checks import assert_faults, assert_problem
from glb_file import GlbFile
from test_shapes import box
from test_solid_options import asking, make, post, remake, triangles_of

POSTS = {
    "kind": "continuous", "name": "posts", "spacing": 1, "density": 0.8, "ground": "floor",
    "objects": [{"name": "floor"}, {"name": "post"}],
    "polyhedra": [box("post", (0, 0, 0), (2, 3, 2))],
}

SPIRE = {
    "vertices": [[0, 0, 0], [2, 0, 0], [2, 4, 0], [0, 4, 0],
                 [0, 0, 2], [2, 0, 2], [2, 4, 2], [0, 4, 2], [1, 5, 1]],
    "faces": [[0, 1, 5, 4], [0, 3, 2, 1], [4, 5, 6, 7], [1, 2, 6, 5], [3, 0, 4, 7],
              [3, 8, 2], [2, 8, 6], [6, 8, 7], [7, 8, 3]],
}


def volume(**fields):
    return {"kind": "bounding_volume", "object": "post", **fields}


def with_shape(**shape):
    example = copy.deepcopy(POSTS)
    example["objects"][1]["shape"] = shape
    return example


def bytes_of(server, job):
    return server.get(f"/v1/jobs/{job['id']}/model.glb").body


def has_slopes(server, job):
    """Whether some post is no box."""
    return any(all(len({corner[axis] for corner in one}) > 1 for axis in range(3))
               for one in triangles_of(server, job)["post"])


@pytest.mark.parametrize("shape", [
    SPIRE, {**SPIRE, "smooth": 70}, {**SPIRE, "even": ["x", "z"]},
    {**SPIRE, "even": ["x", "y", "z"]}, {"even": ["x", "y"]},
], ids=["free", "smooth", "two axes", "three axes", "the box itself"])
@pytest.mark.parametrize("parameters", [
    {}, {"variants": {"turns": 4, "mirrors": ["x"]}}, {"nudge": 2}, {"symmetry": {"reflect": "x"}},
], ids=["plain", "variants", "nudged", "symmetric"])
def test_models_are_those_of_an_example_with_the_shape(server, shape, parameters):
    others = [{"kind": "symmetry", **parameters["symmetry"]}] if "symmetry" in parameters else []
    rest = {name: value for name, value in parameters.items() if name != "symmetry"}
    asked = make(server, POSTS, constraints=[volume(**shape), *others], **rest)
    own = make(server, with_shape(**shape), **({"constraints": others} if others else {}), **rest)
    assert bytes_of(server, asked) == bytes_of(server, own)
    plain = make(server, POSTS, constraints=others, **rest)
    assert bytes_of(server, asked) != bytes_of(server, plain) or "vertices" not in shape


def test_a_shape_of_the_example_makes_room_for_it_and_stays_where_nothing_is_asked(server):
    example = with_shape(even=["x", "y", "z"])
    own = make(server, example)
    asked = make(server, example, constraints=[volume(**SPIRE)])
    assert has_slopes(server, asked) and not has_slopes(server, own)
    assert bytes_of(server, make(server, example, constraints=[])) == bytes_of(server, own)


def test_an_example_may_ask_for_it_itself(server):
    example = {**POSTS, "constraints": [volume(**SPIRE)]}
    own = bytes_of(server, make(server, with_shape(**SPIRE)))
    assert bytes_of(server, make(server, example)) == own
    uploaded = server.request("POST", "/v1/examples", example)
    assert uploaded.status == 201, uploaded.body
    assert bytes_of(server, make(server, uploaded.json()["id"])) == own
    wrong = {**POSTS, "constraints": [volume(**SPIRE, even=["x"])]}
    assert_faults(server.request("POST", "/v1/examples", wrong), wrong, ["/constraints/0/even"])


def test_a_part_is_made_anew_with_the_same_volumes_only(server):
    first = make(server, POSTS, constraints=[volume(**SPIRE, even=["x", "z"])])
    same = remake(server, first)
    assert same.status == 200 and same.json()["state"] == "succeeded", same.body
    assert same.json()["result"]["sha256"] != first["result"]["sha256"]
    assert has_slopes(server, first) and has_slopes(server, same.json())
    for constraints in ([], [volume(**SPIRE)]):
        answer = remake(server, first, constraints=constraints)
        assert answer.status == 422, answer.body
        assert "bounding volumes" in answer.json()["errors"][0]["detail"]


HOUSE = {
    **POSTS,
    "objects": [*POSTS["objects"], {"name": "house"}, {"name": "twin"}, {"name": "cube", "shape": {
        "even": ["x", "y", "z"]}}],
    "polyhedra": [
        *POSTS["polyhedra"],
        {"object": "house",
         "vertices": [[9, 0, 0], [11, 0, 0], [10, 2, 0], [9, 0, 3], [11, 0, 3], [10, 2, 3]],
         "faces": [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]},
        box("twin", (13, 0, 0), (14, 1, 1)), box("twin", (14, 0, 1), (15, 1, 2)),
        box("cube", (17, 0, 0), (18, 1, 1))],
}


@pytest.mark.parametrize("constraint,places", [
    ({"kind": "bounding_volume", **SPIRE}, ["object"]),
    (volume(), ["faces", "vertices"]),
    (volume(vertices=SPIRE["vertices"]), ["faces"]),
    (volume(**SPIRE, box={"min": [0, 0, 0], "max": [1, 1, 1]}), ["box"]),
    (volume(**SPIRE, smooth=181), ["smooth"]),
    (volume(**SPIRE, even=["x"]), ["even"]),
    (volume(**SPIRE, even=["x", "w"]), ["even/1"]),
    (volume(vertices=SPIRE["vertices"], faces=SPIRE["faces"][:-1]), ["faces/4", "faces/5", "faces/7"]),
    ({**volume(**SPIRE), "object": "nothing"}, ["object"]),
    ({**volume(**SPIRE), "object": "empty"}, ["object"]),
    ({**volume(**SPIRE), "object": "cube (rest)"}, ["object"]),
    ({**volume(**SPIRE), "object": "house"}, ["object"]),
    ({**volume(**SPIRE), "object": "twin"}, ["object"]),
    ({**volume(**SPIRE), "object": "floor"}, [""]),
    ({**volume(**SPIRE), "object": 3}, ["object"]),
    ({**volume(**SPIRE), "objects": ["post"]}, ["objects"]),
], ids=str)
def test_what_cannot_be_asked_for(server, constraint, places):
    request = asking(HOUSE, constraints=[{"kind": "connected", "objects": ["twin"]}, constraint])
    answer = server.request("POST", "/v1/jobs", request)
    assert_faults(answer, request,
                  [f"/parameters/constraints/1/{place}".rstrip("/") for place in places])


def test_without_smooth_every_face_looks_its_own_way(server):
    job = make(server, POSTS, constraints=[volume(**SPIRE, smooth=0)])
    glb = GlbFile(bytes_of(server, job))
    normals = [normal for mesh in glb.meshes() for primitive in mesh["primitives"]
               for normal in glb.accessor(primitive["attributes"]["NORMAL"])]
    assert normals and all(math.hypot(*normal) == pytest.approx(1, abs=1e-5) for normal in normals)


def test_an_object_has_one(server):
    request = asking(POSTS, constraints=[volume(**SPIRE), volume(even=["x", "z"])])
    assert_faults(server.request("POST", "/v1/jobs", request), request,
                  ["/parameters/constraints/1/object"])


def test_what_is_cut_off_boxes_counts_as_objects(server):
    count = 130
    many = {**POSTS,
            "objects": [{"name": "floor"}, *({"name": f"post {i}"} for i in range(count))],
            "polyhedra": [box(f"post {i}", (3 * i, 0, 0), (3 * i + 1, 1, 1))
                          for i in range(count)]}
    request = asking(many, constraints=[
        {"kind": "bounding_volume", "object": f"post {i}", "even": ["x", "z"]}
        for i in range(count)])
    answer = server.request("POST", "/v1/jobs", request)
    assert_problem(answer, 422, "too-large")
    assert_faults(answer, request, ["/parameters/constraints"])


def test_what_the_faults_above_are_about_is_an_example_without_them(server):
    answer = post(server, HOUSE, constraints=[])
    assert answer.status == 200 and answer.json()["state"] == "succeeded", answer.body

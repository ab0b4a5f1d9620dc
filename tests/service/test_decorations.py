"""Mouldings along edges and meshes at corners, through the API."""

import collections
import json
import math

import pytest

from checks import assert_faults
from test_continuous import model_of, triangles_by_material
from test_shapes import SHAPE, box, make, post

COPING = {"edges": ["up", "side"],
          "profile": [[-0.25, -0.125], [0.125, -0.125], [0.125, 0.25], [-0.25, 0.25]],
          "material": "stone"}
BALL = {"corners": ["up", "side", "side"], "turn": "any", "turned": True, "material": "gold",
        "mesh": {"vertices": SHAPE["vertices"], "faces": SHAPE["faces"]}}


def courts(*decorations):
    return {
        "kind": "continuous", "name": "courts", "spacing": 1, "density": 0.6, "ground": "grass",
        "objects": [{"name": "grass"}, {"name": "wall", "decorations": list(decorations)},
                    {"name": "stone"}, {"name": "gold"}],
        "polyhedra": [box("wall", (0, 0, 0), (4, 2, 3))],
    }


def volume(triangles):
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in triangles) / 6


def assert_closed(triangles):
    edges = collections.Counter((a, b) for one in triangles for a, b in zip(one, one[1:] + one[:1]))
    assert all(edges[a, b] == edges[b, a] for a, b in edges)


def roofs_of(walls):
    """Of what looks up: the length of its border, how many corners that has, and outlines."""
    edges = collections.Counter()
    for one in walls:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = one
        if ay == by == cy and (bz - az) * (cx - ax) - (bx - ax) * (cz - az) > 0:
            edges.update(zip(one, one[1:] + one[:1]))
    after = {a: b for a, b in edges if (b, a) not in edges}
    length = turns = 0
    for a, b in after.items():
        c = after[b]
        length += abs(a[0] - b[0]) + abs(a[2] - b[2])
        turns += 1 if (b[2] - a[2]) * (c[0] - b[0]) - (b[0] - a[0]) * (c[2] - b[2]) > 0 else -1
    return length, len(after), turns // 4


def test_models_have_them_at_all_edges_and_corners(server):
    job = make(server, courts(COPING, BALL))
    assert "warnings" not in job["result"]["stats"]
    parts = triangles_by_material(model_of(server, job))
    plain = make(server, courts())
    bare = triangles_by_material(model_of(server, plain))
    assert set(bare) == {"grass", "wall"} and set(parts) == {"grass", "wall", "stone", "gold"}
    assert parts["wall"] == bare["wall"] and parts["grass"] == bare["grass"]
    length, corners, outlines = roofs_of(parts["wall"])
    assert corners >= 4
    assert len(parts["gold"]) == 8 * corners
    # No cap is left, and a side of the profile is two triangles.
    assert len(parts["stone"]) == 8 * corners
    assert_closed(parts["stone"])
    assert volume(parts["gold"]) == pytest.approx(corners * 4 / 3, rel=1e-4)
    # 4 corners more of an outline go outwards than inwards.
    assert volume(parts["stone"]) == pytest.approx(
        0.375 * (0.375 * length + 4 * outlines * (0.0625 - 0.015625)), rel=1e-4)


def test_an_example_is_shown_and_sent_again_as_it_came(server):
    normal = {**COPING, "edges": ["up", [0, 0, 1]], "turn": "convex"}
    example = courts(normal, BALL)
    uploaded = server.request("POST", "/v1/examples", example).json()
    told = server.get(f"/v1/examples/{uploaded['id']}").json()
    edges, corners = told["objects"][1]["decorations"]
    assert edges == normal
    assert corners == {**BALL, "mesh": {**BALL["mesh"], "smooth": 40.0}}
    assert "decorations" not in told["objects"][0]
    job = make(server, uploaded["id"])
    same = {key: told[key] for key in example}
    assert make(server, same)["result"]["sha256"] == job["result"]["sha256"]


@pytest.mark.parametrize("name", ["buildings", "domes", "houses", "skyscrapers"])
def test_those_of_built_in_examples_can_be_sent(server, name):
    told = server.get(f"/v1/examples/{name}").json()
    assert any("decorations" in one for one in told["objects"])
    same = {key: value for key, value in told.items() if key in (
        "kind", "name", "spacing", "size", "density", "ground", "objects", "polyhedra",
        "dimensions", "connected")}

    def triangles(example):  # sent objects have a material each, those of built-in ones share them
        parts = triangles_by_material(model_of(server, make(server, example, size=(20, 8, 20))))
        return sorted(one for part in parts.values() for one in part)

    assert triangles(same) == triangles(name)


def test_too_many_are_left_out_with_a_warning(server):
    # A column of 30 drums with 32 sides.
    ring = [(math.cos(i * math.pi / 16), math.sin(-i * math.pi / 16)) for i in range(32)]
    mesh = {"vertices": [[x, y, z] for y in range(31) for x, z in ring],
            "faces": [[32 * y + i, 32 * y + (i + 1) % 32, 32 * y + 32 + (i + 1) % 32,
                       32 * y + 32 + i] for y in range(30) for i in range(32)] +
                     [list(range(31, -1, -1)), list(range(960, 992))]}
    job = make(server, courts(*[{**BALL, "mesh": mesh}] * 16), size=(30, 5, 30))
    _, corners, _ = roofs_of(triangles_by_material(model_of(server, job))["wall"])
    assert 16 * 1980 * corners > 1_000_000
    assert "gold" not in triangles_by_material(model_of(server, job))
    assert [text for text in job["result"]["stats"]["warnings"] if "decorations" in text]


@pytest.mark.parametrize("change, expected", [
    ([{}], ["/0"]),
    ([{**COPING, **BALL}], ["/0"]),
    ([COPING] * 17, [""]),
    (COPING, [""]),
    ([{"edges": ["up", "side"]}], ["/0/profile"]),
    ([{"corners": ["up", "side", "side"]}], ["/0/mesh"]),
    ([{**COPING, "edges": ["up"]}], ["/0/edges"]),
    ([{**COPING, "edges": ["up", "wall"]}], ["/0/edges/1"]),
    ([{**COPING, "edges": ["up", [0, 0, 0]]}], ["/0/edges/1"]),
    ([COPING, {**COPING, "turn": "any"}], ["/1/turn"]),
    ([{**COPING, "profile": [[0, 0], [1, 1]]}], ["/0/profile"]),
    ([{**COPING, "profile": [[0, 0], [1, 1], [1, 0], [0, 1]]}], ["/0/profile"]),
    ([{**COPING, "profile": [[0, 0], [1, 1], [2, 2]]}], ["/0/profile"]),
    ([{**COPING, "profile": [[0, 0], [1001, 0], [0, 1]]}], ["/0/profile/1/0"]),
    ([{**COPING, "profile": [[0, 0], [1, 0, 0], [0, 1]]}], ["/0/profile/1"]),
    ([{**COPING, "profile": [[i, i * i] for i in range(65)]}], ["/0/profile"]),
    ([{**COPING, "material": "wood"}], ["/0/material"]),
    ([{**COPING, "material": 1}], ["/0/material"]),
    ([{**COPING, "mesh": BALL["mesh"]}], ["/0/mesh"]),
    ([{**BALL, "corners": ["up", "side"]}], ["/0/corners"]),
    ([{**BALL, "corners": ["up", "side", "sideways"]}], ["/0/corners/2"]),
    ([{**BALL, "turned": 1}], ["/0/turned"]),
    ([{**BALL, "mesh": {**BALL["mesh"], "faces": SHAPE["faces"][:7]}}], None),
    ([{**BALL, "mesh": {**BALL["mesh"], "faces": [[0, 1, 9]] + SHAPE["faces"][1:]}}],
     ["/0/mesh/faces/0/2"]),
    ([{**BALL, "mesh": {**BALL["mesh"], "even": ["x", "z"]}}], ["/0/mesh/even"]),
    ([{**BALL, "mesh": {**BALL["mesh"], "vertices": [[x, 1, z] for x, _, z in SHAPE["vertices"]]}}],
     None),
], ids=lambda value: json.dumps(value)[:60])
def test_faults_are_named_with_their_place(server, change, expected):
    """All of them; None: whatever is wrong, it is in the mesh."""
    example = courts()
    example["objects"][1]["decorations"] = change
    request, answer = post(server, example)
    prefix = "/example/objects/1/decorations"
    if expected is None:
        assert answer.status == 422, answer.body
        assert all(error["pointer"].startswith(prefix + "/0/mesh")
                   for error in answer.json()["errors"])
        return
    assert_faults(answer, request, [prefix + one for one in expected])

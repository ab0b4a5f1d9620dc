"""Planes of continuous models by family: spacings, lists of offsets, and what cannot be had."""

import math

import pytest

from checks import assert_problem
from event_reader import EventReader
from test_continuous import HUT, make, model_of, triangles_by_material

SIZE = [9.0, 4.0, 9.0]
PLANES = {"size": SIZE,
          "spacing": [{"normal": [0, 0, -2], "spacing": 1.5}, {"spacing": 1}],
          "offsets": [{"normal": [1, 0, 0], "offsets": [7.25, 2, 5, 0.5]}]}


def pentagon(**fields):
    """A pyramid of five sides on grass, and the normals of its sides."""
    corners = [(math.cos(2 * math.pi * i / 5), math.sin(2 * math.pi * i / 5)) for i in range(5)]
    middle = math.cos(math.pi / 5)  # the distance of a side from the middle
    normals = [[math.cos(2 * math.pi * (i + 0.5) / 5), middle,
                -math.sin(2 * math.pi * (i + 0.5) / 5)] for i in range(5)]
    example = {
        "kind": "continuous", "name": "pentagon", "spacing": 1, "ground": "grass",
        "objects": [{"name": "grass"}, {"name": "stone"}],
        "polyhedra": [
            {"object": "stone",
             "vertices": [[x, 0, -z] for x, z in corners] + [[0, 1, 0]],
             "faces": [[i, (i + 1) % 5, 5] for i in range(5)] + [[4, 3, 2, 1, 0]]}],
        **fields}
    return example, normals


def across_x(triangles):
    """Where triangles stand that face along x."""
    return {round(a[0], 5) for a, b, c in triangles if a[0] == b[0] == c[0]}


def test_planes_lie_where_they_are_asked_for(server):
    walls_alone = {**HUT, "polyhedra": HUT["polyhedra"][:1]}
    walls = []
    for seed in range(1, 6):
        job = make(server, example=walls_alone, seed=seed, parameters={**PLANES, "density": 1})
        walls += triangles_by_material(model_of(server, job))["wall"]
    assert across_x(walls) == {0.5, 2.0, 5.0, 7.25}
    along_z = {corner[2] for triangle in walls for corner in triangle}
    assert along_z and all(z % 1.5 == 0 for z in along_z)


def test_the_echo_asks_for_the_same_planes(server):
    job = make(server, parameters=PLANES)
    echo = job["request"]["parameters"]
    assert echo["spacing"] == PLANES["spacing"] and echo["offsets"] == PLANES["offsets"]
    again = make(server, **job["request"])
    assert again["request"] == job["request"]
    assert again["result"]["sha256"] == job["result"]["sha256"]
    plain = make(server, parameters={"size": SIZE})
    assert plain["result"]["sha256"] != job["result"]["sha256"]
    assert plain["request"]["parameters"]["spacing"] == 1
    assert plain["request"]["parameters"]["offsets"] == []


def test_the_default_of_a_list_is_the_examples(server):
    job = make(server, example={**HUT, "spacing": 0.5},
               parameters={"size": SIZE, "spacing": [{"normal": [1, 0, 0], "spacing": 1}]})
    assert job["request"]["parameters"]["spacing"] == [
        {"normal": [1, 0, 0], "spacing": 1}, {"spacing": 0.5}]


@pytest.mark.parametrize("parameters,pointers", [
    ({"spacing": "1"}, ["/spacing"]),
    ({"spacing": []}, ["/spacing"]),
    ({"spacing": [{}]}, ["/spacing/0/spacing"]),
    ({"spacing": [{"spacing": 0}]}, ["/spacing/0/spacing"]),
    ({"spacing": [{"normal": [1, 0, 0], "spacing": 2, "offset": 1}]}, ["/spacing/0/offset"]),
    ({"spacing": [{"spacing": 2}, {"normal": [1, 0, 0], "spacing": 1}]}, ["/spacing/0"]),
    ({"spacing": [{"normal": [0, 0, 0], "spacing": 2}]}, ["/spacing/0/normal"]),
    ({"spacing": [{"normal": [1, 0, 0], "spacing": 2}, {"normal": [1, 2, 0], "spacing": 2}]},
     ["/spacing/1/normal"]),
    ({"spacing": [{"normal": [1, 0, 0], "spacing": 2}, {"normal": [-1, 0, 0], "spacing": 2}]},
     ["/spacing/1/normal"]),
    # A fault does not move the places of others.
    ({"spacing": [{"normal": 1, "spacing": 2}, {"normal": [1, 2, 0], "spacing": -2}]},
     ["/spacing/0/normal", "/spacing/1/normal", "/spacing/1/spacing"]),
    ({"offsets": {}}, ["/offsets"]),
    ({"offsets": [{"normal": [1, 0, 0]}]}, ["/offsets/0/offsets"]),
    ({"offsets": [{"normal": [1, 0, 0], "offsets": []}]}, ["/offsets/0/offsets"]),
    ({"offsets": [{"normal": [1, 0, 0], "offsets": [1] * 4097}]}, ["/offsets/0/offsets"]),
    ({"offsets": [{"normal": [1, 0, 0], "offsets": [1, 3e5]}]}, ["/offsets/0/offsets/1"]),
    ({"offsets": [{"normal": [1, 0, 1], "offsets": [1]}]}, ["/offsets/0/normal"]),
    ({"spacing": [{"normal": [1, 0, 0], "spacing": 2}],
      "offsets": [{"normal": [1, 0, 0], "offsets": [1]}]}, ["/offsets/0/normal"]),
])
def test_what_cannot_be_asked_of_planes(server, parameters, pointers):
    request = {"solver": "continuous", "example": HUT, "parameters": parameters}
    problem = assert_problem(server.request("POST", "/v1/jobs", request), 422, "invalid-request")
    # That of a missing field is where it should be.
    assert {error["pointer"] for error in problem["errors"]} == {
        "/parameters" + pointer for pointer in pointers}


@pytest.mark.parametrize("spacing", [1e-300, 1e-9, 1e-4])
def test_too_many_planes_of_one_direction_are_refused(server, spacing):
    request = {"solver": "continuous", "example": HUT, "parameters": {
        "spacing": [{"normal": [1, 0, 0], "spacing": spacing}]}}
    assert_problem(server.request("POST", "/v1/jobs", request), 422, "too-large")


def test_figures_without_a_place_are_named(make_server):
    server = make_server()
    example, normals = pentagon()
    job = make(server, example=example, parameters={"size": SIZE})
    warnings = job["result"]["stats"]["warnings"]
    assert 1 < len(warnings) <= 20
    assert any("1 of 26 figures has no place" in text and "h2, h3, h4, h5 and h6" in text
               for text in warnings), warnings
    with EventReader(server.port, job["id"]) as reader:
        started, = [event for event in reader.rest() if event["type"] == "started"]
    # What came of it is known at the end alone.
    assert [*started["warnings"], "nothing fits but what the model began as"] == warnings
    # They are kept with the result.
    server.kill()
    server.start()
    kept = server.get(f"/v1/jobs/{job['id']}").json()
    assert kept["result"]["stats"]["warnings"] == warnings


def test_what_cannot_be_had_is_told_before_anything_is_made(make_server):
    """And again by a job that a restart begins anew."""
    server = make_server()
    example, normals = pentagon()
    request = {"solver": "continuous", "example": example, "seed": 1,
               "parameters": {"size": [30, 4, 30], "blocks": {
                   "size": [8, 4, 8], "overlap": 0.75, "passes": 100}}}
    job = server.request("POST", "/v1/jobs", request).json()
    with EventReader(server.port, job["id"]) as reader:
        first = reader.until_event(lambda event: event["type"] == "started")[-1]
        assert any("1 of 26 figures has no place" in text for text in first["warnings"])
        server.kill()
        seen = len(reader.rest_before_crash()) + 2
    server.start()
    with EventReader(server.port, job["id"], f"?after={seen}") as reader:
        again = reader.until_event(lambda event: event["type"] == "started")[-1]
    assert again["resumed"] is True and again["warnings"] == first["warnings"]
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")


def test_nothing_is_said_where_all_have_a_place(server):
    plain = make(server)
    assert "warnings" not in plain["result"]["stats"]
    with EventReader(server.port, plain["id"]) as reader:
        assert not any("warnings" in event for event in reader.rest())
    example, normals = pentagon()
    apex = [4.1, 1.3, 3.9]
    offsets = [{"normal": n, "offsets": [sum(a * b for a, b in zip(n, apex)) / math.hypot(*n)]}
               for n in normals]
    job = make(server, example=example, parameters={"size": SIZE, "offsets": offsets})
    # An apex alone has no base.
    assert job["result"]["stats"]["warnings"] == ["nothing fits but what the model began as"]

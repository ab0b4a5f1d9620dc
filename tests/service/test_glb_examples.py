"""Examples of solids that come as GLBs say all that JSON ones can, in the extras of nodes, materials
and the scene."""

import json

import pytest

from checks import assert_problem
from glb_example import Writer, as_glb, in_file_order
from test_continuous import model_of, triangles_by_material
from test_shapes import BOX_FACES, SHAPE

GLB = {"Content-Type": "model/gltf-binary"}
EXAMPLE_FIELDS = ("kind", "name", "title", "description", "objects", "ground", "polyhedra",
                  "dimensions", "connected", "constraints", "spacing", "size", "density", "bounds")
CUBE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]


def upload(server, glb):
    return server.request("POST", "/v1/examples", glb, headers=GLB)


def make(server, example, **parameters):
    answer = server.request("POST", "/v1/jobs", {
        "solver": "continuous", "example": example, "seed": 4, "parameters": parameters},
        headers={"Prefer": "wait=60"})
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def cube(size=1, at=(0, 0, 0)):
    return [[a + size * b for a, b in zip(at, corner)] for corner in CUBE]


@pytest.mark.parametrize("typed", [False, True], ids=["as lists", "as texts"])
@pytest.mark.parametrize("name, size", [("domes", [24, 11, 24]), ("houses", [20, 9, 20])])
def test_a_built_in_example_as_a_glb_gives_the_same_models(server, name, size, typed):
    built_in = server.get(f"/v1/examples/{name}").json()
    example = in_file_order({key: built_in[key] for key in EXAMPLE_FIELDS if key in built_in})
    answer = upload(server, as_glb(example, typed))
    assert answer.status == 201, answer.body
    read = answer.json()
    for field in ("name", "title", "description", "ground", "dimensions", "connected", "spacing",
                  "size", "density", "constraints"):
        assert read[field] == example[field], field
    of_glb = make(server, read["id"], size=size)
    of_json = make(server, example, size=size)
    assert of_glb["result"]["sha256"] == of_json["result"]["sha256"]
    assert of_glb["result"]["stats"]["polygons"] > 100


def scene_with(nodes=(), materials=(), **extras):
    """A wall of a shape of its own, and more."""
    writer = Writer()
    writer.json["scenes"][0]["extras"] = extras
    for material in (*materials, {"name": "wall"}, {"name": "trim", "color": [1, 0, 0]}):
        writer.material({"name": material["name"], "color": material.get("color", [1, 1, 1])},
                        **material.get("extras", {}))
    for node in nodes:
        writer.node(**node)
    return writer.bytes()


WALL = {"name": "house", "material": 0, "vertices": cube(2), "faces": BOX_FACES}
GEM = {"name": "gem", "material": 1, "vertices": SHAPE["vertices"], "faces": SHAPE["faces"],
       "shape": "wall"}
COPING = {"name": "coping", "material": 1, "faces": [[0, 1, 2, 3]], "decorates": "wall",
          "vertices": [[-0.1, -0.1, 3], [0.1, -0.1, 3], [0.1, 0.1, 3], [-0.1, 0.1, 3]]}


def test_what_is_put_on_nodes_and_materials_shows(server):
    glb = scene_with([WALL, {**COPING, "edges": "up side"}], spacing=1, density=0.9)
    example = upload(server, glb).json()
    assert example["objects"][0]["decorations"][0]["edges"] == ["up", "side"]
    triangles = triangles_by_material(model_of(server, make(server, example["id"], size=[9, 4, 9])))
    assert triangles["trim"]
    written_out = [{"edges": ["up", "side"], "material": "trim",
                    "profile": [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1]]}]
    glb = scene_with([{**WALL, "decorations": json.dumps(written_out), "weight": 3},
                      {**COPING, "edges": ["down", "side"]}])
    decorations = upload(server, glb).json()["objects"][0]["decorations"]
    assert [one["edges"] for one in decorations] == [["down", "side"], ["up", "side"]]


@pytest.mark.parametrize("nodes, extras, pointer, who", [
    ([WALL], {"constraints": [{"kind": "forbidden", "objects": ["door"]}]},
     "/scenes/0/extras/constraints/0/objects/0", "the scene"),
    ([WALL], {"constraints": "[{"}, "/scenes/0/extras/constraints", "the scene"),
    ([WALL], {"connected": [["wall", "door"]]}, "/scenes/0/extras/connected/0/1", "the scene"),
    ([WALL], {"dimensions": [{"object": "wall", "normal": [0, 0, 0]}]},
     "/scenes/0/extras/dimensions/0/normal", "the scene"),
    ([WALL], {"spacing": -1}, "/scenes/0/extras/spacing", "the scene"),
    ([WALL], {"size": [1, 2]}, "/scenes/0/extras/size", "the scene"),
    ([WALL], {"bounds": {"min": [0, 0, 0], "max": [1, -1, 1]}}, "/scenes/0/extras/bounds",
     "the scene"),
    ([{**WALL, "weight": -1}], {}, "/nodes/0/extras/weight", 'node "house"'),
    ([{**WALL, "weight": 2 ** 32 + 1}], {}, "/nodes/0/extras/weight", 'node "house"'),
    ([{**WALL, "shape": '{"even": "x"}'}], {}, "/nodes/0/extras/shape/even", 'node "house"'),
    ([{**WALL, "decorations": [{"edges": ["up", "left"], "profile": [[0, 0], [1, 0], [0, 1]]}]}],
     {}, "/nodes/0/extras/decorations/0/edges/1", 'node "house"'),
    ([WALL, {**GEM, "even": "x"}], {}, "/nodes/1/extras/even", 'node "gem"'),
    ([WALL, {**GEM, "smooth": 181}], {}, "/nodes/1/extras/smooth", 'node "gem"'),
    ([{**WALL, "shape": {"even": ["x", "z"]}}, GEM], {}, "/nodes/0/extras/shape", 'node "house"'),
    ([WALL, GEM, GEM], {}, "/nodes/2", 'node "gem"'),
    ([WALL, {**WALL, "name": "second", "vertices": cube(2, (2, 0, 0))}, GEM], {}, "/nodes/1",
     'node "second"'),
    ([WALL, {**GEM, "faces": [face[::-1] for face in GEM["faces"]]}], {}, "/nodes/1", 'node "gem"'),
    ([WALL, {**COPING, "edges": "up left"}], {}, "/nodes/1/extras/edges/1", 'node "coping"'),
    ([WALL, {**COPING, "edges": "up side", "turn": "left"}], {}, "/nodes/1/extras/turn",
     'node "coping"'),
    ([WALL, {**COPING, **{"vertices": cube(0.2), "faces": BOX_FACES}, "corners": "up side"}], {},
     "/nodes/1/extras/corners", 'node "coping"'),
    ([WALL, COPING], {}, "/nodes/1", 'node "coping"'),
], ids=lambda value: str(value)[-40:])
def test_faults_are_named_with_their_place_in_the_file(server, nodes, extras, pointer, who):
    answer = upload(server, scene_with(nodes, **extras))
    problem = assert_problem(answer, 422, "invalid-request")
    assert [error["pointer"] for error in problem["errors"]] == [pointer], problem
    assert problem["errors"][0]["detail"].startswith(who), problem


def test_a_fault_of_a_material_is_named(server):
    materials = [{"name": "wall", "extras": {"weight": "much"}}]
    problem = assert_problem(upload(server, scene_with([WALL], materials)), 422, "invalid-request")
    assert [error["pointer"] for error in problem["errors"]] == ["/materials/0/extras/weight"]
    assert problem["errors"][0]["detail"].startswith('material "wall": ')

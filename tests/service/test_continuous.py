"""Continuous model synthesis through the API: examples made of solids, jobs, events, files."""

import base64
import collections
import json
import math
import pathlib
import random
import re
import struct
import zlib
import xml.etree.ElementTree

import pytest

from checks import assert_faults, assert_problem, state_of, together, wait_until
from glb_file import GlbFile
from test_websocket import frames_of, watch
from websocket_client import GLB

_GUIDE = pathlib.Path(__file__).parents[2] / "proto" / "continuous.md"

SIZE = [9.0, 5.0, 9.0]

# A gabled house on grass.
HUT = {
    "kind": "continuous", "name": "hut", "spacing": 1, "ground": "grass",
    "objects": [{"name": "grass", "color": [0.2, 0.4, 0.1]}, {"name": "wall"},
                {"name": "roof", "color": [0.5, 0.1, 0.1], "roughness": 0.7}],
    "polyhedra": [
        {"name": "walls", "object": "wall",
         "vertices": [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0],
                      [0, 0, 3], [2, 0, 3], [2, 1, 3], [0, 1, 3]],
         "faces": [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6],
                   [3, 0, 4, 7]]},
        {"name": "roof", "object": "roof",
         "vertices": [[0, 1, 0], [2, 1, 0], [1, 2, 0], [0, 1, 3], [2, 1, 3], [1, 2, 3]],
         "faces": [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]]}],
}


def make(server, **fields):
    request = {"solver": "continuous", "example": HUT, "seed": 4,
               "parameters": {"size": SIZE}, **fields}
    answer = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"})
    assert answer.status == 200, answer.body
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    return job


def model_of(server, job, query=""):
    answer = server.get(f"/v1/jobs/{job['id']}/model.glb{query}")
    assert answer.status == 200
    return answer.body


def triangles_by_material(data):
    """Corners of triangles, exactly as the file has them."""
    glb = GlbFile(data)
    triangles = collections.defaultdict(list)
    for mesh in glb.meshes():
        for primitive in mesh["primitives"]:
            points = glb.accessor(primitive["attributes"]["POSITION"])
            corners = [index for index, in glb.accessor(primitive["indices"])]
            name = glb.json["materials"][primitive["material"]]["name"]
            for i in range(0, len(corners), 3):
                triangles[name].append([tuple(points[c]) for c in corners[i:i + 3]])
    return triangles


def textured_corners(data):
    """(place, texture coordinates) of the corners of triangles, three by three."""
    glb = GlbFile(data)
    for mesh in glb.meshes():
        for primitive in mesh["primitives"]:
            points = glb.accessor(primitive["attributes"]["POSITION"])
            coordinates = glb.accessor(primitive["attributes"]["TEXCOORD_0"])
            assert len(coordinates) == len(points)
            corners = [index for index, in glb.accessor(primitive["indices"])]
            for i in range(0, len(corners), 3):
                yield [(points[c], coordinates[c]) for c in corners[i:i + 3]]


def assert_closed(triangles):
    edges = collections.Counter()
    for a, b, c in triangles:
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] += 1
    for (a, b), count in edges.items():
        assert edges[(b, a)] == count, f"an open edge from {a} to {b}"


def volume(triangles):
    total = 0
    for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in triangles:
        total += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6
    return total


def test_a_model_is_made_of_closed_solids(server):
    job = make(server)
    stats = job["result"]["stats"]
    assert stats["polygons"] > 20 and stats["changed"] > 0.01
    assert stats["blocks_reverted"] == 0
    triangles = triangles_by_material(model_of(server, job))
    assert set(triangles) == {"grass", "wall", "roof"}
    for name, of_one in triangles.items():
        assert_closed(of_one)
        assert volume(of_one) > 0.5, name
    xs = [x for of_one in triangles.values() for t in of_one for (x, _, _) in t]
    assert min(xs) == 0 and math.isclose(max(xs), SIZE[0])


@pytest.mark.parametrize("profile", ["nodes", "instanced", "merged"])
def test_texture_coordinates_are_metres(server, profile):
    triangles = list(textured_corners(model_of(server, make(server), f"?profile={profile}")))
    assert len(triangles) > 20
    for triangle in triangles:
        for (place, at), (other, at_other) in zip(triangle, triangle[1:]):
            assert math.isclose(math.dist(place, other), math.dist(at, at_other), abs_tol=1e-3)


def test_everything_stands_on_the_grid_of_the_spacing(server):
    job = make(server, parameters={"size": SIZE, "spacing": 0.5})
    for name, of_one in triangles_by_material(model_of(server, job)).items():
        if name == "wall":
            for triangle in of_one:
                for corner in triangle:
                    assert all(math.isclose(c * 2, round(c * 2), abs_tol=1e-5) for c in corner)


def test_equal_requests_give_equal_bytes_and_seeds_different_ones(server):
    first, again, other = make(server), make(server), make(server, seed=5)
    assert first["result"]["sha256"] == again["result"]["sha256"]
    assert first["result"]["sha256"] != other["result"]["sha256"]


def test_the_echo_makes_the_same_model_again(server):
    job = make(server)
    echo = job["request"]
    assert set(echo["parameters"]) == {
        "size", "spacing", "offsets", "blocks", "boundary", "jitter", "perturbation", "nudge",
        "variants", "density", "weights", "constraints"}
    answer = server.request("POST", "/v1/jobs", echo, headers={"Prefer": "wait=60"})
    assert answer.json()["result"]["sha256"] == job["result"]["sha256"]


def test_a_dimension_holds(server):
    dimension = {"kind": "dimension", "object": "wall", "normal": [-2, 0, 0]}
    job = make(server, parameters={"size": SIZE, "density": 0.6, "constraints": [dimension]})
    walls = triangles_by_material(model_of(server, job))["wall"]
    assert walls
    # Walls end at every plane x = k that meets them: no triangle reaches across one.
    for triangle in walls:
        xs = [x for (x, _, _) in triangle]
        assert math.floor(min(xs) + 1e-4) >= max(xs) - 1 - 1e-4


def test_density_says_how_much_there_is(server):
    sparse = make(server, parameters={"size": [20, 5, 20], "density": 0.1})
    dense = make(server, parameters={"size": [20, 5, 20], "density": 1})
    assert dense["result"]["stats"]["polygons"] > 2 * sparse["result"]["stats"]["polygons"]


def test_an_object_of_weight_0_is_not_made(server):
    job = make(server, parameters={"size": SIZE, "weights": {"roof": 0}})
    assert job["result"]["stats"]["changed"] == 0
    assert set(triangles_by_material(model_of(server, job))) == {"grass"}


def test_all_at_once(server):
    job = make(server, parameters={"size": SIZE, "blocks": None})
    assert job["progress"]["blocks_total"] == 1
    assert job["result"]["stats"]["changed"] > 0


def test_alternatives(server):
    job = make(server, alternatives=3)
    digests = {one["sha256"] for one in job["result"]["alternatives"]}
    assert len(digests) == 3
    assert "labels" not in job["result"] and "labels" not in job["urls"]


def test_events_and_partial_models(server):
    request = {"solver": "continuous", "example": HUT, "seed": 4,
               "parameters": {"size": [24, 5, 24]}}
    job = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"}).json()
    types = [event["type"] for event in server.events(job["id"])]
    assert types[:2] == ["queued", "started"] and types[-1] == "succeeded"
    assert types.count("block") == job["progress"]["blocks_total"]
    preview = server.get(f"/v1/jobs/{job['id']}/preview.glb")
    assert preview.status == 200 and preview.body == model_of(server, job)


def test_blocks_come_as_files(server):
    """Each frame is a GLB of the block's region, cut where the model goes on."""
    request = {"solver": "continuous", "example": HUT, "seed": 4,
               "parameters": {"size": [40, 5, 40], "blocks": {"size": [10, 5, 10], "passes": 4}}}
    job = server.request("POST", "/v1/jobs", request).json()
    frames = [frame for frame in frames_of(watch(server, job, "glb")) if frame.kind == GLB]
    assert frames
    for frame in frames[:10]:
        for of_one in triangles_by_material(frame.payload).values():
            for triangle in of_one:
                for x, _, z in triangle:
                    assert frame.min[0] - 1e-4 <= x <= frame.max[0] + 1e-4
                    assert frame.min[2] - 1e-4 <= z <= frame.max[2] + 1e-4


def test_labels_of_solids_are_not_streamed(server):
    job = make(server)
    answer = server.get(f"/v1/jobs/{job['id']}/stream?partial=labels", headers={
        "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Protocol": "modelsynth.v1"})
    assert_problem(answer, 422, "invalid-request")


def test_labels_are_of_grids(server):
    job = make(server)
    assert_problem(server.get(f"/v1/jobs/{job['id']}/labels.json"), 404, "not-found")


@pytest.mark.parametrize("parameters,pointers", [
    ({"size": [0, 5, 5]}, ["/parameters/size/0"]),
    ({"size": [5, 5]}, ["/parameters/size"]),
    ({"spacing": 0}, ["/parameters/spacing"]),
    ({"density": 0}, ["/parameters/density"]),
    ({"density": 1.5}, ["/parameters/density"]),
    ({"weights": {"door": 1}}, ["/parameters/weights/door"]),
    ({"order": "scan"}, ["/parameters/order"]),
    ({"constraints": [{"kind": "dimension", "object": "door", "normal": [1, 0, 0]}]},
     ["/parameters/constraints/0/object"]),
    ({"constraints": [{"kind": "dimension", "object": "wall", "normal": [1, 2, 3]}]},
     ["/parameters/constraints/0/normal"]),
    ({"constraints": [{"kind": "dimension", "object": "wall", "normal": [0, 0, 0]}]},
     ["/parameters/constraints/0/normal"]),
])
def test_what_cannot_be_asked_for(server, parameters, pointers):
    answer = server.request("POST", "/v1/jobs", {
        "solver": "continuous", "example": HUT, "parameters": parameters})
    assert answer.status == 422
    assert [error["pointer"] for error in answer.json()["errors"]] == pointers


def test_a_model_of_too_many_planes_is_refused(server):
    answer = server.request("POST", "/v1/jobs", {
        "solver": "continuous", "example": HUT,
        "parameters": {"size": [1000, 100, 1000], "spacing": 0.25}})
    assert_problem(answer, 422, "too-large")


def broken(change):
    example = json.loads(json.dumps(HUT))
    change(example)
    return example


@pytest.mark.parametrize("change,pointer", [
    (lambda e: e["polyhedra"][0]["faces"].pop(), "/polyhedra/0"),
    (lambda e: e["polyhedra"][1]["faces"][0].reverse(), "/polyhedra/1"),
    (lambda e: e["polyhedra"][0]["faces"][0].append(99), "/polyhedra/0/faces/0/4"),
    (lambda e: e["polyhedra"][0]["vertices"].__setitem__(6, [2.5, 1.2, 3]), "/polyhedra/0"),
    (lambda e: e["polyhedra"][0].__setitem__("object", "door"), "/polyhedra/0/object"),
    (lambda e: e.__setitem__("ground", "sea"), "/ground"),
    (lambda e: e.__setitem__("objects", []), "/objects"),
    (lambda e: e.__setitem__("kind", "cubist"), "/kind"),
    (lambda e: e.__setitem__("bounds", {"min": [0, 0, 0], "max": [0, 1, 1]}), "/bounds"),
])
def test_an_example_that_is_none_is_refused_with_its_place(server, change, pointer):
    answer = server.request("POST", "/v1/examples", broken(change))
    assert answer.status == 422
    assert any(error["pointer"].startswith(pointer) for error in answer.json()["errors"]), answer.body


def test_an_uploaded_example(server):
    answer = server.request("POST", "/v1/examples", HUT)
    assert answer.status == 201
    example = answer.json()
    assert example["kind"] == "continuous" and example["labels"] > 10
    again = server.request("POST", "/v1/examples", HUT).json()
    assert again["id"] == example["id"]
    by_id = make(server, example=example["id"])
    assert by_id["result"]["sha256"] == make(server)["result"]["sha256"]
    analysis = server.get(f"/v1/examples/{example['id']}/analysis").json()
    assert analysis["labels"] == example["labels"] and len(analysis["families"]) == 5
    assert_problem(server.get(f"/v1/examples/{example['id']}/pieces.glb"), 404, "not-found")
    assert_problem(server.get(f"/v1/examples/{example['id']}/success.svg"), 404, "not-found")


def evaluated(expression, families, direction):
    """The value of a printed expression in a direction, by Python's own reading of it."""
    python = expression.replace("∧", "and").replace("∨", "or").replace("¬", "not ")
    sides = {family["name"]: sum(n * p for n, p in zip(family["normal"], direction)) < 0
             for family in families}
    return bool(eval(python, {"__builtins__": {}}, sides))  # pylint: disable=eval-used


@pytest.mark.parametrize("example", ["hut", "houses", "fractals", "roads"])
def test_the_analysis_lists_figures(server, example):
    if example == "hut":
        example = server.request("POST", "/v1/examples", HUT).json()["id"]
    analysis = server.get(f"/v1/examples/{example}/analysis").json()
    figures = analysis["figure_list"]
    assert len(figures) == analysis["figures_listed"] == analysis["labels"]
    assert sum(figure["rank"] == 3 for figure in figures) == analysis["corner_labels"]
    families = analysis["families"]
    assert [family["name"] for family in families] == \
        [f"h{number + 1}" for number in range(len(families))]
    directions = [[random.Random(seed).gauss(0, 1) for _ in range(3)] for seed in range(50)]
    seen = set()
    for number, figure in enumerate(figures):
        assert set(figure) == {"number", "rank", "objects", "expressions", "families"}
        assert figure["number"] == number
        assert list(figure["expressions"]) == figure["objects"]
        assert figure["families"] == sorted(set(figure["families"]))
        named = {name for text in figure["expressions"].values()
                 for name in re.findall(r"h\d+", text)}
        assert named <= {families[index]["name"] for index in figure["families"]}
        assert (figure["rank"] == 0) == (not figure["families"])
        for direction in directions:
            assert sum(evaluated(text, families, direction)
                       for text in figure["expressions"].values()) <= 1
        seen.add(json.dumps(figure["expressions"]))
    assert len(seen) == len(figures)


def test_figures_of_a_hut_are_what_stands_there(server):
    example = server.request("POST", "/v1/examples", HUT).json()["id"]
    analysis = server.get(f"/v1/examples/{example}/analysis").json()
    normals = {tuple(family["normal"]): family["name"] for family in analysis["families"]}
    up, east, south = normals[(0, 1, 0)], normals[(1, 0, 0)], normals[(0, 0, 1)]
    assert up == "h1"
    written = [figure["expressions"] for figure in analysis["figure_list"]]
    assert {} in written and {"grass": "1"} in written
    assert {"grass": up} in written  # the bare ground
    # A wall's corner on the ground, its numbers ascending.
    corner = " ∧ ".join(f"¬{up}" if name == up else name for name in sorted([up, east, south]))
    assert {"grass": up, "wall": corner} in written


def titles_of(svg):
    root = xml.etree.ElementTree.fromstring(svg)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    return [title.text for title in root.iter("{http://www.w3.org/2000/svg}title")]


def test_figures_are_drawn(server):
    example = server.request("POST", "/v1/examples", HUT).json()["id"]
    analysis = server.get(f"/v1/examples/{example}/analysis").json()
    url = analysis["urls"]["figures"]
    assert url == f"/v1/examples/{example}/figures.svg"
    sheet = server.get(url)
    assert sheet.status == 200 and sheet.headers["content-type"] == "image/svg+xml"
    assert sheet.body == server.get(url).body
    titles = titles_of(sheet.body)
    assert len(titles) == 1 + analysis["labels"]
    ranks = [title.split(";")[0].split(" ")[1] for title in titles[1:]]
    assert ranks == sorted(ranks, key=["corner", "edge", "face", "inside"].index)
    figure = next(one for one in analysis["figure_list"] if len(one["objects"]) == 2)
    one = server.get(f"{url}?figure={figure['number']}")
    assert one.status == 200 and one.headers["content-type"] == "image/svg+xml"
    [title] = titles_of(one.body)
    for name, expression in figure["expressions"].items():
        assert f"{name}: {expression}" in title
        assert f"{name}: {expression}" in one.body.decode()
    head = server.request("HEAD", url)
    assert head.status == 200 and head.headers["content-type"] == "image/svg+xml"


def test_what_has_no_figures(server):
    assert_problem(server.get("/v1/examples/castle/figures.svg"), 404, "not-found")
    assert_problem(server.get("/v1/examples/nothing/figures.svg"), 404, "not-found")
    labels = server.get("/v1/examples/houses/analysis").json()["labels"]
    url = "/v1/examples/houses/figures.svg"
    assert server.get(f"{url}?figure={labels - 1}").status == 200
    for query, status, kind in ((f"figure={labels}", 422, "invalid-request"),
                                ("figure=-1", 422, "invalid-request"),
                                ("figure=", 400, "malformed-request"),
                                ("figure=1&figure=2", 400, "malformed-request"),
                                ("number=1", 400, "malformed-request")):
        problem = assert_problem(server.get(f"{url}?{query}"), status, kind)
        assert f'"{query.split("=")[0]}"' in problem["detail"]
    refused = server.request("POST", url, {})
    assert_problem(refused, 405, "method-not-allowed")
    assert refused.headers["allow"] == "GET, HEAD"


def test_of_many_figures_the_first_are_listed_and_drawn(server):
    boxes = []
    for i in range(40):
        (x0, x1), (z0, z1) = ((3 * i, 3 * i + 1), (0, 1))
        boxes.append({"object": f"box {i}", "vertices": [
            [x0, 0, z0], [x1, 0, z0], [x1, 1, z0], [x0, 1, z0],
            [x0, 0, z1], [x1, 0, z1], [x1, 1, z1], [x0, 1, z1]],
            "faces": HUT["polyhedra"][0]["faces"]})
    answer = server.request("POST", "/v1/examples", {
        "kind": "continuous", "name": "boxes", "spacing": 1, "polyhedra": boxes,
        "objects": [{"name": f"box {i}"} for i in range(40)]})
    assert answer.status == 201, answer.body
    url = f"/v1/examples/{answer.json()['id']}"
    analysis = server.get(f"{url}/analysis").json()
    assert analysis["labels"] == 40 * 27 + 1
    assert analysis["figures_listed"] == len(analysis["figure_list"]) == 1024
    titles = titles_of(server.get(f"{url}/figures.svg").body)
    assert len(titles) == 1 + 256 and "the first 256 of 1081" in titles[0]
    assert titles_of(server.get(f"{url}/figures.svg?figure=1080").body)[0].startswith("1080 ")


def test_figures_of_an_example_are_drawn_by_few_at_a_time(server):
    example = server.request("POST", "/v1/examples", {**HUT, "name": "drawn at once"}).json()["id"]
    answers = together(6, lambda _: server.request("GET", f"/v1/examples/{example}/figures.svg"))
    good = [answer.body for answer in answers if answer.status == 200]
    assert good and len(set(good)) == 1
    for answer in answers:
        if answer.status != 200:
            assert_problem(answer, 503, "busy")


def test_an_example_as_glb_is_the_same_example(server):
    """The example's own picture, sent back, has its solids again."""
    example = server.request("POST", "/v1/examples", {**HUT, "ground": "wall"}).json()
    picture = server.get(f"/v1/examples/{example['id']}/model.glb").body
    answer = server.request("POST", "/v1/examples", picture,
                            headers={"Content-Type": "model/gltf-binary"})
    assert answer.status == 201, answer.body
    read = answer.json()
    assert {solid["object"] for solid in read["polyhedra"]} == {"wall", "roof"}
    assert len(read["polyhedra"]) == 2
    job = make(server, example=read["id"])
    assert job["result"]["stats"]["polygons"] > 0


def png(side):
    """A chequered picture."""
    def chunk(kind, data):
        checksum = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)
    rows = b"".join(b"\0" + bytes(255 * ((x // 4 + y // 4) % 2) for x in range(side))
                    for y in range(side))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", side, side, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def textures_of(data):
    """The bytes of the picture of each material that has one."""
    glb = GlbFile(data)
    found = {}
    for material in glb.json["materials"]:
        texture = material["pbrMetallicRoughness"].get("baseColorTexture")
        if texture is not None:
            image = glb.json["images"][glb.json["textures"][texture["index"]]["source"]]
            assert image["mimeType"] == "image/png"
            view = glb.json["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            found[material["name"]] = glb.binary[start:start + view["byteLength"]]
    return found


def textured_hut():
    """With a picture on its walls that is half a metre wide."""
    example = broken(lambda e: e["objects"][1].update(texture={"image": 0, "metres": 0.5}))
    example["images"] = ["data:image/png;base64," + base64.b64encode(png(16)).decode()]
    return example


@pytest.mark.parametrize("form", ["json", "glb"])
def test_the_textures_of_an_example_are_those_of_its_models(make_server, form):
    server = make_server()
    answer = server.request("POST", "/v1/examples", textured_hut())
    assert answer.status == 201, answer.body
    if form == "glb":
        picture = server.get(f"/v1/examples/{answer.json()['id']}/model.glb").body
        assert textures_of(picture) == {"wall": png(16)}
        answer = server.request("POST", "/v1/examples", picture,
                                headers={"Content-Type": "model/gltf-binary"})
        assert answer.status == 201, answer.body
    server.kill()
    server.start()
    model = model_of(server, make(server, example=answer.json()["id"]))
    assert textures_of(model) == {"wall": png(16)}
    # What is on walls is twice as dense as a metre, whatever else there is.
    glb = GlbFile(model)
    for primitive in glb.meshes()[0]["primitives"]:
        place = glb.accessor(primitive["attributes"]["POSITION"])
        at = glb.accessor(primitive["attributes"]["TEXCOORD_0"])
        wall = glb.json["materials"][primitive["material"]]["name"] == "wall"
        assert math.isclose(math.dist(at[0], at[1]),
                            math.dist(place[0], place[1]) * (2 if wall else 1), abs_tol=1e-4)


def test_a_glb_that_is_none_is_refused(server):
    answer = server.request("POST", "/v1/examples", b"glTF but not really",
                            headers={"Content-Type": "model/gltf-binary"})
    assert_problem(answer, 400, "malformed-request")


def test_examples_belong_to_solvers(server):
    for solver, example in (("discrete", HUT), ("continuous", "castle")):
        request = {"solver": solver, "example": example}
        assert_faults(server.request("POST", "/v1/jobs", request), request, ["/example"])


def test_built_in_examples_of_solids_are_listed_and_made(server):
    listed = {item["id"]: item for item in server.get("/v1/examples").json()["items"]}
    solids = [name for name, item in listed.items() if item["kind"] == "continuous"]
    assert {"houses", "skyscrapers", "arches", "roads", "plumbing", "spaceships"} <= set(solids)
    for name in solids:
        spacing = listed[name]["spacing"]
        job = make(server, example=name, parameters={"size": [8 * spacing, 7 * spacing, 8 * spacing]})
        assert job["result"]["stats"]["blocks_reverted"] == 0, name
        for of_one in triangles_by_material(model_of(server, job)).values():
            assert_closed(of_one)


def test_a_cancelled_job_keeps_its_preview(server):
    request = {"solver": "continuous", "example": "houses",
               "parameters": {"size": [60, 10, 60], "blocks": {"size": [10, 10, 10], "passes": 100}}}
    job = server.request("POST", "/v1/jobs", request).json()
    wait_until(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["blocks_done"] > 3)
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")
    wait_until(lambda: state_of(server, job) == "cancelled")
    assert server.get(f"/v1/jobs/{job['id']}/preview.glb").status == 200


def test_a_job_goes_on_after_a_crash(make_server):
    server = make_server()
    request = {"solver": "continuous", "example": "houses", "seed": 3,
               "parameters": {"size": [40, 8, 40], "blocks": {"size": [10, 8, 10], "passes": 4}}}
    job = server.request("POST", "/v1/jobs", request).json()
    wait_until(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["blocks_done"] > 10)
    server.kill()
    server.start()
    wait_until(lambda: state_of(server, job) == "succeeded", timeout=60)
    whole = server.request("POST", "/v1/jobs", request, headers={"Prefer": "wait=60"}).json()
    again = server.get(f"/v1/jobs/{job['id']}").json()
    assert again["result"]["sha256"] == whole["result"]["sha256"]


def test_the_requests_of_the_guide_are_done(server):
    requests = re.findall(r"```json\n(.*?)```", _GUIDE.read_text(), re.DOTALL)
    assert len(requests) == 18
    for text in requests:
        answer = server.request("POST", "/v1/jobs", text, headers={
            "Prefer": "wait=60", "Content-Type": "application/json"})
        assert answer.json()["state"] == "succeeded", answer.body
        assert answer.json()["result"]["stats"]["changed"] > 0.01


def test_the_addresses_of_the_guide_are_there(server):
    addresses = re.findall(r"http://127.0.0.1:8080(/[^\s']*)", _GUIDE.read_text())
    assert len(addresses) == 3
    for address in addresses:
        assert server.get(address).status == 200, address


# Its planes meet in some two million points, which takes seconds to work out.
LARGE = {"solver": "continuous", "example": "houses", "seed": 1,
         "parameters": {"size": [150, 12, 150]}}


def test_a_deadline_ends_a_job_while_it_is_prepared(server):
    job = server.request("POST", "/v1/jobs", {**LARGE, "deadline": 0.05}).json()
    ended = server.wait(job["id"])
    assert ended["state"] == "failed", ended
    assert ended["error"]["type"] == "/problems/deadline-exceeded"
    assert [event["type"] for event in server.events(job["id"])] == ["queued", "failed"]
    answer = server.get(f"/v1/jobs/{job['id']}/preview.glb")
    assert answer.status == 409 and answer.json()["type"] == "/problems/no-model"


def test_a_job_is_cancelled_while_it_is_prepared(server):
    job = server.request("POST", "/v1/jobs", LARGE).json()
    wait_until(lambda: server.get(f"/v1/jobs/{job['id']}").json()["state"] == "running")
    server.request("POST", f"/v1/jobs/{job['id']}/cancel")
    assert server.wait(job["id"])["state"] == "cancelled"
    assert [event["type"] for event in server.events(job["id"])][-1] == "cancelled"
    small = {**LARGE, "parameters": {"size": [12, 6, 12]}}
    answer = server.request("POST", "/v1/jobs", small, headers={"Prefer": "wait=60"})
    assert answer.status == 200 and answer.json()["state"] == "succeeded"

"""Examples over HTTP: listing, uploading, deleting, and GLB meshes that come with them."""

import base64
import json
import re
import struct

import pytest

from checks import (HILLS, STRIPES, assert_faults, assert_fits, assert_problem, compact,
                    endless_job, files_of, job_request, make_job, make_model, pointers, resolves,
                    short, together, wait_until)

LINE = {  # the contract's own
    "kind": "discrete", "name": "line", "cell": [1, 1, 1],
    "pieces": [{"name": "empty"}, {"name": "ground"}, {"name": "wall", "weight": 2}],
    "size": [4, 2, 3],
    "cells": [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 2, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0],
    "empty": "empty",
    "boundary": {"bottom": "example", "top": "empty", "north": "free", "south": "free",
                 "west": "free", "east": "free"},
}


def upload(server, example, **headers):
    body = example if isinstance(example, (bytes, str)) else json.dumps(example)
    return server.request("POST", "/v1/examples", body,
                          headers={"Content-Type": "application/json", **headers})


@pytest.fixture
def uploaded(server):
    """Uploads examples and deletes them with the test."""
    ids = []

    def up(example):
        answer = upload(server, example)
        assert answer.status == 201, answer.body
        ids.append(answer.json()["id"])
        return answer

    yield up
    for example_id in set(ids):
        server.request("DELETE", f"/v1/examples/{example_id}")


# --- GLB files, built from nothing

def accessor(view, count, kind="VEC3", component=5126, **more):
    return {"bufferView": view, "count": count, "type": kind, "componentType": component, **more}


def triangle(**changes):
    """A glTF document with one named triangle, and its binary chunk."""
    corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    indices = struct.pack("<3H", 0, 1, 2) + b"\0\0"
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "wall", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [accessor(0, 3, min=[0, 0, 0], max=[1, 1, 0]),
                      accessor(1, 3, "SCALAR", 5123)],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 44}],
    }
    document.update(changes)
    return document, corners + indices


def glb(document, binary=b"", version=2, length=None):
    text = document if isinstance(document, bytes) else compact(document)
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        binary += b"\0" * (-len(binary) % 4)
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", version, 12 + len(chunks) if length is None else length) \
        + chunks


def data_uri(content, kind="model/gltf-binary"):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def with_meshes(content, name="meshed", **more):
    pieces = [{"name": "empty"}, {"name": "ground"}, {"name": "wall", "mesh": "wall"}]
    return {**LINE, "name": name, "pieces": pieces, "meshes": data_uri(content), **more}


def read_glb(content):
    magic, version, length = struct.unpack("<4sII", content[:12])
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack("<I4s", content[12:20])
    assert kind == b"JSON"
    return json.loads(content[20:20 + size])


# --- what there is

def test_the_built_in_examples_are_listed(server):
    page = server.get("/v1/examples").json()
    assert page["next"] is None
    ids = [example["id"] for example in page["items"]]
    assert {"castle", "city", "canyon"} <= set(ids) and len(ids) == len(set(ids))
    for item in page["items"]:
        assert item["kind"] in ("discrete", "continuous") and len(item["size"]) == 3
        whole = server.get(item["urls"]["self"]).json()
        # A list shows objects without their pictures and shapes.
        for shown, told in zip(item.pop("objects", []), whole.get("objects", []), strict=True):
            assert told.items() >= shown.items()
        assert whole.items() >= item.items()


@pytest.mark.parametrize("example_id", ["castle", "city", "canyon"])
def test_a_built_in_example_is_told_whole(server, example_id):
    example = server.get(f"/v1/examples/{example_id}").json()
    width, height, depth = example["size"]
    assert len(example["cells"]) == width * height * depth
    assert set(example["cells"]) <= set(range(len(example["pieces"])))
    assert len(example["pieces"]) == example["labels"]
    names = [piece["name"] for piece in example["pieces"]]
    assert len(set(names)) == len(names) and example["empty"] in names
    assert set(example["boundary"]) == {"bottom", "top", "north", "south", "west", "east"}


@pytest.mark.parametrize("example_id", ["castle", "city", "canyon"])
def test_an_example_can_be_looked_at_and_its_pieces_had_by_name(server, example_id):
    example = server.get(f"/v1/examples/{example_id}").json()
    for what in ("model", "pieces"):
        answer = server.get(example["urls"][what])
        assert answer.status == 200
        assert answer.headers["content-type"] == "model/gltf-binary"
        document = read_glb(answer.body)
        again = server.get(example["urls"][what],
                           headers={"If-None-Match": answer.headers["etag"]})
        assert again.status == 304 and again.body == b""
    nodes = [node["name"] for node in document["nodes"] if "name" in node]
    assert set(nodes) >= {piece["name"] for piece in example["pieces"]}


@pytest.mark.parametrize("path", ["", "/model.glb", "/pieces.glb"])
@pytest.mark.parametrize("example_id", ["nope", "..", "%2e%2e", "CASTLE", "castle%20", "x" * 2000],
                         ids=short)
def test_an_unknown_example_is_not_found(server, example_id, path):
    assert_problem(server.get(f"/v1/examples/{example_id}{path}"), 404, "not-found",
                   f"/v1/examples/{example_id}{path}")


# --- uploading

def test_an_uploaded_example_is_there_with_its_place(server, uploaded):
    answer = uploaded(LINE)
    example = answer.json()
    assert answer.headers["location"] == f"/v1/examples/{example['id']}"
    assert re.fullmatch(r"[A-Za-z0-9_-]+", example["id"])
    assert example["name"] == "line" and example["size"] == LINE["size"]
    assert example["cells"] == LINE["cells"] and example["empty"] == "empty"
    assert [piece["name"] for piece in example["pieces"]] == ["empty", "ground", "wall"]
    assert example["pieces"][2]["weight"] == 2
    assert server.get(answer.headers["location"]).json() == example
    listed = [item["id"] for item in server.get("/v1/examples").json()["items"]]
    assert listed.count(example["id"]) == 1


def test_the_same_upload_twice_is_one_example(server, uploaded):
    first, second = uploaded(LINE), uploaded(json.dumps(LINE, indent=3))
    reordered = uploaded(dict(reversed(LINE.items())))
    assert first.json()["id"] == second.json()["id"] == reordered.json()["id"]
    listed = [item["id"] for item in server.get("/v1/examples").json()["items"]]
    assert listed.count(first.json()["id"]) == 1


def test_another_example_has_another_id(server, uploaded):
    ids = {uploaded(example).json()["id"] for example in
           (LINE, {**LINE, "name": "lane"}, {**LINE, "cells": LINE["cells"][::-1]})}
    assert len(ids) == 3


def test_ten_uploads_of_one_example_at_once_make_one(make_server):
    server = make_server()
    answers = together(10, lambda _: upload(server, HILLS))
    assert {answer.status for answer in answers} == {201}
    assert len({answer.json()["id"] for answer in answers}) == 1
    assert len(files_of(server, "artifacts")) == 1 and not files_of(server, "tmp")


@pytest.mark.parametrize("example", [LINE, HILLS, STRIPES], ids=["line", "hills", "stripes"])
def test_an_inline_example_makes_what_the_uploaded_one_makes(server, uploaded, example):
    example_id = uploaded(example).json()["id"]
    size = [11, example["size"][1], 8]
    by_id, labels = make_model(server, {"size": size}, example=example_id)
    inline, inline_labels = make_model(server, {"size": size}, example=example)
    assert by_id["result"]["sha256"] == inline["result"]["sha256"]
    assert by_id["request"]["example"] == example_id
    assert inline["request"]["example"] == example
    assert labels == inline_labels
    assert_fits(labels, example, by_id["request"]["parameters"]["boundary"])


def test_an_example_may_list_its_neighbours_instead_of_cells(server):
    chess = {"kind": "discrete", "name": "chess", "pieces": [{"name": "b"}, {"name": "w"}],
             "adjacency": {"x": [["b", "w"], ["w", "b"]], "z": [["b", "w"], ["w", "b"]],
                           "y": [["b", "b"], ["w", "w"]]}}
    _, labels = make_model(server, {"size": [7, 3, 6]}, example=chess)
    first = labels["cells"][0]
    assert labels["cells"] == [(first + x + z) % 2 for _ in range(3) for z in range(6)
                               for x in range(7)]


def test_listed_neighbours_are_added_to_those_in_the_cells(server):
    example = {**STRIPES, "adjacency": {"x": [["red", "blue"], ["blue", "red"]]}}
    fixed = {"kind": "fixed", "pieces": ["red", "blue"], "box": {"min": [0, 0, 0],
                                                                "max": [6, 1, 4]}}
    _, labels = make_model(server, {"constraints": [fixed]}, example=example)
    assert set(labels["cells"][:24]) == {1, 3}
    without = make_job(server, {"constraints": [fixed]})
    assert without["state"] == "failed"


ONE = {"kind": "discrete", "name": "one", "pieces": [{"name": "it"}], "size": [1, 1, 1],
       "cells": [1]}
BAD_PIECES = [{"name": "empty"}, {"name": "ground"}, {"name": "wall"}]


@pytest.mark.parametrize(("example", "expected"), [
    ({}, ["/kind", "/name", "/pieces", "/size", "/cells"]), ([], [""]), ("line", [""]),
    (None, [""]),
    ({**LINE, "kind": "liquid"}, ["/kind"]), ({**LINE, "name": 3}, ["/name"]),
    ({**LINE, "colour": 1}, ["/colour"]), ({**LINE, "cell": [1, 1]}, ["/cell"]),
    ({**LINE, "cell": [1, 0, -1]}, ["/cell/1", "/cell/2"]),
    ({**LINE, "cell": [1, "1", 1]}, ["/cell/1"]),
    ({**LINE, "size": [4, 2]}, ["/size"]), ({**LINE, "size": [4, 2, 2]}, ["/cells"]),
    ({**LINE, "size": [4, 0, 3]}, ["/size/1"]),
    ({**LINE, "cells": LINE["cells"][:-1]}, ["/cells"]), ({**LINE, "cells": "1"}, ["/cells"]),
    ({**LINE, "cells": [*LINE["cells"][:-1], 3]}, ["/cells/23"]),
    ({**LINE, "cells": [-1, *LINE["cells"][1:-1], 1.5]}, ["/cells/0", "/cells/23"]),
    ({**ONE, "pieces": []}, ["/pieces", "/cells/0"]),
    ({**ONE, "pieces": {}}, ["/pieces", "/cells/0"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {"name": "empty"}]}, ["/pieces/2/name"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {"name": ""}]}, ["/pieces/2/name"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {}]}, ["/pieces/2/name"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], "wall"]}, ["/pieces/2"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {"name": "wall", "weight": -1}]}, ["/pieces/2/weight"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {"name": "wall", "mesh": "wall"}]}, ["/pieces/2/mesh"]),
    ({**LINE, "pieces": [*BAD_PIECES[:2], {"name": "wall", "file": "x"}]}, ["/pieces/2/file"]),
    ({**LINE, "empty": "void"}, ["/empty"]), ({**LINE, "empty": 0}, ["/empty"]),
    ({**LINE, "boundary": {"bottom": "lava"}}, ["/boundary/bottom"]),
    ({**LINE, "boundary": {"bottom": ["ground", "lava"]}}, ["/boundary/bottom/1"]),
    ({**LINE, "boundary": {"left": "free"}}, ["/boundary/left"]),
    ({**LINE, "boundary": {"west": "periodic"}}, ["/boundary/west"]),
    ({**LINE, "adjacency": {"w": []}}, ["/adjacency/w"]),
    ({**LINE, "adjacency": {"x": [["ground", "lava"]]}}, ["/adjacency/x/0"]),
    ({**LINE, "adjacency": {"x": [["ground"]]}}, ["/adjacency/x/0"]),
    ({**LINE, "meshes": "wall.glb"}, ["/meshes"]),
    ({**LINE, "meshes": "file:///etc/passwd"}, ["/meshes"]),
    ({**LINE, "meshes": "http://127.0.0.1:9/wall.glb"}, ["/meshes"]),
    ({**LINE, "meshes": 7}, ["/meshes"]),
    ({**LINE, "meshes": "data:model/gltf-binary;base64,"}, ["/meshes"]),
    ({**LINE, "meshes": "data:model/gltf-binary;base64,!!!!"}, ["/meshes"]),
    ({**LINE, "meshes": "data:model/gltf-binary;base64,Z2xURg"}, ["/meshes"]),
    ({**LINE, "meshes": "data:image/png;base64,Z2xURgo="}, ["/meshes"]),
], ids=lambda value: short(
    {name: part for name, part in value.items() if LINE.get(name) != part}
    if isinstance(value, dict) else value))
def test_a_wrong_example_is_refused_with_a_pointer_to_each_fault(server, example, expected):
    before = server.get("/v1/examples").json()
    assert_faults(upload(server, json.dumps(example)), example, expected)
    inline = job_request(example=example)
    if isinstance(example, dict):
        assert_faults(server.request("POST", "/v1/jobs", json.dumps(inline)), inline,
                      ["/example" + pointer for pointer in expected])
    assert server.get("/v1/examples").json() == before


def test_all_faults_of_an_example_are_found_at_once(server):
    example = {**LINE, "name": 3, "cell": [0, 1, 1], "empty": "void", "bogus": 1,
               "pieces": [*LINE["pieces"][:2], {"name": "wall", "weight": "2"}],
               "cells": [*LINE["cells"][:-2], 9, 9], "boundary": {"top": 7}}
    assert_faults(upload(server, example), example,
                  ["/name", "/cell/0", "/empty", "/bogus", "/pieces/2/weight", "/cells/22",
                   "/cells/23", "/boundary/top"])


def test_very_many_faults_of_an_example_are_cut(server):
    example = {**LINE, "cells": [99] * 24, **{f"bogus{i}": 1 for i in range(100)}}
    problem = assert_problem(upload(server, example), 422)
    assert 10 <= len(problem["errors"]) <= 50
    assert all(resolves(example, pointer) for pointer in pointers(problem))


@pytest.mark.parametrize("body", [b"", b"{", b"glTF\x02\0\0\0", b'{"kind":"discrete",}',
                                  b"[" * 10_000, compact(LINE) + b"\x00", b'{"name":"\xff"}',
                                  b'{"kind":"discrete","kind":"discrete"}'], ids=short)
def test_an_upload_that_is_no_json_is_refused(server, body):
    assert_problem(upload(server, body), 400, "malformed-json", "/v1/examples")


def test_more_uploads_than_are_kept_are_refused(make_server):
    server = make_server("--examples-max", 2)
    for name in ("one", "two"):
        assert upload(server, {**LINE, "name": name}).status == 201
    assert_problem(upload(server, {**LINE, "name": "three"}), 422, "too-large")
    assert upload(server, {**LINE, "name": "one"}).status == 201  # there already
    assert len(files_of(server, "artifacts")) == 2, "the refused one left its file behind"


# --- deleting

def test_an_uploaded_example_can_be_deleted(make_server):
    server = make_server()
    example_id = upload(server, LINE).json()["id"]
    assert len(files_of(server, "artifacts")) == 1
    answer = server.request("DELETE", f"/v1/examples/{example_id}")
    assert answer.status == 204 and answer.body == b""
    assert_problem(server.get(f"/v1/examples/{example_id}"), 404, "not-found")
    assert_problem(server.request("DELETE", f"/v1/examples/{example_id}"), 404, "not-found")
    request = job_request(example=example_id)
    assert_faults(server.request("POST", "/v1/jobs", request), request, ["/example"])
    wait_until(lambda: not files_of(server, "artifacts", "tmp"))
    assert upload(server, LINE).json()["id"] == example_id


def test_a_built_in_example_cannot_be_deleted(server):
    assert_problem(server.request("DELETE", "/v1/examples/castle"), 403, "forbidden")
    assert server.get("/v1/examples/castle").status == 200


@pytest.mark.parametrize("state", ["queued", "running"])
def test_an_example_that_an_unfinished_job_uses_cannot_be_deleted(make_server, state):
    server = make_server(workers=1)
    example_id = upload(server, HILLS).json()["id"]
    with endless_job(server, example=example_id if state == "running" else "castle"):
        if state == "queued":
            job = server.request("POST", "/v1/jobs", job_request(example=example_id)).json()
            assert job["state"] == "queued"
        assert_problem(server.request("DELETE", f"/v1/examples/{example_id}"), 409,
                       "example-in-use")
        assert server.get(f"/v1/examples/{example_id}").status == 200
    if state == "queued":
        assert server.wait(job["id"])["state"] == "succeeded"
    assert server.request("DELETE", f"/v1/examples/{example_id}").status == 204


@pytest.mark.parametrize("path", ["model.glb", "labels.json", "preview.glb",
                                  "model.glb?profile=instanced", "model.glb?profile=merged"])
def test_a_finished_job_outlives_its_example(server, uploaded, path):
    example = {**HILLS, "name": f"short-lived {path}"}
    example_id = uploaded(example).json()["id"]
    job = make_job(server, {"size": [8, 4, 8]}, example=example_id)
    assert server.request("DELETE", f"/v1/examples/{example_id}").status == 204
    answer = server.get(f"/v1/jobs/{job['id']}/{path}")
    assert answer.status == 200, answer.body
    if path == "labels.json":
        assert_fits(answer.json(), example, job["request"]["parameters"]["boundary"])


# --- meshes

def test_a_mesh_that_comes_with_the_example_is_used(server, uploaded):
    example = uploaded(with_meshes(glb(*triangle()))).json()
    assert example["pieces"][2]["mesh"] == "wall"
    document = read_glb(server.get(example["urls"]["pieces"]).body)
    node = next(node for node in document["nodes"] if node.get("name") == "wall")
    primitive = document["meshes"][node["mesh"]]["primitives"][0]
    assert document["accessors"][primitive["attributes"]["POSITION"]]["count"] == 3
    fixed = {"kind": "fixed", "pieces": ["wall"], "cells": [[3, 1, 3]]}
    parameters = {"size": [8, 2, 8], "constraints": [fixed], "boundary": {"top": "free"}}
    job, labels = make_model(server, parameters, example=example["id"])
    assert_fits(labels, example, job["request"]["parameters"]["boundary"])
    assert 2 in labels["cells"]


def test_an_inline_example_may_bring_its_meshes_too(server, uploaded):
    example = with_meshes(glb(*triangle()))
    inline = make_job(server, {"size": [8, 2, 8]}, example=example)
    by_id = make_job(server, {"size": [8, 2, 8]}, example=uploaded(example).json()["id"])
    assert inline["result"]["sha256"] == by_id["result"]["sha256"]


@pytest.mark.parametrize("document", [
    triangle(nodes=[{"name": "wall", "mesh": 0, "rotation": [0, 0, 0, 1], "scale": [2, 2, 2],
                     "translation": [9, 9, 9]}])[0],
    triangle(nodes=[{"name": "wall", "children": [1, 2]}, {"mesh": 0}, {"mesh": 0}],
             scenes=[{"nodes": [0]}])[0],
    triangle(nodes=[{"mesh": 0}], meshes=[{**triangle()[0]["meshes"][0], "name": "wall"}])[0],
    triangle(materials=[{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
             extras={"anything": [1, 2]})[0],
    triangle(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}])[0],
], ids=["transformed", "named parent", "mesh name", "material", "no indices"])
def test_an_ordinary_glb_is_taken(server, uploaded, document):
    assert uploaded(with_meshes(glb(document, triangle()[1]))).status == 201


GOOD_GLB = glb(*triangle())
BINARY = triangle()[1]


def changed(**changes):
    return glb(triangle(**changes)[0], BINARY)


def with_accessor(**changes):
    accessors = triangle()[0]["accessors"]
    return changed(accessors=[{**accessors[0], **changes}, accessors[1]])


def with_view(**changes):
    views = triangle()[0]["bufferViews"]
    return changed(bufferViews=[{**views[0], **changes}, views[1]])


def with_primitive(**changes):
    primitive = triangle()[0]["meshes"][0]["primitives"][0]
    return changed(meshes=[{"primitives": [{**primitive, **changes}]}])


BROKEN_GLBS = {
    "nothing": b"", "text": b"not a model", "magic": b"glTF", "header only": GOOD_GLB[:12],
    "half": GOOD_GLB[:len(GOOD_GLB) // 2], "one byte short": GOOD_GLB[:-1],
    "one byte more": GOOD_GLB + b"\0", "magic of another": b"FTlg" + GOOD_GLB[4:],
    "version 1": glb(*triangle(), version=1), "version 3": glb(*triangle(), version=3),
    "length 0": glb(*triangle(), length=0), "length huge": glb(*triangle(), length=2**32 - 1),
    "JSON chunk too long": GOOD_GLB[:12] + struct.pack("<I", 2**32 - 1) + GOOD_GLB[16:],
    "JSON chunk cut": GOOD_GLB[:12] + struct.pack("<I", 40) + GOOD_GLB[16:],
    "no JSON chunk": struct.pack("<4sII", b"glTF", 2, 20) + struct.pack("<I4s", 0, b"BIN\0"),
    "broken JSON": glb(b"{" * 40, BINARY), "deep JSON": glb(b"[" * 100_000, BINARY),
    "JSON of another kind": glb([1, 2], BINARY), "empty JSON": glb({}, BINARY),
    "no binary chunk": glb(triangle()[0]),
    "binary chunk too short": glb(triangle()[0], BINARY[:8]),
    "cycle": changed(nodes=[{"name": "wall", "mesh": 0, "children": [1]}, {"children": [0]}]),
    "cycle beside the scene": changed(nodes=[{"name": "wall", "mesh": 0}, {"children": [2]},
                                             {"children": [1]}]),
    "node in itself": changed(nodes=[{"name": "wall", "mesh": 0, "children": [0]}]),
    "shared child": changed(nodes=[{"name": "wall", "mesh": 0, "children": [2]},
                                   {"children": [2]}, {}]),
    "child twice": changed(nodes=[{"name": "wall", "mesh": 0, "children": [1, 1]}, {}]),
    "child beyond": changed(nodes=[{"name": "wall", "mesh": 0, "children": [7]}]),
    "child negative": changed(nodes=[{"name": "wall", "mesh": 0, "children": [-1]}]),
    "mesh beyond": changed(nodes=[{"name": "wall", "mesh": 7}]),
    "no node of that name": changed(nodes=[{"name": "door", "mesh": 0}]),
    "material beyond": with_primitive(material=3),
    "indices beyond": with_primitive(indices=9), "positions beyond": with_primitive(
        attributes={"POSITION": 9}), "no positions": with_primitive(attributes={}),
    "lines": with_primitive(mode=1), "strip": with_primitive(mode=5),
    "count beyond": with_accessor(count=4), "count huge": with_accessor(count=2**31 - 1),
    "count overflowing": with_accessor(count=2**62), "count 0": with_accessor(count=0),
    "count negative": with_accessor(count=-3),
    "offset beyond": with_accessor(byteOffset=12), "offset huge": with_accessor(byteOffset=2**63),
    "component unknown": with_accessor(componentType=9999), "type unknown": with_accessor(
        type="MAT9"), "matrix": with_accessor(type="MAT4"),
    "view beyond": with_accessor(bufferView=7), "no view": changed(accessors=[
        {"count": 3, "type": "VEC3", "componentType": 5126}, triangle()[0]["accessors"][1]]),
    "sparse": with_accessor(sparse={"count": 1, "indices": {"bufferView": 1,
                                                            "componentType": 5123},
                                    "values": {"bufferView": 0}}),
    "view past the buffer": with_view(byteLength=99), "view of another buffer": with_view(buffer=3),
    "view offset huge": with_view(byteOffset=2**64 - 8),
    "stride too small": with_view(byteStride=4),
    "stride huge": with_view(byteStride=252),
    "buffer longer than there is": changed(buffers=[{"byteLength": 2**31 - 1}]),
    "buffer of a file": changed(buffers=[{"byteLength": 44, "uri": "/etc/passwd"}]),
    "buffer of a URL": changed(buffers=[{"byteLength": 44, "uri": "http://127.0.0.1:9/x"}]),
    "required extension": changed(extensionsRequired=["KHR_draco_mesh_compression"],
                                  extensionsUsed=["KHR_draco_mesh_compression"]),
    "index beyond the last vertex": glb(triangle()[0], BINARY[:36] + struct.pack("<4H", 0, 1, 3,
                                                                                0)),
    "not a number": glb(triangle()[0], struct.pack("<f", float("nan")) + BINARY[4:]),
    "infinite": glb(triangle()[0], struct.pack("<f", float("inf")) + BINARY[4:]),
    "no whole triangle": changed(accessors=[triangle()[0]["accessors"][0],
                                            accessor(1, 2, "SCALAR", 5123)]),
}


@pytest.fixture(scope="module")
def own_server(tmp_path_factory):
    """A server whose store only these tests touch."""
    from conftest import Server
    server = Server(tmp_path_factory.mktemp("glb") / "data").start()
    yield server
    server.kill()


@pytest.mark.parametrize("name", BROKEN_GLBS)
def test_a_broken_glb_is_refused_and_nothing_of_it_stays(own_server, name):
    server = own_server
    before = server.get("/v1/examples").json()
    files = files_of(server, "artifacts", "tmp")
    example = with_meshes(BROKEN_GLBS[name])
    problem = assert_problem(upload(server, example), 422, instance="/v1/examples")
    places = pointers(problem)
    assert places and all(resolves(example, place) for place in places)
    assert "/pieces/2/mesh" in places if name == "no node of that name" else "/meshes" in places
    for word in ("assert", "std::", "exception", "tinygltf"):
        assert word not in json.dumps(problem), problem
    assert server.get("/v1/examples").json() == before
    assert files_of(server, "artifacts", "tmp") == files


def test_every_cut_of_a_glb_is_refused(own_server):
    for length in range(0, len(GOOD_GLB), 7):
        assert_problem(upload(own_server, with_meshes(GOOD_GLB[:length])), 422)
    assert not files_of(own_server, "artifacts", "tmp")


def test_no_flipped_byte_of_a_glb_harms_the_server(own_server):
    """Whatever a changed byte means: taken or refused, and the server goes on."""
    for place in range(0, len(GOOD_GLB), 5):
        content = bytearray(GOOD_GLB)
        content[place] ^= 0xFF
        answer = upload(own_server, with_meshes(bytes(content)))
        assert answer.status in (201, 422), (place, answer.body)
        if answer.status == 201:
            assert own_server.get(answer.json()["urls"]["pieces"]).status == 200
            own_server.request("DELETE", answer.json()["urls"]["self"])
    assert own_server.get("/healthz").status == 200


def test_a_glb_may_be_said_to_be_an_octet_stream(server, uploaded):
    example = {**with_meshes(GOOD_GLB), "meshes": data_uri(GOOD_GLB, "application/octet-stream")}
    assert uploaded(example).status == 201

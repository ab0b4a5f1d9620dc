"""Every kind of glTF the service makes: valid to the Khronos validator without a warning, drawn by
three.js as it should be, and equal to the label grid piece by piece."""

import collections
import json
import math
import pathlib
import shutil
import subprocess

import pytest

from conftest import Server
from glb_file import INSTANCING, GlbFile
from test_continuous import make, textured_hut
from websocket_client import GLB, GLB_WHOLE, StateFrame, WebSocketClient
from workload import YARD, submit

TOOLS = pathlib.Path(__file__).resolve().parent / "gltf"
PROFILES = ("nodes", "instanced", "merged")


@pytest.fixture(scope="session")
def tools():
    """The folder of the node scripts, with what they need."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        pytest.skip("node and npm are not installed")
    installed = TOOLS / "node_modules"
    if not all((installed / name).exists() for name in ("three", "gltf-validator", "meshoptimizer")):
        subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=TOOLS,
                       check=True, timeout=300, capture_output=True)
    return TOOLS


class Source:
    """A finished job with its example, and the files that are made of both."""

    def __init__(self, server, name, example, size, parameters):
        self.name = name
        self.job = server.wait(server.submit(size, example=example, parameters=parameters)["id"])
        assert self.job["state"] == "succeeded", self.job["error"]
        path = f"/v1/jobs/{self.job['id']}"
        self.labels = server.get(f"{path}/labels.json").json()
        self.files = {f"model, {profile}": _glb(server, f"{path}/model.glb?profile={profile}")
                      for profile in PROFILES}
        self.files["preview"] = _glb(server, f"{path}/preview.glb")
        if isinstance(example, str):
            self.example = server.get(f"/v1/examples/{example}").json()
        else:
            uploaded = server.request("POST", "/v1/examples", example).json()
            self.example = server.get(f"/v1/examples/{uploaded['id']}").json()
        path = f"/v1/examples/{self.example['id']}"
        self.files["example"] = _glb(server, f"{path}/model.glb")
        self.files["pieces"] = _glb(server, f"{path}/pieces.glb")
        if not isinstance(example, str):
            assert server.request("DELETE", path).status == 204

    def glb(self, name):
        return GlbFile(self.files[name])

    def drawn_pieces(self):
        """Names of the pieces that have something to draw, by the sheet of pieces."""
        sheet = self.glb("pieces")
        return {node["name"] for node in sheet.nodes() if "mesh" in node}

    def turns_of(self, piece):
        return {each["name"]: each.get("turns", 0) for each in self.example["pieces"]}[piece]

    def cells(self):
        """(x, y, z, piece) of every cell that is drawn."""
        width, height, depth = self.labels["size"]
        drawn = self.drawn_pieces()
        for y in range(height):
            for z in range(depth):
                for x in range(width):
                    label = self.labels["cells"][x + width * (z + depth * y)]
                    piece = self.labels["pieces"][label]
                    if piece in drawn:
                        yield x, y, z, piece


def _glb(server, path):
    answer = server.get(path)
    assert answer.status == 200, answer.body
    assert answer.headers["content-type"] == "model/gltf-binary"
    return answer.body


@pytest.fixture(scope="module")
def sources(server):
    """One model of an example with turned pieces, and one of each example that is built in."""
    found = [Source(server, "yard", YARD, (37, 5, 19), {"weights": "uniform"})]
    for example in server.get("/v1/examples").json()["items"]:
        if example["built_in"] and example["kind"] == "discrete":
            found.append(Source(server, example["id"], example["id"], (18, 8, 20), {}))
    return found


def _frames(server, job):
    with WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream?partial=glb") as client:
        return [StateFrame(message) for message in client.messages()
                if isinstance(message, bytes)]


@pytest.fixture(scope="module")
def frames(server):
    """The GLB frames of a job: of regions from its start, and a whole state."""
    found = _frames(server, submit(server, {"example": YARD, "size": (30, 5, 30), "parameters": {
        "weights": "uniform"}}))
    assert len(found) > 10
    return found


@pytest.fixture(scope="module")
def solid_frames(server):
    """Those of jobs of solids, whose blocks cut through faces and leave materials out."""
    found = {}
    for name, size in (("houses", (30, 8, 30)), ("roads", (60, 6, 60)), ("domes", (20, 9, 20)),
                       ("skyscrapers", (24, 10, 24))):
        job = server.submit(size, solver="continuous", example=name, seed=1)
        found[name] = _frames(server, job)
        assert len(found[name]) > 5
        assert server.wait(job["id"])["state"] == "succeeded"
    return found


@pytest.fixture(scope="module")
def whole_frame(restarting_server):
    """The whole state that a client gets of a job that ended before a restart."""
    server = restarting_server
    job = server.wait(submit(server, {"example": YARD, "size": (30, 5, 30), "parameters": {
        "weights": "uniform"}})["id"])
    model = _glb(server, f"/v1/jobs/{job['id']}/model.glb")
    server.stop()
    server.start()
    with WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream?partial=glb") as client:
        found = [StateFrame(message) for message in client.messages()
                 if isinstance(message, bytes)]
    assert [frame.kind for frame in found] == [GLB_WHOLE]
    return found[0], model


@pytest.fixture(scope="module")
def restarting_server(tmp_path_factory):
    server = Server(tmp_path_factory.mktemp("modelsynth-test") / "data").start()
    yield server
    server.kill()


@pytest.fixture(scope="module")
def files(sources, frames, solid_frames, whole_frame, server, tmp_path_factory):
    """Every kind of file on disk, path by name."""
    contents = {f"{source.name}: {name}": data for source in sources
                for name, data in source.files.items()}
    for name, found in {"yard": frames, **solid_frames}.items():
        for frame in found:
            contents[f"frame of event {frame.seq} of {name}"] = frame.payload
    contents["frame of the whole"] = whole_frame[0].payload
    # A model of nothing at all is a file too.
    nothing = {"kind": "discrete", "name": "nothing", "pieces": [{"name": "air"}],
               "size": [2, 2, 2], "cells": [0] * 8, "empty": "air"}
    empty = server.wait(server.submit((4, 2, 4), example=nothing)["id"])
    for profile in PROFILES:
        contents[f"nothing: model, {profile}"] = _glb(
            server, f"/v1/jobs/{empty['id']}/model.glb?profile={profile}")
    directory = tmp_path_factory.mktemp("glb")
    paths = {}
    for index, (name, data) in enumerate(contents.items()):
        paths[name] = directory / f"{index}.glb"
        paths[name].write_bytes(data)
    return paths


def run_tool(tools, script, files):
    """What a node script prints of the files, by name."""
    done = subprocess.run(["node", tools / script, *files.values()], capture_output=True,
                          text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    by_path = json.loads(done.stdout)
    return {name: by_path[str(path)] for name, path in files.items()}


@pytest.fixture(scope="module")
def in_three(tools, files):
    return run_tool(tools, "load_three.mjs", files)


# --- the judgement of others


def test_the_khronos_validator_finds_no_error_and_no_warning(tools, files):
    reports = run_tool(tools, "validate.mjs", files)
    assert len(reports) == len(files) > 20
    bad = {name: report["messages"] for name, report in reports.items()
           if report["errors"] or report["warnings"]}
    assert bad == {}


def test_the_khronos_validator_finds_nothing_wrong_with_textures(tools, server, tmp_path):
    job = make(server, example=textured_hut())
    files = {}
    for profile in PROFILES:
        files[profile] = tmp_path / f"{profile}.glb"
        files[profile].write_bytes(_glb(server, f"/v1/jobs/{job['id']}/model.glb?profile={profile}"))
        assert GlbFile(files[profile].read_bytes()).json["images"]
    for report in run_tool(tools, "validate.mjs", files).values():
        assert (report["errors"], report["warnings"]) == (0, 0), report["messages"]


def test_the_validator_of_these_tests_finds_a_fault_that_is_there(tools, files, tmp_path):
    data = bytearray(next(iter(files.values())).read_bytes())
    at = data.index(b'"componentType":5126')
    data[at:at + 20] = b'"componentType":5121'
    broken = tmp_path / "broken.glb"
    broken.write_bytes(data)
    assert run_tool(tools, "validate.mjs", {"broken": broken})["broken"]["errors"] > 0


def test_three_draws_every_mesh_of_every_file(in_three, files):
    for name, path in files.items():
        glb = GlbFile(path.read_bytes())
        placed = glb.placed()
        expected = sum(len(glb.meshes()[each.mesh]["primitives"]) for each in placed)
        assert len(in_three[name]["instances"]) == expected, name
        triangles = sum(glb.triangle_count(each.mesh) for each in placed)
        assert in_three[name]["triangles"] == triangles, name


def test_three_draws_instanced_models_as_instanced_meshes_at_the_same_places(in_three, sources):
    for source in sources:
        nodes = in_three[f"{source.name}: model, nodes"]
        instanced = in_three[f"{source.name}: model, instanced"]
        assert nodes["instanced"] == 0
        assert instanced["instanced"] == instanced["meshes"] > 0
        assert instanced["meshes"] < nodes["meshes"] / 2
        assert instanced["triangles"] == nodes["triangles"]

        def places(found):
            return collections.Counter(
                (round(x, 3), round(y, 3), round(z, 3), turns)
                for x, y, z, turns in found["instances"])

        assert places(instanced) == places(nodes)


def test_three_draws_merged_models_with_as_many_triangles_and_few_meshes(in_three, sources):
    for source in sources:
        nodes = in_three[f"{source.name}: model, nodes"]
        merged = in_three[f"{source.name}: model, merged"]
        assert merged["triangles"] == nodes["triangles"]
        assert merged["meshes"] < nodes["meshes"] / 4


# --- our own


def test_the_default_profile_is_nodes(server, sources):
    for source in sources:
        default = server.get(f"/v1/jobs/{source.job['id']}/model.glb").body
        assert default == source.files["model, nodes"]
        assert len(default) == source.job["result"]["bytes"]


def test_nodes_is_core_gltf_with_one_node_a_piece(sources):
    for source in sources:
        glb = source.glb("model, nodes")
        assert "extensionsUsed" not in glb.json and "extensionsRequired" not in glb.json
        pieces = [node["extras"]["piece"] for node, _, _ in glb.world_nodes() if "mesh" in node]
        expected = collections.Counter(piece for *_, piece in source.cells())
        assert collections.Counter(pieces) == expected
        assert len(expected) > 1


def test_nodes_agrees_with_the_label_grid_cell_by_cell(sources):
    for source in sources:
        cell = source.example["cell"]
        found = {}
        for placed in source.glb("model, nodes").placed():
            # A mesh's origin is in its cell, on the floor or above.
            x, y, z = (int((part + 1e-4) // extent)
                       for part, extent in zip(placed.position, cell))
            assert (x, y, z) not in found
            found[x, y, z] = (placed.name, placed.turns)
        expected = {(x, y, z): (piece, source.turns_of(piece))
                    for x, y, z, piece in source.cells()}
        assert found == expected


def test_the_yard_has_pieces_of_every_turn(sources):
    yard = sources[0].glb("model, nodes").placed()
    assert {placed.turns for placed in yard} == {0, 1, 2, 3}


def test_instanced_requires_its_extension_and_only_that(sources):
    for source in sources:
        glb = source.glb("model, instanced")
        assert glb.json["extensionsUsed"] == [INSTANCING]
        assert glb.json["extensionsRequired"] == [INSTANCING]


def test_instanced_places_the_pieces_where_nodes_does(sources):
    for source in sources:
        nodes, instanced = (source.glb(f"model, {profile}").placed()
                            for profile in ("nodes", "instanced"))
        assert len(nodes) == len(instanced) > 0
        keys = collections.Counter(placed.key() for placed in instanced)
        assert keys == collections.Counter(placed.key() for placed in nodes)


def test_instanced_draws_each_piece_with_the_mesh_that_nodes_draws_it_with(sources):
    for source in sources:
        shapes = []
        for profile in ("nodes", "instanced"):
            glb = source.glb(f"model, {profile}")
            shapes.append({placed.name: glb.meshes()[placed.mesh]["name"]
                           for placed in glb.placed()})
        assert shapes[0] == shapes[1]


def test_instance_data_is_float_and_in_a_view_without_a_target(sources):
    for source in sources:
        glb = source.glb("model, instanced")
        count = 0
        for node in glb.nodes():
            for index in node.get("extensions", {}).get(INSTANCING, {}).get(
                    "attributes", {}).values():
                accessor = glb.json["accessors"][index]
                assert (accessor["componentType"], accessor["type"]) == (5126, "VEC3")
                assert "target" not in glb.json["bufferViews"][accessor["bufferView"]]
                assert len(glb.accessor(index)) == accessor["count"]
                count += 1
        assert count > 0


def test_instanced_is_smaller_than_nodes(sources):
    for source in sources:
        assert len(source.files["model, instanced"]) < len(source.files["model, nodes"])


def test_merged_is_core_gltf(sources):
    for source in sources:
        assert "extensionsUsed" not in source.glb("model, merged").json
        assert "extensionsRequired" not in source.glb("model, merged").json


def test_merged_has_the_points_of_the_placed_pieces(sources):
    # Of the yard only: the pieces that are built in have too many points to compare them all.
    nodes, merged = (sources[0].glb(f"model, {profile}") for profile in ("nodes", "merged"))
    counted = []
    for glb in (nodes, merged):
        shapes = [glb.mesh_points(mesh) for mesh in range(len(glb.meshes()))]
        counted.append(collections.Counter(
            _world(placed, point) for placed in glb.placed() for point in shapes[placed.mesh]))
    assert sum(counted[0].values()) > 10000
    assert counted[0] == counted[1]


def _world(placed, point):
    x, y, z = [[point[0], point[1], point[2]], [point[2], point[1], -point[0]],
               [-point[0], point[1], -point[2]], [-point[2], point[1], point[0]]][placed.turns]
    # In centimetres, cut where none of the yard's points lies: they are whole or half ones.
    return tuple(math.floor((a + b) * 100 + 0.25) for a, b in zip((x, y, z), placed.position))


def test_a_model_lies_within_the_world_box(sources):
    for source in sources:
        size = [cells * extent for cells, extent in
                zip(source.labels["size"], source.example["cell"])]
        for profile in ("nodes", "instanced"):
            for placed in source.glb(f"model, {profile}").placed():
                assert all(0 <= part <= extent for part, extent in zip(placed.position, size))
        merged = source.glb("model, merged")
        slack = max(source.example["cell"])  # an eave may stand over
        for mesh in merged.meshes():
            for primitive in mesh["primitives"]:
                box = merged.json["accessors"][primitive["attributes"]["POSITION"]]
                assert all(part >= -slack for part in box["min"])
                assert all(part <= extent + slack for part, extent in zip(box["max"], size))


def test_large_models_are_grouped_so_that_viewers_can_cull(sources):
    for source in sources:
        for profile in PROFILES:
            glb = source.glb(f"model, {profile}")
            roots = glb.json["scenes"][0]["nodes"]
            assert 1 < len(roots) <= 16


def test_the_preview_of_a_finished_job_shows_the_finished_model(sources):
    for source in sources:
        preview = collections.Counter(each.key() for each in source.glb("preview").placed())
        model = collections.Counter(each.key() for each in source.glb("model, nodes").placed())
        assert preview == model


def test_pieces_has_one_node_per_label_named_as_the_piece(sources):
    for source in sources:
        glb = source.glb("pieces")
        names = [node["name"] for node, _, _ in glb.world_nodes() if "name" in node]
        assert names == [piece["name"] for piece in source.example["pieces"]]
        assert source.labels["pieces"] == names


def test_pieces_carries_the_turn_and_the_mesh_of_each_piece(sources):
    for source in sources:
        glb, model = source.glb("pieces"), source.glb("model, nodes")
        turns = {node["name"]: turn for node, _, turn in glb.world_nodes()}
        meshes = {placed.name: glb.meshes()[placed.mesh]["name"] for placed in glb.placed()}
        for placed in model.placed():
            assert turns[placed.name] == placed.turns
            assert meshes[placed.name] == model.meshes()[placed.mesh]["name"]


def test_the_example_shows_its_own_cells(sources):
    for source in sources:
        cells = source.example["cells"]
        pieces = [piece["name"] for piece in source.example["pieces"]]
        drawn = source.drawn_pieces()
        expected = collections.Counter(pieces[label] for label in cells
                                       if pieces[label] in drawn)
        found = collections.Counter(each.name for each in source.glb("example").placed())
        assert found == expected


def test_a_glb_frame_holds_the_pieces_of_its_region_in_the_frame_of_the_model(frames):
    for frame in frames:
        if frame.kind == GLB:
            for placed in GlbFile(frame.payload).placed():
                for axis in range(3):
                    at = placed.position[axis] / YARD["cell"][axis]
                    assert frame.min[axis] <= at <= frame.max[axis]


def test_the_frame_of_the_whole_shows_the_finished_model(whole_frame):
    frame, model = whole_frame
    assert frame.min == [0, 0, 0] and frame.max == [30, 5, 30]
    whole = collections.Counter(each.key() for each in GlbFile(frame.payload).placed())
    assert whole == collections.Counter(each.key() for each in GlbFile(model).placed())

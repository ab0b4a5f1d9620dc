"""Reads the container of a GLB and as much of glTF as the tests need, to the letter of the
specification and with nothing of the service's own code."""

import json
import struct

_COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_HALF = 0.7071067811865476
INSTANCING = "EXT_mesh_gpu_instancing"


class Placed:
    """A mesh at a place: position of its origin and quarter turns about y."""

    def __init__(self, mesh, position, turns, name):
        self.mesh = mesh
        self.position = position
        self.turns = turns
        self.name = name

    def key(self):
        return (self.name, self.turns, *(round(part, 4) for part in self.position))


class GlbFile:
    """A binary glTF file; the constructor checks the container."""

    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        assert magic == b"glTF" and version == 2
        assert length == len(data), "the header's length is not the file's"
        assert length % 4 == 0
        chunks, at = [], 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            assert size % 4 == 0, "a chunk is not aligned to four bytes"
            assert at + 8 + size <= length
            chunks.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        assert at == length
        assert [kind for kind, _ in chunks] in ([b"JSON"], [b"JSON", b"BIN\0"])
        self.json = json.loads(chunks[0][1])
        self.binary = chunks[1][1] if len(chunks) > 1 else b""
        assert self.json["asset"]["version"] == "2.0"

    def meshes(self):
        return self.json.get("meshes", [])

    def nodes(self):
        return self.json.get("nodes", [])

    def accessor(self, index):
        """The values of an accessor as tuples; min and max must be the values' own."""
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        letter = _COMPONENTS[accessor["componentType"]]
        width = _WIDTHS[accessor["type"]]
        size = struct.calcsize("<" + letter) * width
        stride = view.get("byteStride", size)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = [struct.unpack_from(f"<{width}{letter}", self.binary, start + i * stride)
                  for i in range(accessor["count"])]
        if "min" in accessor:
            assert list(map(min, zip(*values))) == accessor["min"]
            assert list(map(max, zip(*values))) == accessor["max"]
        return values

    def world_nodes(self):
        """(node, position, quarter turns) of every node of the scene, parents applied."""
        found = []
        seen = set()

        def visit(index, position, turns):
            assert index not in seen, "a node has two parents"
            seen.add(index)
            node = self.nodes()[index]
            assert "matrix" not in node and "scale" not in node
            offset = turned(node.get("translation", [0, 0, 0]), turns)
            place = [a + b for a, b in zip(position, offset)]
            turns = (turns + quarter_turns(node.get("rotation", [0, 0, 0, 1]))) % 4
            found.append((node, place, turns))
            for child in node.get("children", []):
                visit(child, place, turns)

        for root in self.json["scenes"][self.json.get("scene", 0)].get("nodes", []):
            visit(root, [0, 0, 0], 0)
        assert len(seen) == len(self.nodes()), "a node is in no scene"
        return found

    def placed(self):
        """Every mesh that a reader draws, instances one by one."""
        found = []
        for node, position, turns in self.world_nodes():
            if "mesh" not in node:
                continue
            name = node.get("extras", {}).get("piece", node.get("name"))
            instancing = node.get("extensions", {}).get(INSTANCING)
            if instancing is None:
                found.append(Placed(node["mesh"], position, turns, name))
                continue
            attributes = instancing["attributes"]
            counts = {self.json["accessors"][index]["count"] for index in attributes.values()}
            assert len(counts) == 1, "the instance attributes have different counts"
            offsets = self.accessor(attributes["TRANSLATION"])
            rotations = [(0, 0, 0, 1)] * len(offsets)
            if "ROTATION" in attributes:
                rotations = self.accessor(attributes["ROTATION"])
            for offset, rotation in zip(offsets, rotations):
                place = [a + b for a, b in zip(position, turned(offset, turns))]
                found.append(Placed(
                    node["mesh"], place, (turns + quarter_turns(rotation)) % 4, name))
        return found

    def triangle_count(self, mesh):
        return sum(self.json["accessors"][primitive["indices"]]["count"] // 3
                   for primitive in self.meshes()[mesh]["primitives"])

    def mesh_points(self, mesh):
        return [point for primitive in self.meshes()[mesh]["primitives"]
                for point in self.accessor(primitive["attributes"]["POSITION"])]


def turned(vector, turns):
    """The vector after quarter turns about y, counter-clockwise seen from above."""
    x, y, z = vector
    return [[x, y, z], [z, y, -x], [-x, y, -z], [-z, y, x]][turns % 4]


def quarter_turns(rotation):
    """Of a quaternion about y."""
    x, y, z, w = rotation
    assert abs(x) < 1e-6 and abs(z) < 1e-6, "a turn about another axis than y"
    for turns, (expected_y, expected_w) in enumerate([(0, 1), (_HALF, _HALF), (1, 0),
                                                      (_HALF, -_HALF)]):
        if abs(abs(y * expected_y + w * expected_w) - 1) < 1e-5:
            return turns
    raise AssertionError(f"{rotation} is no quarter turn")

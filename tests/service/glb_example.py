"""Writes an example of solids (as JSON) as a GLB whose nodes, materials and scene say the same in
their extras."""

import json
import struct

SCENE_FIELDS = ("name", "title", "description", "spacing", "size", "density", "bounds",
                "dimensions", "connected", "constraints")


class Writer:
    def __init__(self):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "accessors": [], "bufferViews": [],
                     "materials": []}

    def node(self, name, material, vertices, faces, **extras):
        """Faces as fans of triangles; the points are numbered as the vertices are."""
        triangles = [(face[0], b, c) for face in faces for b, c in zip(face[1:], face[2:])]
        data = [struct.pack("<3f", *vertex) for vertex in vertices]
        columns = list(zip(*(struct.unpack("<3f", one) for one in data)))
        mesh = self._add("meshes", {"primitives": [{
            "attributes": {"POSITION": self._accessor(b"".join(data), 5126, "VEC3", len(data), {
                "min": [min(column) for column in columns],
                "max": [max(column) for column in columns]})},
            "indices": self._accessor(b"".join(struct.pack("<3I", *one) for one in triangles),
                                      5125, "SCALAR", 3 * len(triangles), {}),
            "material": material}]})
        node = {"name": name, "mesh": mesh}
        if extras:
            node["extras"] = extras
        self.json["scenes"][0]["nodes"].append(self._add("nodes", node))

    def material(self, described, **extras):
        def of(name, otherwise):
            return described.get(name, otherwise)
        material = {"name": described["name"], "emissiveFactor": of("emissive", [0, 0, 0]),
                    "pbrMetallicRoughness": {
                        "baseColorFactor": [*of("color", [1, 1, 1]), 1],
                        "metallicFactor": of("metallic", 0),
                        "roughnessFactor": of("roughness", 0.9)}}
        if extras:
            material["extras"] = extras
        return self._add("materials", material)

    def bytes(self):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def _add(self, kind, entry):
        self.json[kind].append(entry)
        return len(self.json[kind]) - 1

    def _accessor(self, data, component, kind, count, more):
        view = self._add("bufferViews", {"buffer": 0, "byteOffset": len(self.binary),
                                         "byteLength": len(data)})
        self.binary += data
        return self._add("accessors", {"bufferView": view, "componentType": component,
                                       "type": kind, "count": count, **more})


def in_file_order(example):
    """The same example as it comes out of a GLB: objects in the order of their solids, places in
    single precision."""
    used = [example["ground"]] if "ground" in example else []
    for solid in example["polyhedra"]:
        if solid["object"] not in used:
            used.append(solid["object"])
    by_name = {one["name"]: one for one in example["objects"]}
    assert set(used) == set(by_name), "an object without solids"
    return _single({**example, "objects": [by_name[name] for name in used]})


def _single(value, is_place=False):
    if isinstance(value, dict):
        return {key: _single(one, key in ("vertices", "profile")) for key, one in value.items()}
    if isinstance(value, list):
        return [_single(one, is_place) for one in value]
    return struct.unpack("<f", struct.pack("<f", value))[0] if is_place else value


def as_glb(example, typed=False):
    """`typed`: lists and objects as one types them in an editor, as texts."""
    def extra(value, are_words=False):
        if not typed or not isinstance(value, (list, dict)):
            return value
        is_plain = are_words and all(isinstance(one, str) for one in value)
        return " ".join(value) if is_plain else json.dumps(value)

    def some(described, *names):
        return {name: extra(described[name], True) for name in names if name in described}

    writer = Writer()
    writer.json["scenes"][0]["extras"] = {
        field: extra(example[field]) for field in SCENE_FIELDS if field in example}
    materials = {one["name"]: writer.material(one, **some(one, "weight"))
                 for one in example["objects"]}
    if "ground" in example:
        writer.node("meadow", materials[example["ground"]],
                    [[-9, 0, -9], [-9, 0, 9], [9, 0, 9], [9, 0, -9]], [[0, 1, 2, 3]], ground=True)
    for solid in example["polyhedra"]:
        writer.node(solid.get("name", ""), materials[solid["object"]], solid["vertices"],
                    solid["faces"])
    for one in example["objects"]:
        own = materials[one["name"]]
        if "shape" in one:
            writer.node("shape of " + one["name"], own, one["shape"]["vertices"],
                        one["shape"]["faces"], shape=one["name"],
                        **some(one["shape"], "smooth", "even"))
        for decoration in one.get("decorations", []):
            look = materials.get(decoration.get("material"), own)
            if "edges" in decoration:
                vertices = [[p, q, 0] for p, q in decoration["profile"]]
                faces = [list(range(len(vertices)))]
            else:
                vertices, faces = decoration["mesh"]["vertices"], decoration["mesh"]["faces"]
            writer.node("on " + one["name"], look, vertices, faces, decorates=one["name"],
                        **some(decoration, "edges", "corners", "turn", "turned"),
                        **some(decoration.get("mesh", {}), "smooth"))
    return writer.bytes()

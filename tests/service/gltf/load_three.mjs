// Loads the GLB files named on the command line with three's GLTFLoader, as a browser would, and
// prints, as one JSON object, what is drawn: path -> { meshes, instances: [[x, y, z, yaw], ...],
// triangles, geometry }. `meshes` counts the objects; `instances` is the place of each mesh that is
// drawn in the world, instanced or not, with its turn about y in quarters; `geometry` is a SHA-256
// of the numbers of all vertices and triangles.

import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { MeshoptDecoder } from 'meshoptimizer/decoder';
import { Matrix4, Quaternion, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

globalThis.self ??= globalThis;

function placeOf(matrix) {
    const position = new Vector3();
    const rotation = new Quaternion();
    const scale = new Vector3();
    matrix.decompose(position, rotation, scale);
    const yaw = 2 * Math.atan2(rotation.y, rotation.w);
    const quarters = ((Math.round(yaw / (Math.PI / 2)) % 4) + 4) % 4;
    const stray = Math.max(Math.abs(rotation.x), Math.abs(rotation.z), Math.abs(scale.x - 1),
        Math.abs(scale.y - 1), Math.abs(scale.z - 1));
    if (stray > 1e-4) throw new Error('a mesh is scaled, or turned about another axis than y');
    return [position.x, position.y, position.z, quarters];
}

function addGeometry(hash, geometry) {
    const named = Object.entries(geometry.attributes).sort(([a], [b]) => (a < b ? -1 : 1));
    for (const [name, { array }] of [...named, ['index', geometry.index ?? { array: [] }]]) {
        hash.update(`${name} ${array.constructor.name} ${array.length};`);
        if (array.length > 0) {
            hash.update(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
        }
    }
}

function drawn(scene) {
    const found = { meshes: 0, instanced: 0, instances: [], triangles: 0 };
    const hash = createHash('sha256');
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
        if (!object.isMesh) return;
        found.meshes += 1;
        const { geometry } = object;
        addGeometry(hash, geometry);
        const triangles = (geometry.index ?? geometry.attributes.position).count / 3;
        const count = object.isInstancedMesh ? object.count : 1;
        found.instanced += object.isInstancedMesh ? 1 : 0;
        found.triangles += triangles * count;
        for (let i = 0; i < count; i += 1) {
            const matrix = new Matrix4();
            if (object.isInstancedMesh) object.getMatrixAt(i, matrix);
            found.instances.push(placeOf(matrix.premultiply(object.matrixWorld)));
        }
    });
    return { ...found, geometry: hash.digest('hex') };
}

const found = {};
for (const path of process.argv.slice(2)) {
    const bytes = await readFile(path);
    const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    const gltf = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).parseAsync(buffer, '');
    found[path] = drawn(gltf.scene);
}
console.log(JSON.stringify(found));

// Decodes the GLB files named on the command line as EXT_meshopt_compression says and prints, as
// one JSON object, what is in their buffer views: path -> [SHA-256 of each view's bytes]. Of files
// without the extension these are the bytes as they stand there.

import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { MeshoptDecoder } from 'meshoptimizer/decoder';

const kName = 'EXT_meshopt_compression';

function contentOf(view, binary) {
    const start = view.byteOffset ?? 0;
    const stored = binary.subarray(start, start + view.byteLength);
    const packed = view.extensions?.[kName];
    if (packed === undefined) {
        if (view.buffer !== 0) throw new Error('a plain view is not in the file');
        return stored;
    }
    const source = binary.subarray(packed.byteOffset ?? 0,
        (packed.byteOffset ?? 0) + packed.byteLength);
    const target = new Uint8Array(packed.count * packed.byteStride);
    if (target.length !== view.byteLength) throw new Error('a view is of another length');
    MeshoptDecoder.decodeGltfBuffer(target, packed.count, packed.byteStride, source, packed.mode,
        packed.filter);
    return target;
}

await MeshoptDecoder.ready;
const found = {};
for (const path of process.argv.slice(2)) {
    const bytes = new Uint8Array(await readFile(path));
    const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
    const document = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
    const binary = bytes.subarray(28 + length);
    found[path] = (document.bufferViews ?? []).map((view) =>
        createHash('sha256').update(contentOf(view, binary)).digest('hex'));
}
console.log(JSON.stringify(found));

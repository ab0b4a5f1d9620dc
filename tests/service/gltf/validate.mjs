// Validates the GLB files named on the command line with the Khronos validator and prints, as one
// JSON object, what it found of each: path -> { errors, warnings, messages }.

import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';

const found = {};
for (const path of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(path)), {
        format: 'glb',
        maxIssues: 100,
        writeTimestamp: false,
    });
    const { numErrors, numWarnings, messages } = report.issues;
    found[path] = {
        errors: numErrors,
        warnings: numWarnings,
        messages: messages.filter((message) => message.severity < 2),
    };
}
console.log(JSON.stringify(found));

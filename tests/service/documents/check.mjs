// Reads an OpenAPI and an AsyncAPI document, named on the command line, with the libraries that
// others use, and prints what these have to say, as two lists of texts in one JSON object.

import { readFile } from 'node:fs/promises';
import { createConfig, lintFromString } from '@redocly/openapi-core';
import { Parser } from '@asyncapi/parser';

const [openapiPath, asyncapiPath] = process.argv.slice(2);

// Matters of taste: `default` tells the errors that every operation has; kinds are told apart by a
// field that is required beside them; the examples are checked elsewhere, by a validator that
// knows if and then.
const config = await createConfig({
    extends: ['recommended'],
    rules: {
        'operation-4xx-response': 'off',
        'no-illogical-composition-keywords': 'off',
        'no-required-schema-properties-undefined': 'off',
        'no-invalid-media-type-examples': 'off',
    },
});
const problems = await lintFromString({
    source: await readFile(openapiPath, 'utf8'),
    absoluteRef: openapiPath,
    config,
});
const { document, diagnostics } = await new Parser().parse(await readFile(asyncapiPath, 'utf8'));
console.log(JSON.stringify({
    openapi: problems.map(({ ruleId, message, location }) =>
        `${ruleId}: ${message} ${location[0]?.pointer}`),
    // That there is a newer version of AsyncAPI is no fault.
    asyncapi: diagnostics.filter(({ code }) => code !== 'asyncapi-latest-version')
        .map(({ code, message, path }) => `${code}: ${message} ${path.join('/')}`)
        .concat(document ? [] : ['it cannot be read']),
}));

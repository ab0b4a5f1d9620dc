"""OpenAPI and AsyncAPI documents as judges: whether what a server sends is what they say."""

import copy
import datetime

import jsonschema

# On every answer, and told of once in the document's words.
ALWAYS = {"server", "x-content-type-options", "content-type", "content-length", "connection",
          "transfer-encoding", "content-encoding", "vary", "x-request-id", "date"}

FORMATS = jsonschema.FormatChecker(formats=())


@FORMATS.checks("date-time", raises=ValueError)
def _is_time(value):
    if isinstance(value, str):
        assert value.endswith("Z")
        datetime.datetime.fromisoformat(value[:-1])
    return True


def closed(node):
    """The document with every object closed: clients must expect new fields, but a test must not
    overlook one that nobody wrote down."""
    if isinstance(node, list):
        return [closed(item) for item in node]
    if not isinstance(node, dict):
        return node
    node = {name: closed(item) for name, item in node.items()}
    open_object = node.get("type") == "object" and isinstance(node.get("properties"), dict)
    if open_object and not {"additionalProperties", "unevaluatedProperties"} & set(node):
        node["unevaluatedProperties"] = False
    return node


class ApiDocument:
    """A document, and what can be asked of it."""

    def __init__(self, document):
        self.document = document
        self.closed = closed(copy.deepcopy(document))
        self.resolver = jsonschema.RefResolver.from_schema(self.closed)

    def resolved(self, node):
        while "$ref" in node:
            node = self.resolver.resolve(node["$ref"])[1]
        return node

    def at(self, *path):
        node = self.closed
        for part in path:
            node = self.resolved(node)[part]
        return self.resolved(node)

    def check(self, value, schema, what=""):
        """That a value is as a schema of the document says."""
        validator = jsonschema.Draft202012Validator(
            schema, resolver=self.resolver, format_checker=FORMATS)
        errors = sorted(validator.iter_errors(value), key=lambda error: len(error.absolute_path))
        assert not errors, (f"{what} at /{'/'.join(map(str, errors[0].absolute_path))}: "
                            f"{errors[0].message[:500]}")

    def references(self):
        """Every $ref of the document."""
        found = []

        def collect(node):
            if isinstance(node, dict):
                if isinstance(node.get("$ref"), str):
                    found.append(node["$ref"])
                for item in node.values():
                    collect(item)
            elif isinstance(node, list):
                for item in node:
                    collect(item)

        collect(self.document)
        return found

    # --- of OpenAPI

    def operations(self):
        """(method, path) of all operations, methods in upper case."""
        return {(method.upper(), path) for path, item in self.document["paths"].items()
                for method in item if method != "parameters"}

    def statuses(self, method, path):
        """The statuses that an operation names, as numbers."""
        responses = self.document["paths"][path][method.lower()]["responses"]
        return {int(status) for status in responses if status != "default"}

    def check_answer(self, method, path, answer):
        """That an answer is one that the operation names by its status, with the headers, the
        media type and the body that it says."""
        what = f"{method} {path}: {answer.status}"
        responses = self.at("paths", path, method.lower(), "responses")
        assert str(answer.status) in responses, f"{what} {answer.body[:300]}"
        response = self.resolved(responses[str(answer.status)])
        self._check_headers(response, answer.headers, what)
        if "content" not in response:
            assert answer.body == b"", what
            return
        media_type = answer.headers["content-type"].split(";")[0]
        content = response["content"].get(media_type, response["content"].get("*/*"))
        assert content is not None, f"{what} {media_type}"
        if media_type.endswith("json") and "*/*" not in response["content"]:
            self.check(answer.json(), content["schema"], what)

    def _check_headers(self, response, headers, what):
        named = {name.lower(): self.resolved(header)
                 for name, header in response.get("headers", {}).items()}
        for name, header in named.items():
            if name in headers:
                self.check(headers[name], header["schema"], f"{what} {name}")
            else:
                assert not header.get("required"), f"{what} lacks {name}"
        assert set(headers) <= set(named) | ALWAYS, f"{what} has {set(headers) - set(named)}"

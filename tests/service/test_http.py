"""What holds for every resource: paths, methods, media types, sizes, health, and schemas."""

import json

import jsonschema
import pytest

from checks import STRIPES, assert_problem, compact, job_request, short

GET_PATHS = ["/v1/jobs", "/v1/jobs/{job}", "/v1/jobs/{job}/model.glb",
             "/v1/jobs/{job}/preview.glb", "/v1/jobs/{job}/labels.json", "/v1/jobs/{job}/events",
             "/v1/examples", "/v1/examples/castle", "/v1/examples/castle/model.glb",
             "/v1/examples/castle/pieces.glb", "/v1/solvers", "/v1/solvers/discrete", "/healthz",
             "/readyz"]
ALLOWED = {path: {"GET", "HEAD"} for path in GET_PATHS}
ALLOWED["/v1/jobs"] |= {"POST"}
ALLOWED["/v1/jobs/{job}"] |= {"DELETE"}
ALLOWED["/v1/examples"] |= {"POST"}
ALLOWED["/v1/examples/castle"] |= {"DELETE"}
ALLOWED["/v1/jobs/{job}/cancel"] = {"POST"}
METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE", "BREW", "get"]


@pytest.fixture(scope="module")
def job_id(server):
    answer = server.request("POST", "/v1/jobs", job_request(), headers={"Prefer": "wait=60"})
    return answer.json()["id"]


# --- paths and methods

@pytest.mark.parametrize("path", [
    "/nope", "/v1", "/v1/", "/v2/jobs", "/v1/jobs/", "/v1//jobs", "//v1/jobs", "/V1/jobs",
    "/v1/Jobs", "/v1/jobs/x/y", "/v1/jobs/x/model.glb/", "/v1/jobs/x/model.gltf", "/v1/examples/",
    "/v1/solvers/", "/healthz/", "/healthz/x", "/problems", "/problems/",
    "/../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/v1/jobs%2Fx", "/favicon.ico", "/v1/jobs/x/..",
    "/.", "/x%ff",
])
@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "DELETE", "BREW"])
def test_an_unknown_path_is_not_found_whatever_the_method(server, path, method):
    answer = server.request(method, path)
    assert answer.status == 404
    if method != "HEAD":
        assert_problem(answer, 404, "not-found", path)


@pytest.mark.parametrize("path", ["/v1/solvers/quantum", "/problems/nope"])
def test_an_unknown_name_is_not_found(server, path):
    assert_problem(server.get(path), 404, "not-found", path)


@pytest.mark.parametrize(("method", "path"), [
    (method, path) for path in ALLOWED for method in METHODS if method not in ALLOWED[path]])
def test_a_wrong_method_is_told_which_are_right(server, job_id, path, method):
    path_of_job = path.replace("{job}", job_id)
    answer = server.request(method, path_of_job)
    assert_problem(answer, 405, "method-not-allowed", path_of_job)
    assert {name.strip() for name in answer.headers["allow"].split(",")} == ALLOWED[path]


@pytest.mark.parametrize("path", [path for path in GET_PATHS if not path.endswith("events")])
def test_head_is_get_without_the_body(server, job_id, path):
    path = path.replace("{job}", job_id)
    whole, head = server.get(path), server.request("HEAD", path)
    assert whole.status == head.status == 200
    assert head.body == b"" and whole.body
    assert head.headers["content-type"] == whole.headers["content-type"]
    if path != "/readyz":
        assert head.headers["content-length"] == str(len(whole.body))


@pytest.mark.parametrize("path", [
    "/openapi.json", "/asyncapi.json", "/metrics", "/", "/docs", "/v1/limits"])
def test_every_document_of_the_contract_is_served(server, path):
    assert server.get(path).status == 200


# --- problems

def test_every_problem_type_that_answers_name_is_a_page(server, job_id):
    types = {server.get(path).json()["type"] for path in
             ("/nope", "/v1/jobs?limit=0", "/v1/jobs?limit=x", "/v1/jobs/nope")}
    types.add(server.request("PUT", "/v1/jobs").json()["type"])
    types.add(server.request("POST", "/v1/jobs", b"{").json()["type"])
    types.add(server.request("DELETE", "/v1/examples/castle").json()["type"])
    for name in ("invalid-request", "contradiction", "gave-up", "deadline-exceeded", "too-large",
                 "queue-full", "not-finished"):
        types.add(f"/problems/{name}")
    assert len(types) >= 10
    for kind in types:
        page = server.get(kind)
        assert page.status == 200 and page.headers["content-type"].startswith("text/")
        assert len(page.body) > 20


def test_every_answer_forbids_guessing_its_media_type(server):
    for path in ("/healthz", "/nope", "/v1/examples/castle/model.glb"):
        assert server.get(path).headers["x-content-type-options"] == "nosniff"


# --- media types

@pytest.mark.parametrize("kind", [
    "application/json", "application/json; charset=utf-8", "APPLICATION/JSON",
    "application/json;charset=UTF-8", "application/json ; charset=utf-8", None])
@pytest.mark.parametrize("path", ["/v1/jobs", "/v1/examples"])
def test_json_is_taken_under_its_names(server, path, kind):
    answer = server.request("POST", path, b"[]", headers={"Content-Type": kind} if kind else {})
    assert_problem(answer, 422)


@pytest.mark.parametrize("kind", [
    "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
    "application/jsonx", "application/xml", "application/", "json", "text/json; application/json",
    "application/cbor", "*/*"])
@pytest.mark.parametrize("path", ["/v1/jobs", "/v1/examples"])
def test_another_media_type_is_refused(server, path, kind):
    answer = server.request("POST", path, compact(job_request()), headers={"Content-Type": kind})
    assert_problem(answer, 415, "unsupported-media-type", path)
    assert "application/json" in answer.headers.get("accept", "")


def test_an_example_may_be_uploaded_as_a_glb(server):
    answer = server.request("POST", "/v1/examples", b"glTF",
                            headers={"Content-Type": "model/gltf-binary"})
    assert answer.status != 415


# --- sizes

@pytest.fixture(scope="module")
def narrow(tmp_path_factory):
    """A server that takes small bodies only."""
    from conftest import Server
    server = Server(tmp_path_factory.mktemp("narrow") / "data", "--job-body-bytes-max", 2048,
                    "--upload-body-bytes-max", 4096).start()
    yield server
    server.kill()


def padded(document, size):
    body = compact(document)
    return body + b" " * (size - len(body))


def in_chunks(body, size=500):
    for start in range(0, len(body), size):
        yield body[start:start + size]


@pytest.mark.parametrize("chunked", [False, True], ids=["length", "chunked"])
@pytest.mark.parametrize(("path", "document", "limit", "status"), [
    ("/v1/jobs", job_request(), 2048, 202), ("/v1/examples", STRIPES, 4096, 201)])
def test_the_limit_of_a_body_holds_at_its_edge(narrow, path, document, limit, status, chunked):
    for size, expected in ((limit - 1, status), (limit, status), (limit + 1, 413),
                           (limit + 1000, 413), (limit * 20, 413)):
        body = padded(document, size)
        answer = narrow.request("POST", path, in_chunks(body) if chunked else body,
                                headers={"Content-Type": "application/json"})
        assert answer.status == expected, size
        if expected == 413:
            problem = assert_problem(answer, 413, "body-too-large", path)
            assert str(limit) in problem["detail"]
    assert narrow.get("/healthz").status == 200


@pytest.mark.parametrize("path", ["/v1/jobs/x/cancel", "/healthz", "/nope"])
def test_a_body_that_nobody_wants_does_no_harm(server, path):
    for size in (1, 100, 1_000_000):
        answer = server.request("POST" if "cancel" in path else "GET", path, b"x" * size)
        assert answer.status in (200, 404, 413)


# --- health

@pytest.mark.parametrize("path", ["/healthz", "/readyz"])
def test_a_server_that_has_room_is_alive_and_ready(server, path):
    answer = server.get(path)
    assert answer.status == 200 and answer.json()


# --- solvers and their schema

@pytest.fixture(scope="module")
def schema(server):
    return server.get("/v1/solvers/discrete").json()["parameters"]


def test_the_list_of_solvers_has_the_discrete_one(server):
    items = server.get("/v1/solvers").json()["items"]
    assert server.get("/v1/solvers/discrete").json() in items


def test_the_schema_of_the_parameters_is_json_schema_2020_12(schema):
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["additionalProperties"] is False
    assert {"size", "blocks", "boundary", "order", "weights", "constraints"} <= \
        set(schema["properties"])


def test_the_defaults_of_the_schema_are_those_that_the_server_fills_in(server, schema):
    request = job_request()
    request["parameters"] = {"size": [6, 20, 4], "boundary": {"top": "free"}}
    answer = server.request("POST", "/v1/jobs", request)
    echo = answer.json()["request"]["parameters"]
    server.request("DELETE", answer.headers["location"])
    for name in ("order", "constraints"):
        assert echo[name] == schema["properties"][name]["default"]
    blocks = next(option for option in schema["properties"]["blocks"]["oneOf"]
                  if option["type"] == "object")
    assert echo["blocks"] == {name: part["default"] for name, part in
                              blocks["properties"].items()}
    jsonschema.Draft202012Validator(schema).validate(echo)


FIXED = {"kind": "fixed", "pieces": ["red"]}

PARAMETERS = [
    {}, None, [], "x", 3,
    {"size": [6, 2, 4]}, {"size": [6.0, 2, 4]}, {"size": [1, 1, 1]}, {"size": [4096, 1, 1]},
    {"size": [4097, 1, 1]}, {"size": [0, 1, 1]}, {"size": [1, 1]}, {"size": [1, 1, 1, 1]},
    {"size": [1, 1, 1.5]}, {"size": [1, 1, "1"]}, {"size": [1, 1, True]}, {"size": None},
    {"size": {}}, {"Size": [1, 1, 1]},
    {"blocks": None}, {"blocks": {}}, {"blocks": []}, {"blocks": 0}, {"blocks": True},
    {"blocks": {"size": [64, 64, 64]}}, {"blocks": {"size": [65, 1, 1]}},
    {"blocks": {"size": [1, 1, 1], "overlap": 0}}, {"blocks": {"size": 10}},
    {"blocks": {"overlap": 0}}, {"blocks": {"overlap": 0.95}}, {"blocks": {"overlap": 0.951}},
    {"blocks": {"overlap": -0.001}}, {"blocks": {"overlap": "0.5"}}, {"blocks": {"overlap": None}},
    {"blocks": {"passes": 1}}, {"blocks": {"passes": 100}}, {"blocks": {"passes": 101}},
    {"blocks": {"passes": 0}}, {"blocks": {"passes": 1.5}}, {"blocks": {"passes": 2.0}},
    {"blocks": {"attempts": 1}}, {"blocks": {"attempts": 1000}}, {"blocks": {"attempts": 1001}},
    {"blocks": {"attempts": False}}, {"blocks": {"stride": 1}},
    {"boundary": {}}, {"boundary": None}, {"boundary": []}, {"boundary": "free"},
    {"boundary": {"top": "free"}}, {"boundary": {"bottom": "example"}},
    {"boundary": {"top": "air"}},
    {"boundary": {"top": ["air"]}}, {"boundary": {"top": ["air", "air"]}},
    {"boundary": {"top": []}}, {"boundary": {"top": [1]}}, {"boundary": {"top": None}},
    {"boundary": {"up": "free"}}, {"boundary": {"west": "periodic", "east": "periodic"}},
    {"boundary": {"north": ["air", "red", "green", "blue"], "south": "free"}},
    {"order": "scan"}, {"order": "min_entropy"}, {"order": "random"}, {"order": "Scan"},
    {"order": ""}, {"order": None}, {"order": ["scan"]},
    {"weights": "uniform"}, {"weights": "example"}, {"weights": "other"}, {"weights": {}},
    {"weights": {"red": 0}}, {"weights": {"red": 1e6}}, {"weights": {"red": 1000001}},
    {"weights": {"red": -0.1}}, {"weights": {"red": None}}, {"weights": None}, {"weights": []},
    {"weights": 1},
    {"constraints": []}, {"constraints": None}, {"constraints": {}}, {"constraints": [FIXED]},
    {"constraints": [FIXED] * 1000}, {"constraints": [FIXED] * 1001}, {"constraints": [{}]},
    {"constraints": [None]}, {"constraints": [{**FIXED, "kind": "forbidden"}]},
    {"constraints": [{**FIXED, "kind": "Fixed"}]}, {"constraints": [{**FIXED, "pieces": []}]},
    {"constraints": [{**FIXED, "pieces": "red"}]}, {"constraints": [{"kind": "fixed"}]},
    {"constraints": [{**FIXED, "extra": 1}]},
    {"constraints": [{**FIXED, "box": {"min": [0, 0, 0], "max": [1, 1, 1]}}]},
    {"constraints": [{**FIXED, "box": {"min": [0, 0, 0]}}]},
    {"constraints": [{**FIXED, "box": {"min": [0, 0, 0], "max": [1, 1]}}]},
    {"constraints": [{**FIXED, "box": {"min": [0, -1, 0], "max": [1, 1, 1]}}]},
    {"constraints": [{**FIXED, "box": {"min": [0, 0, 0], "max": [1, 1, 1], "mid": 0}}]},
    {"constraints": [{**FIXED, "box": None}]},
    {"constraints": [{**FIXED, "cells": [[0, 0, 0]]}]}, {"constraints": [{**FIXED, "cells": []}]},
    {"constraints": [{**FIXED, "cells": [[0, 0]]}]}, {"constraints": [{**FIXED, "cells": [0]}]},
    {"constraints": [{**FIXED, "cells": [[0, 0, 0.5]]}]},
    {"colour": "red"}, {"": 1},
]


@pytest.mark.parametrize("parameters", PARAMETERS, ids=short)
def test_the_schema_and_the_server_agree_on_what_is_good(server, schema, parameters):
    """Each of these is good or bad by its form alone, so both must say the same."""
    good = jsonschema.Draft202012Validator(schema).is_valid(parameters)
    if isinstance(parameters, dict):
        parameters = {"size": [6, 2, 4], **parameters}
    answer = server.request("POST", "/v1/jobs", json.dumps({**job_request(),
                                                            "parameters": parameters}))
    if answer.status == 202:
        assert server.request("DELETE", answer.headers["location"]).status == 204
    assert answer.status == (202 if good else 422), answer.body[:300]
    if good:
        jsonschema.Draft202012Validator(schema).validate(answer.json()["request"]["parameters"])


@pytest.mark.parametrize("length", [128, 129])
def test_the_schema_and_the_server_agree_on_how_long_a_name_may_be(server, schema, length):
    name = "é" * length
    parameters = {"size": [6, 2, 4], "weights": {"red": 2}, "boundary": {"west": [name, "red",
                                                                             "air"]}}
    example = {**STRIPES, "pieces": [*STRIPES["pieces"], {"name": name}]}
    good = jsonschema.Draft202012Validator(schema).is_valid(parameters)
    assert good == (length == 128)
    request = {**job_request(), "parameters": parameters, "example": example}
    answer = server.request("POST", "/v1/jobs", request)
    assert answer.status == (202 if good else 422), answer.body[:300]

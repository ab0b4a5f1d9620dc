"""The documents that describe the service, held against the service: every path, method, status,
header and body of openapi.json, every message of asyncapi.json, every command of the pages."""

import base64
import collections
import datetime
import gzip
import hashlib
import html
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess

import pytest

from api_document import ApiDocument
from checks import ENDLESS, HILLS, STRIPES, assert_problem, job_request, state_of, wait_until
from conftest import ROOT, Answer, Server
from test_continuous import HUT
from websocket_client import BINARY, TEXT, WebSocketClient
from workload import DECLINED_JOB, TILES, YARD, submit

TOOLS = pathlib.Path(__file__).resolve().parent / "documents"
TAG = {"If-None-Match": "*"}
OTHER_TAG = {"If-Match": '"another"'}
PART = {"Range": "bytes=0-9"}
BEYOND = {"Range": "bytes=999999999-"}
CODED = {"Accept-Encoding": "gzip"}
NOTHING = {"Accept-Encoding": "*;q=0"}
HANDSHAKE = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
             "Sec-WebSocket-Key": base64.b64encode(bytes(16)).decode(),
             "Sec-WebSocket-Protocol": "modelsynth.v1"}

# Answers that take a gigabyte, half a minute, or a job that goes while it is waited for.
NOT_REACHED = {
    ("POST", "/v1/jobs"): {404},
    ("GET", "/v1/jobs/{id}/preview.glb"): {422},
    ("GET", "/v1/examples/{id}/model.glb"): {422},
    ("GET", "/v1/examples/{id}/pieces.glb"): {422},
    ("GET", "/v1/examples/{id}/analysis"): {422},
    ("GET", "/v1/examples/{id}/success.svg"): {422},
}


# Answers to those who may not ask, which test_access.py has.
ACCESS = {401, 403, 421, 429}


@pytest.fixture(scope="module")
def openapi(server):
    return ApiDocument(server.get("/openapi.json").json())


@pytest.fixture(scope="module")
def asyncapi(server):
    return ApiDocument(server.get("/asyncapi.json").json())


# --- the documents by themselves

@pytest.fixture(scope="session")
def tools():
    """The folder of the node script, with what it needs."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        pytest.skip("node and npm are not installed")
    if not (TOOLS / "node_modules" / "@asyncapi" / "parser").exists():
        subprocess.run(["npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts"], cwd=TOOLS,
                       check=True, timeout=300, capture_output=True)
    return TOOLS


def test_the_tools_of_others_find_nothing_wrong(server, tools, tmp_path):
    for name in ("openapi.json", "asyncapi.json"):
        (tmp_path / name).write_bytes(server.get(f"/{name}").body)
    done = subprocess.run(
        ["node", tools / "check.mjs", tmp_path / "openapi.json", tmp_path / "asyncapi.json"],
        cwd=tools, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {"openapi": [], "asyncapi": []}


def test_the_documents_stand_alone(openapi, asyncapi):
    assert openapi.document["openapi"].startswith("3.1.")
    assert asyncapi.document["asyncapi"].startswith("3.0.")
    for document in (openapi, asyncapi):
        references = document.references()
        assert len(references) > 50
        for reference in references:
            assert reference.startswith("#/"), reference
            document.resolver.resolve(reference)
        assert not re.search('"x-(problems|tagged)"', json.dumps(document.document))


def test_schemas_are_those_of_the_solvers(server, openapi):
    for name in ("discrete", "continuous"):
        served = server.get(f"/v1/solvers/{name}").json()["parameters"]
        placed = openapi.document["components"]["schemas"][f"{name.title()}Parameters"]
        here = f"#/components/schemas/{name.title()}Parameters/"
        assert json.loads(json.dumps(placed).replace(here, "#/")) == {
            key: value for key, value in served.items() if key != "$schema"}


def routes_of_the_server():
    """(method, path) of the table in api.cpp."""
    source = (ROOT / "server/http/api.cpp").read_text()
    count, table = re.search(r"std::array<Route, (\d+)> kRoutes = \{(.*?)\};", source,
                             re.DOTALL).groups()
    routes = re.findall(r'\{"([A-Z]+)",\s*"([^"]*)"', table)
    assert len(routes) == int(count)
    return routes


def test_the_document_has_the_routes_of_the_server_and_no_others(openapi):
    documented = sorted((method, re.sub(r"\{\w+\}", "{}", path))
                        for method, path in openapi.operations() if method != "HEAD")
    assert documented == sorted((method, re.sub(r"\{\w+\}", "{}", path))
                                for method, path in routes_of_the_server())


def test_methods_that_are_not_documented_are_not_allowed(server, openapi):
    by_path = collections.defaultdict(set)
    for method, path in openapi.operations():
        by_path[path].add(method)
    for path, methods in by_path.items():
        problem = server.request("PATCH", path.replace("{", "").replace("}", ""))
        assert_problem(problem, 405, "method-not-allowed")
        allowed = set(problem.headers["allow"].split(", "))
        # The handshake of a WebSocket is answered to HEAD as to GET, but that is of no use.
        assert allowed - {"HEAD"} == methods - {"HEAD"}, path
        assert "HEAD" not in methods or "HEAD" in allowed


def requests_in_the_readme_files():
    """Job requests and examples that people are shown."""
    found = []
    for path in sorted((ROOT / "proto").glob("*.md")):
        for number, text in enumerate(re.findall(r"```json\n(.*?)```", path.read_text(), re.DOTALL)):
            if '"solver"' in text or '"from"' in text:
                found.append(pytest.param(json.loads(text), id=f"{path.name}-{number}"))
    assert len(found) > 20
    return found


@pytest.mark.parametrize("request_", requests_in_the_readme_files())
def test_requests_in_the_readme_files_are_as_the_schema_says(openapi, request_):
    openapi.check(request_, {"$ref": "#/components/schemas/JobRequest"})


@pytest.mark.parametrize("example", [STRIPES, HILLS, YARD, TILES, HUT],
                         ids=lambda example: example["name"])
def test_examples_are_as_the_schema_says(openapi, example):
    openapi.check(example, {"$ref": "#/components/schemas/ExampleUpload"})


@pytest.mark.parametrize("request_", [
    {"solver": "discrete"}, {"solver": "discrete", "example": "castle", "size": [1, 1, 1]},
    {"solver": "quantum", "example": "castle"}, {"solver": "discrete", "example": 3},
    {"solver": "discrete", "example": "castle", "parameters": {"density": 1}},
    {"solver": "continuous", "example": "houses", "parameters": {"order": "scan"}},
    {"solver": "discrete", "example": "castle", "seed": 2 ** 53},
    {"solver": "discrete", "example": {**STRIPES, "colour": "red"}},
    {"solver": "discrete", "example": {**STRIPES, "cells": []}},
    {"solver": "continuous", "example": {**HUT, "objects": []}},
], ids=json.dumps)
def test_the_schema_refuses_what_the_server_refuses(server, openapi, request_):
    assert_problem(server.request("POST", "/v1/jobs", request_), 422, "invalid-request")
    with pytest.raises(AssertionError):
        openapi.check(request_, {"$ref": "#/components/schemas/JobRequest"})


def test_the_examples_of_the_document_are_as_its_schemas_say(openapi):
    content = openapi.at("paths", "/v1/jobs", "post", "requestBody", "content", "application/json")
    for example in content["examples"].values():
        openapi.check(example["value"], content["schema"])


# --- every operation against the server

class Walk:
    """Requests of all kinds, and the answers by method and path of the document."""

    def __init__(self, server, openapi):
        self.server = server
        self.heads = {path for method, path in openapi.operations() if method == "HEAD"}
        self.answers = collections.defaultdict(list)

    def send(self, method, path, name="", query="", **more):
        target = re.sub(r"\{\w+\}", name, path) + query
        answer = self.server.request(method, target, **more)
        if answer.headers.get("content-encoding") == "gzip":
            answer.body = gzip.decompress(answer.body)
        self.answers[method, path].append(answer)
        if method == "GET" and path in self.heads:
            self.answers["HEAD", path].append(self.server.request("HEAD", target, **more))
        return answer

    def get_representation(self, path, name="", query=""):
        """All that can be asked of what has an entity tag."""
        for headers in ({}, CODED, PART, BEYOND, TAG, OTHER_TAG, NOTHING):
            self.send("GET", path, name, query, headers=headers)

    def shake_hands(self, path, name=""):
        with WebSocketClient(self.server.port, path.replace("{id}", name)) as client:
            self.answers["GET", path].append(Answer(client.status, client.headers.items(), b""))
            self.answers["GET", path][-1].headers.pop("upgrade")
            self.answers["GET", path][-1].headers.pop("sec-websocket-accept")


def walk_examples(walk):
    walk.get_representation("/v1/examples")
    uploaded = walk.send("POST", "/v1/examples", body=STRIPES).json()["id"]
    solids = walk.send("POST", "/v1/examples", body=HUT).json()["id"]
    walk.send("POST", "/v1/examples", body=b"{", headers={"Content-Type": "application/json"})
    walk.send("POST", "/v1/examples", body=b"x", headers={"Content-Type": "text/plain"})
    walk.send("POST", "/v1/examples", body={"kind": "discrete", "name": "nothing"})
    walk.send("POST", "/v1/examples", body=b" " * 70_000,
              headers={"Content-Type": "application/json"})
    walk.get_representation("/v1/examples/{id}", "castle")
    for name in ("houses", uploaded, "nope"):
        walk.send("GET", "/v1/examples/{id}", name)
    for kind in ("model", "pieces"):
        walk.get_representation(f"/v1/examples/{{id}}/{kind}.glb", uploaded)
        walk.send("GET", f"/v1/examples/{{id}}/{kind}.glb", "nope")
    walk.get_representation("/v1/examples/{id}/analysis", uploaded)
    walk.get_representation("/v1/examples/{id}/success.svg", uploaded)
    walk.get_representation("/v1/examples/{id}/figures.svg", solids)
    for name in (uploaded, solids, "nope"):
        for kind in ("analysis", "success.svg", "figures.svg"):
            walk.send("GET", f"/v1/examples/{{id}}/{kind}", name)
    for query in ("?figure=0", "?figure=999999", "?figures=0"):
        walk.send("GET", "/v1/examples/{id}/figures.svg", solids, query)
    return uploaded


def walk_finished_jobs(walk):
    json_type = {"Content-Type": "application/json"}
    done = walk.send("POST", "/v1/jobs", body=job_request(),
                     headers={"Prefer": "wait=60", "Idempotency-Key": "walk"}).json()
    walk.send("POST", "/v1/jobs", body=job_request(), headers={"Idempotency-Key": "walk"})
    walk.send("POST", "/v1/jobs", body=job_request(seed=2), headers={"Idempotency-Key": "walk"})
    several = walk.send("POST", "/v1/jobs", body=job_request(example=HILLS, alternatives=2),
                        headers={"Prefer": "wait=60"}).json()
    failed = walk.send("POST", "/v1/jobs", body=job_request({"constraints": [
        {"kind": "fixed", "pieces": ["red"], "cells": [[0, 1, 0]]}]}),
        headers={"Prefer": "wait=60"}).json()
    assert failed["error"]["type"] == "/problems/contradiction"
    solids = walk.send("POST", "/v1/jobs", body={"solver": "continuous", "example": HUT},
                       headers={"Prefer": "wait=60"}).json()
    for body, headers in ((b"{", json_type), (b"x", {"Content-Type": "text/plain"}),
                          (b" " * 70_000, json_type), (b"{}", json_type)):
        walk.send("POST", "/v1/jobs", body=body, headers=headers)
    walk.send("POST", "/v1/jobs", body={"from": {"job": failed["id"]}})
    walk.send("POST", "/v1/jobs", body=job_request(), headers={"Accept": "text/event-stream"})
    walk.get_representation("/v1/jobs/{id}", done["id"])
    for job in (several, failed, solids):
        walk.send("GET", "/v1/jobs/{id}", job["id"])
    for query in ("?wait=60", "?wait=1&since=1", "?wait=x", "?since=999999"):
        walk.send("GET", "/v1/jobs/{id}", done["id"], query)
    walk.get_representation("/v1/jobs")
    for query in ("?limit=2", "?state=failed", "?limit=0", "?cursor=!"):
        walk.send("GET", "/v1/jobs", query=query)
    for name in ("model.glb", "preview.glb", "labels.json"):
        walk.get_representation(f"/v1/jobs/{{id}}/{name}", done["id"])
        walk.send("GET", f"/v1/jobs/{{id}}/{name}", failed["id"])
    walk.get_representation("/v1/jobs/{id}/model.glb", done["id"], "?compression=meshopt")
    for name in ("model.glb", "labels.json"):
        for query in ("?alternative=1", "?alternative=64", "?alternative=x"):
            walk.send("GET", f"/v1/jobs/{{id}}/{name}", several["id"], query)
    walk_streams(walk, done)
    for name in ("", "/cancel"):
        walk.send("POST" if name else "DELETE", f"/v1/jobs/{{id}}{name}", done["id"])
    walk.send("DELETE", "/v1/jobs/{id}", several["id"])


def walk_streams(walk, job):
    path = "/v1/jobs/{id}/events"
    last = walk.server.events(job["id"])[-1]["seq"]
    for query in ("", f"?after={last}", f"?after={last + 1}", "?after=x"):
        walk.send("GET", path, job["id"], query)
    path = "/v1/jobs/{id}/stream"
    walk.shake_hands(path, job["id"])
    walk.send("GET", path, job["id"])
    walk.send("GET", path, job["id"], "?partial=all", headers=HANDSHAKE)
    walk.send("GET", path, "nope", headers=HANDSHAKE)
    for path, name in ((path, job["id"]), ("/v1/stream", "")):
        walk.send("GET", path, name, headers={**HANDSHAKE, "Sec-WebSocket-Protocol": "chat"})
    walk.shake_hands("/v1/stream")
    walk.send("GET", "/v1/stream")


def walk_unfinished_jobs(walk, example):
    running = walk.send("POST", "/v1/jobs", body={
        "solver": "discrete", "example": "castle", "parameters": ENDLESS}).json()
    wait_until(lambda: state_of(walk.server, running) == "running")
    queued = walk.send("POST", "/v1/jobs", body=job_request(example=example)).json()
    walk.send("POST", "/v1/jobs", body=job_request())
    walk.send("GET", "/readyz")
    walk.send("POST", "/v1/jobs", body={"from": {"job": running["id"]}})
    walk.send("DELETE", "/v1/examples/{id}", example)
    for name in ("model.glb", "preview.glb", "labels.json"):
        walk.send("GET", f"/v1/jobs/{{id}}/{name}", queued["id"])
        walk.send("GET", f"/v1/jobs/{{id}}/{name}", "nope")
    walk.send("GET", "/v1/jobs", query="?state=queued")
    for name in ("", "/events"):
        walk.send("GET", f"/v1/jobs/{{id}}{name}", "nope")
    for job in (queued, running):
        walk.send("GET", "/v1/jobs/{id}", job["id"])
        walk.send("POST", "/v1/jobs/{id}/cancel", job["id"])
        walk.send("GET", "/v1/jobs/{id}", job["id"])
    walk.send("POST", "/v1/jobs/{id}/cancel", "nope")
    walk.send("POST", "/v1/jobs/{id}/cancel", queued["id"], body=b" " * 70_000)
    walk.send("DELETE", "/v1/jobs/{id}", "nope")
    for name in (example, "castle", "nope"):
        walk.send("DELETE", "/v1/examples/{id}", name)


def walk_service(walk):
    job = walk.server.submit(example=STRIPES, size=(6, 2, 4))["id"]
    for body in (None, {"job": job}, {"job": "nope"}, {"job": 1}, b"{", b" " * 70_000):
        walk.send("POST", "/v1/tickets", body=body)
    walk.server.wait(job)
    for path in ("/v1/limits", "/healthz", "/readyz", "/metrics"):
        walk.send("GET", path)
    for path in ("/v1/solvers", "/openapi.json", "/asyncapi.json", "/docs", "/"):
        walk.get_representation(path)
    walk.get_representation("/v1/solvers/{name}", "discrete")
    walk.send("GET", "/v1/solvers/{name}", "nope")
    for name in ("contradiction", "nope"):
        walk.send("GET", "/problems/{name}", name)


def walk_mistyped_queries(walk, openapi):
    for method, path in openapi.operations():
        if path.startswith("/v1/") and method != "HEAD":
            walk.send(method, path, "castle", "?verbose=1", body={} if method == "POST" else None)


def walk_expired_job(walk, server, job):
    """On a server that keeps models for a few seconds."""
    walk.server = server
    wait_until(lambda: server.get(job["urls"]["model"]).status == 410)
    for name in ("model.glb", "preview.glb", "labels.json"):
        walk.send("GET", f"/v1/jobs/{{id}}/{name}", job["id"])
    walk.send("POST", "/v1/jobs", body={"from": {"job": job["id"]}})


@pytest.fixture(scope="module")
def walked(tmp_path_factory, openapi):
    folder = tmp_path_factory.mktemp("walk")
    small = Server(folder / "small", "--job-body-bytes-max", 65536, "--upload-body-bytes-max",
                   65536, "--queue-max", 1, workers=1).start()
    brief = Server(folder / "brief", "--retention-hours", 0.001, workers=1).start()
    try:
        expiring = brief.wait(brief.submit(size=(10, 8, 10))["id"])
        walk = Walk(small, openapi)
        walk_service(walk)
        example = walk_examples(walk)
        walk_finished_jobs(walk)
        walk_unfinished_jobs(walk, example)
        walk_mistyped_queries(walk, openapi)
        walk_expired_job(walk, brief, expiring)
        yield walk.answers
    finally:
        small.kill()
        brief.kill()


def documented_operations():
    document = json.loads((ROOT / "proto/documents/openapi.json").read_text())
    return [(method.upper(), path) for path, item in document["paths"].items()
            for method in item if method != "parameters"]


@pytest.mark.parametrize("method, path", documented_operations())
def test_answers_are_as_documented(openapi, walked, method, path):
    answers = walked[method, path]
    for answer in answers:
        openapi.check_answer(method, path, answer)
    promised = {status for status in openapi.statuses(method, path) if status < 500} - ACCESS
    seen = {answer.status for answer in answers}
    assert promised - seen == NOT_REACHED.get((method, path), set())


def test_heads_are_as_documented(openapi, walked):
    heads = [(method, path) for method, path in openapi.operations() if method == "HEAD"]
    assert len(heads) > 20
    for method, path in heads:
        assert walked[method, path], path
        for answer in walked[method, path]:
            openapi.check_answer(method, path, answer)


def test_what_is_full_says_when_to_come_back(walked):
    refused = [answer for answer in walked["POST", "/v1/jobs"] if answer.status == 503]
    assert refused and refused[0].json()["type"] == "/problems/queue-full"
    assert 503 in {answer.status for answer in walked["GET", "/readyz"]}


def test_a_type_that_is_not_documented_would_be_found(openapi, walked):
    answer = next(a for a in walked["GET", "/v1/jobs/{id}"] if a.status == 404)
    changed = Answer(404, answer.headers.items(), answer.body.replace(b"not-found", b"busy"))
    openapi.check_answer("GET", "/v1/jobs/{id}", answer)
    with pytest.raises(AssertionError):
        openapi.check_answer("GET", "/v1/jobs/{id}", changed)


def test_a_field_that_is_not_documented_would_be_found(openapi, walked):
    answer = next(a for a in walked["GET", "/v1/jobs/{id}"] if a.status == 200)
    changed = Answer(200, answer.headers.items(), json.dumps({**answer.json(), "x": 1}).encode())
    with pytest.raises(AssertionError):
        openapi.check_answer("GET", "/v1/jobs/{id}", changed)


# --- limits

def test_limits_are_those_of_the_running_server(make_server):
    server = make_server("--queue-max", 3, "--examples-max", 4, "--model-cells-max", 5000,
                         "--retention-hours", 2, "--job-body-bytes-max", 20000,
                         "--upload-body-bytes-max", 30000, "--connections-max", 50,
                         "--head-seconds", 6, "--body-seconds", 7, "--idle-seconds", 8,
                         "--memory-max", 123_000_000, "--large-choices", 40_000, workers=3)
    document = server.get("/v1/limits").json()
    limits = {name: limit["value"] for name, limit in document["limits"].items()}
    assert limits["queue_max"] == 3 and limits["examples_max"] == 4
    assert limits["model_cells_max"] == 5000
    assert limits["job_body_bytes_max"] == 20000 and limits["upload_body_bytes_max"] == 30000
    assert limits["connections_max"] == 50 and limits["head_seconds"] == 6
    assert limits["body_seconds"] == 7 and limits["idle_seconds"] == 8
    assert limits["memory_bytes_max"] == 123_000_000 and limits["large_choices"] == 40_000
    assert limits["workers"] == 3 and limits["large_jobs_max"] == 2
    assert limits["key_requests_per_second_max"] is None
    assert document["retention"]["model_seconds"]["value"] == 7200
    assert document["retention"]["job_seconds"]["value"] == 4 * 7200
    assert document["retention"]["idempotency_key_seconds"]["value"] is None
    # Their names are those that refusals name.
    refused = server.request("POST", "/v1/jobs", {"solver": "discrete", "example": "castle",
                                                  "parameters": {"size": [100, 10, 100]}})
    problem = assert_problem(refused, 422, "too-large")
    assert "model_cells_max is 5000" in problem["errors"][0]["detail"]


def test_memory_is_the_machines_unless_it_is_given(server):
    limit = server.get("/v1/limits").json()["limits"]["memory_bytes_max"]["value"]
    pages, page = os.sysconf("SC_PHYS_PAGES"), os.sysconf("SC_PAGE_SIZE")
    assert limit == pages * page // 4 * 3


def test_limits_hold_at_their_edges(server, openapi):
    limits = {name: limit["value"]
              for name, limit in server.get("/v1/limits").json()["limits"].items()}
    asked = server.request("POST", "/v1/jobs", job_request(), headers={"Prefer": "wait=1000"})
    assert asked.headers["preference-applied"] == f"wait={limits['prefer_wait_seconds_max']}"
    most = limits["page_items_max"]
    assert server.get(f"/v1/jobs?limit={most}").status == 200
    assert server.get(f"/v1/jobs?limit={most + 1}").status == 422
    limit = next(parameter["schema"] for parameter in openapi.at("paths", "/v1/jobs", "get")[
        "parameters"] if parameter["name"] == "limit")
    assert (limit["maximum"], limit["default"]) == (most, limits["page_items_default"])
    for name, maximum in (("seed", limits["seed_max"]), ("deadline", limits["deadline_seconds_max"]),
                          ("alternatives", limits["alternatives_max"])):
        refused = server.request("POST", "/v1/jobs", job_request(**{name: maximum + 1}))
        assert f"/{name}" in {error["pointer"] for error in refused.json()["errors"]}
    key = "k" * limits["idempotency_key_characters_max"]
    for sent, status in ((key, 202), (key + "k", 400)):
        answer = server.request("POST", "/v1/jobs", job_request(), headers={"Idempotency-Key": sent})
        assert answer.status == status
    given = datetime.datetime.now(datetime.timezone.utc)
    given = given.replace(microsecond=given.microsecond // 1000 * 1000)  # as times are told
    expires = server.request("POST", "/v1/tickets").json()["expires"]
    lives = datetime.datetime.fromisoformat(expires.replace("Z", "+00:00")) - given
    assert 0 <= lives.total_seconds() - limits["ticket_seconds"] < 10


# --- events against asyncapi.json

def jobs_of_all_ends(server):
    """Jobs whose logs have every type of event between them."""
    fixed = [{"kind": "fixed", "pieces": ["red"], "cells": [[0, 1, 0]]}]
    requests = [job_request(example=HILLS, parameters={"size": [12, 4, 12]}),
                {"solver": "continuous", "example": HUT},
                job_request(alternatives=3), job_request(example=HILLS, alternatives=2),
                job_request({"constraints": fixed})]
    jobs = [server.request("POST", "/v1/jobs", request).json() for request in requests]
    jobs.append(submit(server, DECLINED_JOB))
    cancelled = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": "castle", "parameters": ENDLESS}).json()
    server.request("POST", f"/v1/jobs/{cancelled['id']}/cancel")
    return [server.wait(job["id"]) for job in (*jobs, cancelled)]


def check_event(asyncapi, channel, event):
    message = asyncapi.at("channels", channel, "messages", event["type"])
    asyncapi.check(event, message["payload"], event["type"])


def read_frame(asyncapi, data, message="frame"):
    """The fields of a binary frame, as the document lays them out."""
    codes = {"char": "s", "uint8": "B", "uint16": "H", "uint32": "I", "uint64": "Q", "int32": "i"}
    fields, end = {}, 0
    for field in asyncapi.at("components", "messages", message)["x-layout"]:
        if field["type"] == "bytes":
            start = field.get("offset", end)
            end = start + fields[f"{field['name']}_bytes"]
            fields[field["name"]] = data[start:end]
            end += -end % 4
            continue
        kind, count = re.fullmatch(r"(\w+?)(?:\[(\d)\])?", field["type"]).groups()
        values = struct.unpack_from(f"<{count or ''}{codes[kind]}", data, field["offset"])
        value = list(values) if count and kind != "char" else values[0]
        fields[field["name"]] = value
        if "value" in field:
            expected = field["value"]
            assert value == (expected.encode() if isinstance(expected, str) else expected)
        assert "values" not in field or str(value) in field["values"]
    assert len(fields["payload"]) == fields["payload_bytes"] and end - len(data) in range(4)
    return fields


def test_events_are_as_documented(server, asyncapi):
    jobs = jobs_of_all_ends(server)
    assert {job["state"] for job in jobs} == {"succeeded", "failed", "cancelled"}
    seen, outcomes, ends = set(), set(), set()
    for job in jobs:
        for event in server.events(job["id"]):
            check_event(asyncapi, "jobEvents", event)
            assert "job_id" not in event
            asyncapi.check(event, {"$ref": "#/components/schemas/Event"})
            seen.add(event["type"])
            outcomes.add(event.get("outcome"))
            ends |= {"result", "same_as"} & set(event) if event["type"] == "alternative" else set()
    assert seen | {"snapshot"} == set(asyncapi.at("channels", "jobEvents", "messages"))
    assert outcomes == {None, "accepted", "reverted"} and ends == {"result", "same_as"}


@pytest.mark.parametrize("partial, kinds", [("labels", {1, 2}), ("glb", {3, 4})])
def test_messages_of_the_socket_are_as_documented(server, asyncapi, partial, kinds):
    job = submit(server, {"example": YARD, "size": (40, 6, 40), "parameters": {}})
    address = asyncapi.at("channels", "jobStream")["address"].replace("{id}", job["id"])
    with WebSocketClient(server.port, f"{address}?partial={partial}") as client:
        *messages, _ = client.messages()
    seen = set()
    for message in messages:
        if isinstance(message, bytes):
            frame = read_frame(asyncapi, message)
            seen.add(frame["kind"])
            cells = [high - low for low, high in zip(frame["min"], frame["max"])]
            if partial == "labels":
                assert frame["payload_bytes"] == 2 * cells[0] * cells[1] * cells[2]
            else:
                assert frame["payload"].startswith(b"glTF")
        else:
            check_event(asyncapi, "jobStream", message)
    assert seen and seen <= kinds


def message_of(sent):
    """The name of the message of /v1/stream that a text of the server is."""
    if sent["type"] == "answer":
        return f"answerTo{sent['request'].title()}"
    return sent["type"]


def test_messages_of_the_shared_socket_are_as_documented(server, asyncapi):
    done = server.wait(submit(server, {"example": YARD, "size": (20, 6, 20), "parameters": {}})["id"])
    running = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": "castle", "parameters": ENDLESS}).json()
    requests = [{"type": "subscribe", "job": running["id"], "partial": "glb"},
                {"type": "unsubscribe", "job": running["id"]},
                {"type": "cancel", "job": running["id"]},
                {"type": "unsubscribe", "job": "nope"},
                {"type": "subscribe", "job": done["id"], "after": 1, "partial": "labels"}]
    channel = asyncapi.at("channels", "stream")
    seen = set()
    with WebSocketClient(server.port, channel["address"]) as client:
        for number, request in enumerate(requests):
            request = {"id": number, **request}
            asyncapi.check(request, asyncapi.at(
                "channels", "stream", "messages", request["type"])["payload"])
            client.send(TEXT, json.dumps(request).encode())
        while "end" not in seen:
            message = client.message()
            if message.opcode == BINARY:
                frame = read_frame(asyncapi, message.payload, "namedFrame")
                assert frame["job_id"].decode() in (done["id"], running["id"])
                seen.add("namedFrame")
                continue
            sent = json.loads(message.payload)
            name = message_of(sent)
            asyncapi.check(sent, asyncapi.at("channels", "stream", "messages", name)["payload"])
            assert "time" not in sent or sent["job_id"] in (done["id"], running["id"])
            seen.add(name)
    assert seen <= set(channel["messages"])
    assert {"answerToSubscribe", "answerToUnsubscribe", "answerToCancel", "refusal", "end",
            "namedFrame", "block", "succeeded"} <= seen


def test_an_event_of_another_form_would_be_found(asyncapi):
    event = {"seq": 1, "type": "queued", "time": "2026-01-01T00:00:00.000Z", "position": 0}
    check_event(asyncapi, "jobEvents", event)
    for changed in ({**event, "seq": 0}, {**event, "x": 1}, {**event, "position": "0"}):
        with pytest.raises(AssertionError):
            check_event(asyncapi, "jobEvents", changed)


# --- pages

PAGES = ("/", "/docs")


@pytest.mark.parametrize("path", PAGES)
def test_pages_need_nothing_from_elsewhere(server, path):
    answer = server.get(path)
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    page = answer.body.decode()
    for attribute in re.findall(r'(?:src|href|action)="([^"]*)"', page):
        assert attribute.startswith(("/", "#", "data:,")), attribute
    markup = re.sub(r"<(script|style)\b.*?</\1>", "", page, flags=re.DOTALL)
    assert not re.search(r"\s(on\w+|style)=", markup)


@pytest.mark.parametrize("path", PAGES)
def test_the_policy_of_a_page_lets_its_own_scripts_run_and_no_others(server, path):
    answer = server.get(path)
    policy = dict(part.strip().split(" ", 1)
                  for part in answer.headers["content-security-policy"].split(";"))
    assert policy["default-src"] == "'none'" and policy["connect-src"] == "'self'"
    for element in ("script", "style"):
        texts = re.findall(rf"<{element}>(.*?)</{element}>", answer.body.decode(), re.DOTALL)
        hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
                  for text in texts]
        assert texts and policy[f"{element}-src"].split() == [f"'sha256-{h}'" for h in hashes]


def test_the_docs_page_carries_the_documents(server):
    page = server.get("/docs").body.decode()
    for name in ("openapi", "asyncapi"):
        text = re.search(rf'<script type="application/json" id="{name}">(.*?)</script>', page,
                         re.DOTALL).group(1)
        assert json.loads(text) == server.get(f"/{name}.json").json()


def commands_of_the_docs(server, openapi):
    """What people are told to type, in an order in which it can be."""
    page = server.get("/docs").body.decode()
    first = [html.unescape(text)
             for text in re.findall(r'<pre class="shell">(.*?)</pre>', page, re.DOTALL)]
    samples = [(method, sample["source"]) for path, item in openapi.document["paths"].items()
               for method, operation in item.items() if method in ("get", "post", "delete")
               for sample in operation.get("x-codeSamples", []) if sample["lang"] == "Shell"]
    assert len(first) >= 5 and len(samples) >= 25
    made = sorted(samples, key=lambda sample: ("post", "get", "delete").index(sample[0]))
    return first + [source for _, source in made]


def test_commands_of_the_docs_work_as_they_stand(server, openapi, tmp_path):
    commands = commands_of_the_docs(server, openapi)
    bin_dir, heads, folder = (tmp_path / name for name in ("bin", "heads", "folder"))
    for made in (bin_dir, heads, folder):
        made.mkdir()
    curl = bin_dir / "curl"
    curl.write_text(f'#!/bin/sh\nexec {shutil.which("curl")} -D "{heads}/$NUMBER" "$@"\n')
    curl.chmod(0o755)
    lines = ["set -eu"]
    for number, command in enumerate(commands):
        lines += [f"export NUMBER={number:03}", f"{command} > out.{number:03}"
                  if not re.match(r"[A-Z]+=", command) else command]
    script = "\n".join(lines).replace("http://127.0.0.1:8080", server.url)
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "PATH": f"{bin_dir}:{os.environ['PATH']}"},
                          timeout=120)
    assert done.returncode == 0, done.stderr
    statuses = [int((heads / f"{number:03}").read_text().split(" ")[1])
                for number in range(len(commands))]
    wrong = [(status, command) for status, command in zip(statuses, commands) if status >= 400]
    assert [status for status, _ in wrong] == [422] and '"order": "best"' in wrong[0][1]
    assert (folder / "castle.glb").read_bytes()[:4] == b"glTF"


@pytest.mark.skipif(shutil.which("chromium") is None, reason="chromium is not installed")
def test_a_browser_draws_every_operation_and_schema(server, openapi, tmp_path):
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}",
         "--virtual-time-budget=5000", "--dump-dom", f"{server.url}/docs"],
        capture_output=True, text=True, timeout=60)
    for path, item in openapi.document["paths"].items():
        for method, operation in item.items():
            if method in ("get", "post", "delete"):
                assert f'<article id="op-{operation["operationId"]}">' in done.stdout, path
    for name in openapi.document["components"]["schemas"]:
        assert f'<article id="schema-{name}">' in done.stdout

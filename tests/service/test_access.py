"""Keys and what they may do, rates and quotas, tickets, names of the server, pages of elsewhere."""

import hashlib
import json
import signal
import subprocess

import pytest

from api_document import ApiDocument
from checks import ENDLESS, assert_problem, job_request, wait_until
from conftest import BIN_DIR, Server
from raw_http import Wire
from websocket_client import WebSocketClient

SECRETS = {"ann": "ann's key", "ann later": "ann's next key", "bob": "bob's key",
           "reader": "reader's key", "operator": "operator's key"}


def entry(name, scopes, secret=None, **more):
    digest = hashlib.sha256((secret or SECRETS[name]).encode()).hexdigest()
    return {"name": name, "sha256": digest, "scopes": scopes, **more}


def all_keys():
    return [entry("ann", ["read", "submit"]), entry("bob", ["read", "submit"]),
            entry("reader", ["read"]), entry("operator", ["read", "submit", "admin"])]


def write_keys(path, keys):
    path.write_text(json.dumps({"keys": keys}))
    return path


def endless():
    return {"solver": "discrete", "example": "castle", "parameters": ENDLESS}


def bearer(name):
    return {"Authorization": f"Bearer {SECRETS[name]}"}


@pytest.fixture(scope="module")
def keyed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("keyed")
    server = Server(folder / "data", "--keys", write_keys(folder / "keys.json", all_keys())).start()
    yield server
    assert server.stop() == 0


def submit(server, name, body=None, **headers):
    answer = server.request("POST", "/v1/jobs", body or job_request(),
                            headers={**bearer(name), **headers})
    assert answer.status in (200, 202), answer.body
    return answer.json()


# --- keys

@pytest.mark.parametrize("headers", [
    {}, {"Authorization": "Bearer nobody's key"}, {"Authorization": "Bearer "},
    {"Authorization": "Basic YW5uOmFubg=="}, {"Authorization": SECRETS["ann"]}])
@pytest.mark.parametrize("method,path", [
    ("GET", "/v1/jobs"), ("POST", "/v1/jobs"), ("GET", "/v1/examples"), ("GET", "/v1/solvers"),
    ("POST", "/v1/tickets"), ("GET", "/v1/jobs/x"), ("DELETE", "/v1/examples/castle")])
def test_without_a_known_key_nothing_is_told(keyed, method, path, headers):
    answer = keyed.request(method, path, headers=headers)
    assert_problem(answer, 401, "unauthorized")
    assert answer.headers["www-authenticate"].startswith("Bearer")


@pytest.mark.parametrize("path", ["/healthz", "/readyz", "/problems/unauthorized"])
def test_health_and_problems_are_open(keyed, path):
    assert keyed.get(path).status == 200


@pytest.mark.parametrize("scheme", ["Bearer", "bearer", "BEARER  "])
def test_a_key_opens_what_it_is_for(keyed, scheme):
    headers = {"Authorization": f"{scheme} {SECRETS['reader']}"}
    assert keyed.get("/v1/jobs", headers=headers).status == 200
    answer = keyed.request("POST", "/v1/jobs", job_request(), headers=headers)
    assert_problem(answer, 403, "missing-scope")
    assert "submit" in answer.json()["detail"]


def test_what_is_anothers_is_as_if_it_were_not_there(keyed):
    job = submit(keyed, "ann", Prefer="wait=30")
    missing = keyed.get("/v1/jobs/nothing", headers=bearer("bob")).json()
    for method, path in [("GET", ""), ("POST", "/cancel"), ("GET", "/model.glb"),
                         ("GET", "/preview.glb"), ("GET", "/labels.json"), ("GET", "/events"),
                         ("GET", "/stream"), ("DELETE", "")]:
        answer = keyed.request(method, f"/v1/jobs/{job['id']}{path}", headers=bearer("bob"))
        assert_problem(answer, 404, "not-found")
        assert answer.json()["detail"] == missing["detail"].replace("nothing", job["id"])
    for name, is_seen in [("ann", True), ("bob", False), ("operator", True)]:
        page = keyed.get("/v1/jobs?limit=100", headers=bearer(name)).json()
        assert (job["id"] in [item["id"] for item in page["items"]]) == is_seen
    again = job_request()
    again.pop("example")
    again.pop("solver")
    answer = keyed.request("POST", "/v1/jobs", {"from": {"job": job["id"]}, "seed": 1},
                           headers=bearer("bob"))
    assert answer.status in (404, 422) and "no job" in answer.body.decode()
    assert keyed.get(f"/v1/jobs/{job['id']}/model.glb", headers=bearer("ann")).status == 200
    assert keyed.get(f"/v1/jobs/{job['id']}/model.glb", headers=bearer("operator")).status == 200


def test_an_idempotency_key_is_its_owners_alone(keyed):
    one = submit(keyed, "ann", **{"Idempotency-Key": "same"})
    two = submit(keyed, "bob", **{"Idempotency-Key": "same"})
    assert one["id"] != two["id"]
    assert submit(keyed, "ann", **{"Idempotency-Key": "same"})["id"] == one["id"]


def test_an_uploaded_example_is_there_for_those_who_gave_it(keyed):
    example = {"kind": "discrete", "name": "line", "cell": [1, 1, 1],
               "pieces": [{"name": "empty"}, {"name": "wall"}],
               "size": [2, 1, 2], "cells": [0, 1, 0, 1], "empty": "empty"}
    answer = keyed.request("POST", "/v1/examples", example, headers=bearer("ann"))
    assert answer.status == 201
    path = answer.headers["location"]
    example_id = answer.json()["id"]
    assert_problem(keyed.get(path, headers=bearer("bob")), 404, "not-found")
    listed = keyed.get("/v1/examples", headers=bearer("bob")).json()["items"]
    assert example_id not in [item["id"] for item in listed] and len(listed) > 10
    answer = keyed.request("POST", "/v1/jobs", job_request(example=example_id),
                           headers=bearer("bob"))
    assert_problem(answer, 422, "invalid-request")
    # The same upload is the same example, and each takes only their own away.
    assert keyed.request("POST", "/v1/examples", example,
                         headers=bearer("bob")).json()["id"] == example_id
    assert keyed.request("DELETE", path, headers=bearer("bob")).status == 204
    assert_problem(keyed.request("DELETE", path, headers=bearer("bob")), 404, "not-found")
    assert keyed.get(path, headers=bearer("ann")).status == 200


def test_keys_change_without_a_restart(tmp_path):
    path = write_keys(tmp_path / "keys.json", [entry("ann", ["read", "submit"])])
    server = Server(tmp_path / "data", "--keys", path).start()
    try:
        job = submit(server, "ann")
        write_keys(path, [entry("ann", ["read"]), entry("ann", ["read"], SECRETS["ann later"])])
        server.process.send_signal(signal.SIGHUP)
        wait_until(lambda: server.get("/v1/jobs", headers=bearer("ann later")).status == 200)
        # Another key of the same name has what the first one made.
        for name in ("ann", "ann later"):
            assert server.get(f"/v1/jobs/{job['id']}", headers=bearer(name)).status == 200
        write_keys(path, [entry("ann", ["read"], SECRETS["ann later"])])
        server.process.send_signal(signal.SIGHUP)
        wait_until(lambda: server.get("/v1/jobs", headers=bearer("ann")).status == 401)
        # A file that is wrong changes nothing.
        path.write_text("{")
        server.process.send_signal(signal.SIGHUP)
        wait_until(lambda: "the keys stay as they were" in
                   (tmp_path / "data.log").read_text(errors="replace"))
        assert server.get("/v1/jobs", headers=bearer("ann later")).status == 200
    finally:
        assert server.stop() == 0


@pytest.mark.parametrize("text,place", [
    ("{", "byte"), ("[]", ""), ('{"keys": {}}', "/keys"), ('{"keys": [], "more": 1}', "/more"),
    ('{"keys": [{"name": "a", "scopes": ["read"]}]}', "/keys/0/sha256"),
    ('{"keys": [{"name": "", "sha256": "%s", "scopes": ["read"]}]}', "/keys/0/name"),
    ('{"keys": [{"name": "a", "sha256": "abc", "scopes": ["read"]}]}', "/keys/0/sha256"),
    ('{"keys": [{"name": "a", "sha256": "%s", "scopes": ["write"]}]}', "/keys/0/scopes/0"),
    ('{"keys": [{"name": "a", "sha256": "%s", "scopes": []}]}', "/keys/0/scopes"),
    ('{"keys": [{"name": "a", "sha256": "%s", "scopes": ["read"], "rate": 0}]}', "/keys/0/rate"),
    ('{"keys": [{"name": "a", "sha256": "%s", "scopes": ["read"], "jobs": 1.5}]}', "/keys/0/jobs"),
    ('{"keys": [{"name": "a", "sha256": "%s", "scopes": ["read"]},'
     ' {"name": "b", "sha256": "%s", "scopes": ["read"]}]}', "/keys/1/sha256")])
def test_a_wrong_file_of_keys_is_told_with_its_place(tmp_path, text, place):
    path = tmp_path / "keys.json"
    path.write_text(text.replace("%s", "ab" * 32))
    ended = subprocess.run([BIN_DIR / "modelsynthd", "--data", tmp_path / "data", "--listen",
                            "127.0.0.1:0", "--keys", path],
                           capture_output=True, text=True, timeout=30)
    assert ended.returncode == 1 and ended.stdout == ""
    assert str(path) in ended.stderr and place in ended.stderr


def test_without_keys_only_loopback_is_listened_on(tmp_path):
    ended = subprocess.run([BIN_DIR / "modelsynthd", "--data", tmp_path / "data", "--listen",
                            "0.0.0.0:0"], capture_output=True, text=True, timeout=30)
    assert ended.returncode == 2 and "--keys" in ended.stderr


# --- how often and how much

def test_whoever_asks_too_fast_is_told_when_to_come_back(tmp_path):
    # So slow that no bucket fills while the test runs.
    path = write_keys(tmp_path / "keys.json", [
        entry("ann", ["read"], rate=0.001), entry("bob", ["read"], rate=3.5)])
    server = Server(tmp_path / "data", "--keys", path).start()
    try:
        first = server.get("/v1/jobs", headers=bearer("ann"))
        assert first.status == 200
        assert first.headers["ratelimit-policy"] == '"burst";q=1;w=1000'
        assert first.headers["ratelimit"].startswith('"burst";r=0;t=')
        second = server.get("/v1/jobs", headers=bearer("ann"))
        assert_problem(second, 429, "too-fast")
        openapi = ApiDocument(server.get("/openapi.json").json())
        openapi.check_answer("GET", "/v1/jobs", second)
        assert 900 < int(second.headers["retry-after"]) <= 1000
        assert second.headers["ratelimit"] == f'"burst";r=0;t={second.headers["retry-after"]}'
        assert server.get("/healthz", headers=bearer("ann")).status == 200
        assert server.get("/v1/jobs", headers=bearer("bob")).headers["ratelimit-policy"] == \
            '"burst";q=4;w=2'
    finally:
        assert server.stop() == 0


def test_a_key_has_so_many_unfinished_jobs_and_no_more(tmp_path):
    path = write_keys(tmp_path / "keys.json", [
        entry("ann", ["read", "submit"], jobs=2), entry("bob", ["read", "submit"])])
    server = Server(tmp_path / "data", "--keys", path, workers=1).start()
    try:
        jobs = [submit(server, "ann", endless()) for _ in range(2)]
        refused = server.request("POST", "/v1/jobs", endless(), headers=bearer("ann"))
        assert_problem(refused, 429, "too-many-jobs")
        assert int(refused.headers["retry-after"]) >= 1
        submit(server, "bob", endless())
        for job in jobs:
            server.request("POST", f"/v1/jobs/{job['id']}/cancel", headers=bearer("ann"))
        assert submit(server, "ann", endless())
    finally:
        assert server.stop() == 0


def test_a_flood_of_one_key_does_not_keep_another_waiting(tmp_path):
    path = write_keys(tmp_path / "keys.json", [
        entry("ann", ["read", "submit"]), entry("bob", ["read", "submit"])])
    server = Server(tmp_path / "data", "--keys", path, workers=1).start()
    try:
        plug = submit(server, "ann", endless())
        flood = [submit(server, "ann", job_request(seed=seed))["id"] for seed in range(200)]
        one = submit(server, "bob", job_request(seed=1))
        assert one["queue"]["position"] <= 1
        server.request("POST", f"/v1/jobs/{plug['id']}/cancel", headers=bearer("ann"))
        wait_until(lambda: server.get(f"/v1/jobs/{flood[-1]}",
                                      headers=bearer("ann")).json()["state"] == "succeeded",
                   timeout=60)
        started = {job: server.get(f"/v1/jobs/{job}", headers=bearer(name)).json()["started"]
                   for name, ids in (("ann", flood), ("bob", [one["id"]])) for job in ids}
        order = sorted(started, key=started.get)
        assert order.index(one["id"]) <= 3
    finally:
        assert server.stop() == 0


# --- room

def test_a_job_that_needs_more_memory_than_there_is_is_refused_with_the_figure(tmp_path):
    server = Server(tmp_path / "data", "--memory-max", str(40 << 20)).start()
    try:
        assert server.wait(server.submit(size=(20, 8, 20))["id"])["state"] == "succeeded"
        answer = server.request("POST", "/v1/jobs", job_request(parameters={"size": [200, 10, 200]}))
        assert_problem(answer, 422, "too-large")
        assert "bytes of memory" in answer.json()["detail"]
        assert str(40 << 20) in answer.json()["detail"]
    finally:
        assert server.stop() == 0


def test_large_jobs_leave_a_worker_for_small_ones(tmp_path):
    server = Server(tmp_path / "data", "--large-choices", "100000", workers=2).start()
    try:
        large = [server.request("POST", "/v1/jobs", endless()).json() for _ in range(3)]
        small = server.submit(size=(8, 4, 8))
        assert server.wait(small["id"])["state"] == "succeeded"
        states = [server.get(f"/v1/jobs/{job['id']}").json()["state"] for job in large]
        assert states.count("running") == 1 and states.count("queued") == 2
    finally:
        assert server.stop() == 0


# --- tickets

def ticket_of(server, name, body=None):
    answer = server.request("POST", "/v1/tickets", body, headers=bearer(name))
    assert answer.status == 201, answer.body
    assert answer.headers["cache-control"] == "no-store"
    assert set(answer.json()) == {"ticket", "expires"}
    return answer.json()["ticket"]


def test_a_ticket_opens_one_stream_once(keyed):
    job = submit(keyed, "ann", Prefer="wait=30")
    ticket = ticket_of(keyed, "ann")
    path = f"/v1/jobs/{job['id']}/events"
    assert keyed.get(f"{path}?ticket={ticket}").status == 200
    assert_problem(keyed.get(f"{path}?ticket={ticket}"), 401, "unauthorized")
    path = f"/v1/jobs/{job['id']}/stream?ticket={ticket_of(keyed, 'ann')}"
    with WebSocketClient(keyed.port, path) as stream:
        assert json.loads(stream.message().payload)["type"] == "queued"


def test_a_ticket_is_no_key_for_anything_else(keyed):
    job = submit(keyed, "ann", Prefer="wait=30")
    for path in (f"/v1/jobs/{job['id']}", "/v1/jobs", f"/v1/jobs/{job['id']}/model.glb"):
        assert_problem(keyed.get(f"{path}?ticket={ticket_of(keyed, 'ann')}"), 401, "unauthorized")
    path = f"/v1/jobs/{job['id']}/events"
    assert_problem(keyed.get(f"{path}?ticket={ticket_of(keyed, 'bob')}"), 404, "not-found")
    assert_problem(keyed.get(f"{path}?ticket=guessed"), 401, "unauthorized")


def test_a_ticket_may_be_for_one_job_alone(keyed):
    one, other = (submit(keyed, "ann", Prefer="wait=30") for _ in range(2))
    bound = ticket_of(keyed, "ann", {"job": one["id"]})
    assert_problem(keyed.get(f"/v1/jobs/{other['id']}/events?ticket={bound}"), 401, "unauthorized")
    bound = ticket_of(keyed, "ann", {"job": one["id"]})
    assert keyed.get(f"/v1/jobs/{one['id']}/events?ticket={bound}").status == 200
    answer = keyed.request("POST", "/v1/tickets", {"job": one["id"]}, headers=bearer("bob"))
    assert_problem(answer, 404, "not-found")


@pytest.mark.parametrize("body,pointer", [
    ({"job": 7}, "/job"), ({"job": ""}, "/job"), ({"jobs": "x"}, "/jobs"), ([], "")])
def test_a_wrong_request_for_a_ticket_is_told_with_its_place(keyed, body, pointer):
    answer = keyed.request("POST", "/v1/tickets", body, headers=bearer("ann"))
    assert_problem(answer, 422, "invalid-request")
    assert pointer in [fault["pointer"] for fault in answer.json()["errors"]]


def test_where_no_key_is_needed_a_ticket_changes_nothing(server):
    job = server.submit()
    answer = server.request("POST", "/v1/tickets")
    assert answer.status == 201
    assert server.get(f"/v1/jobs/{job['id']}/events?ticket={answer.json()['ticket']}").status == 200


# --- browsers

@pytest.mark.parametrize("host", [
    "127.0.0.1", "127.0.0.1:8080", "localhost", "LOCALHOST:1", "[::1]:8080", "192.168.7.9",
    "modelsynth", "box.local", "api.example.com", "studio.localhost", "a.internal.", "x"])
def test_names_that_nobody_else_can_have_are_taken(server, host):
    with Wire(server) as wire:
        assert wire.send(f"GET /v1/jobs HTTP/1.1\r\nHost: {host}\r\n\r\n".encode()) \
            .answer().status == 200


@pytest.mark.parametrize("host", [
    "attacker.com", "attacker.com:8080", "127.0.0.1.attacker.com", "localhost.attacker.com",
    "notlocal.host", "example.com.attacker.com", "myexample.com"])
def test_names_that_anybody_could_point_here_are_not(server, host):
    with Wire(server) as wire:
        answer = wire.send(f"GET /v1/jobs HTTP/1.1\r\nHost: {host}\r\n\r\n".encode()).answer()
        assert answer.status == 421
        assert json.loads(answer.body)["type"] == "/problems/unknown-host"


def test_further_names_and_origins_are_given_by_the_operator(tmp_path):
    server = Server(tmp_path / "data", "--allow-host", "Models.attacker.com", "--allow-origin",
                    "https://studio.mygame.com").start()
    try:
        assert server.get("/v1/jobs", headers={"Host": "models.attacker.com:80"}).status == 200
        answer = server.request("POST", "/v1/jobs", job_request(),
                                headers={"Origin": "https://studio.mygame.com"})
        assert answer.status == 202
        assert answer.headers["access-control-allow-origin"] == "https://studio.mygame.com"
        assert "Location" in answer.headers["access-control-expose-headers"]
        assert "Origin" in answer.headers["vary"]
    finally:
        assert server.stop() == 0


@pytest.mark.parametrize("origin", ["http://localhost:5173", "http://127.0.0.1", "http://[::1]:3000",
                                    "https://app.localhost"])
def test_pages_of_this_machine_may_ask(server, origin):
    answer = server.request("POST", "/v1/jobs", job_request(), headers={"Origin": origin})
    assert answer.status == 202
    assert answer.headers["access-control-allow-origin"] == origin


@pytest.mark.parametrize("origin", ["https://attacker.com", "null", "http://localhost.attacker.com",
                                    "file://localhost", "http://127.0.0.1.attacker.com", "junk"])
def test_pages_of_elsewhere_change_nothing_and_read_nothing(server, origin):
    job = server.submit()
    headers = {"Origin": origin}
    for method, path in [("POST", "/v1/jobs"), ("POST", f"/v1/jobs/{job['id']}/cancel"),
                         ("DELETE", f"/v1/jobs/{job['id']}"), ("POST", "/v1/examples"),
                         ("GET", f"/v1/jobs/{job['id']}/events"),
                         ("GET", f"/v1/jobs/{job['id']}/stream")]:
        answer = server.request(method, path, headers=headers)
        assert_problem(answer, 403, "forbidden-origin")
    answer = server.get(f"/v1/jobs/{job['id']}", headers=headers)
    assert answer.status == 200 and "access-control-allow-origin" not in answer.headers


def test_a_page_served_from_the_server_itself_may_ask(server):
    answer = server.request("POST", "/v1/jobs", job_request(),
                            headers={"Host": "box.local:8080", "Origin": "http://box.local:8080"})
    assert answer.status == 202


def test_a_browser_asks_before_it_asks(server):
    ask = {"Origin": "http://localhost:5173", "Access-Control-Request-Method": "POST",
           "Access-Control-Request-Headers": "authorization,content-type,idempotency-key"}
    answer = server.request("OPTIONS", "/v1/jobs", headers=ask)
    assert answer.status == 204
    assert "POST" in answer.headers["access-control-allow-methods"]
    allowed = answer.headers["access-control-allow-headers"].lower()
    assert all(name in allowed for name in ("authorization", "content-type", "idempotency-key"))
    refused = server.request("OPTIONS", "/v1/jobs", headers={**ask, "Origin": "https://attacker.com"})
    assert refused.status == 405 and "access-control-allow-origin" not in refused.headers


def test_refusals_are_as_documented(keyed, server):
    openapi = ApiDocument(server.get("/openapi.json").json())
    attacker = {"Origin": "https://attacker.com"}
    for status, path, answer in [
            (401, "/v1/jobs", keyed.get("/v1/jobs")),
            (401, "/v1/limits", keyed.get("/v1/limits", headers={"Authorization": "Bearer x"})),
            (403, "/metrics", keyed.get("/metrics", headers=bearer("ann"))),
            (403, "/v1/jobs/{id}/events", server.get("/v1/jobs/x/events", headers=attacker)),
            (421, "/v1/jobs", server.get("/v1/jobs", headers={"Host": "attacker.com"}))]:
        assert answer.status == status
        openapi.check_answer("GET", path, answer)

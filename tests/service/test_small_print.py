"""Details of the contract and of the standards it cites, as programs from outside look at them."""

import email.utils
import gzip
import json
import time

import pytest
from checks import STRIPES
from websocket_client import WebSocketClient

NAMES = 128  # characters


def request(**fields):
    return {"solver": "discrete", "example": STRIPES, "seed": 1,
            "parameters": {"size": STRIPES["size"]}, **fields}


@pytest.mark.parametrize("method, path", [
    ("GET", "/healthz"), ("HEAD", "/v1/examples"), ("GET", "/nothing"), ("OPTIONS", "/v1/jobs")])
def test_answers_have_their_date(server, method, path):
    told = email.utils.parsedate_to_datetime(server.request(method, path).headers["date"])
    assert abs(told.timestamp() - time.time()) < 60


def test_handshakes_have_their_date(server):
    job = server.submit(STRIPES["size"], example=STRIPES)
    with WebSocketClient(server.port, f"/v1/jobs/{job['id']}/stream") as client:
        assert client.headers["date"].endswith(" GMT")


@pytest.mark.parametrize("query, status", [
    ("limit=-1", 422), ("limit=0", 422), ("limit=99999999999999999999999", 422),
    ("limit=1.5", 400), ("limit=", 400), ("limit=-", 400), ("limit=+1", 400)])
def test_a_number_out_of_range_is_one_all_the_same(server, query, status):
    assert server.get(f"/v1/jobs?{query}").status == status


@pytest.mark.parametrize("after, status", [
    ("99", 422), ("9223372036854775808", 422), ("99999999999999999999999", 422), ("-1", 422),
    ("x", 400)])
def test_events_do_not_begin_after_the_last(server, after, status):
    job = server.wait(server.submit(STRIPES["size"], example=STRIPES)["id"])
    path = f"/v1/jobs/{job['id']}/events"
    assert server.get(f"{path}?after={after}").status == status
    assert server.get(path, headers={"Last-Event-ID": after}).status == status


@pytest.mark.parametrize("cursor", ["", "zzz", "null", "01", "-1", "0", "%20", "1" * 40])
def test_a_cursor_is_one_that_was_given_out(server, cursor):
    for _ in range(2):
        server.submit(STRIPES["size"], example=STRIPES)
    given = server.get("/v1/jobs?limit=1").json()["next"]
    assert server.get(f"/v1/jobs?cursor={given}").status == 200
    assert server.get(f"/v1/jobs?cursor={given[:-1]}").status == 400
    assert server.get(f"/v1/jobs?cursor={cursor}").status == 400


@pytest.mark.parametrize("prefer", ['wait="20"', "wait=20", "respond-async, WAIT=20; x=1"])
def test_a_preference_is_a_word_or_a_string(server, prefer):
    answer = server.request("POST", "/v1/jobs", request(), {"Prefer": prefer})
    assert (answer.status, answer.headers["preference-applied"]) == (200, "wait=20")


@pytest.mark.parametrize("letter", ["a", "\u00fc", "\u65e5", "\U0001f600"])
def test_names_are_counted_in_characters(server, letter):
    for count, status in ((NAMES, 202), (NAMES + 1, 422)):
        answer = server.request("POST", "/v1/jobs", request(tags={letter * count: "x"}))
        assert answer.status == status, answer.body


@pytest.mark.parametrize("text, at", [
    ('{"solver":"discrete","solver":"discrete"}', 28),
    ('{"a":' + "[" * 70 + "]" * 70 + "}", 68),
    ('{"a":1e999}', 9), ('{"a":tru}', 8)])
def test_what_is_wrong_with_json_is_told_with_its_place(server, text, at):
    answer = server.request("POST", "/v1/jobs", text.encode(),
                            {"Content-Type": "application/json"})
    assert answer.status == 400
    assert f"(at byte {at})" in answer.json()["detail"], answer.body


@pytest.mark.parametrize("body", [
    b"", b"glTFxxxx", b"no glTF at all, but more than twenty bytes",
    b"glTF\x02\0\0\0\x1c\0\0\0\x08\0\0\0JSON{\"a\":]}"])
def test_what_is_no_binary_gltf_cannot_be_read(server, body):
    answer = server.request("POST", "/v1/examples", body, {"Content-Type": "model/gltf-binary"})
    assert answer.status == 400, answer.body
    assert answer.json()["type"] == "/problems/malformed-request"


def test_bodies_are_taken_as_they_are(server):
    body = json.dumps(request()).encode()
    answer = server.request("POST", "/v1/jobs", gzip.compress(body), {
        "Content-Encoding": "gzip", "Content-Type": "application/json"})
    assert (answer.status, answer.headers["accept-encoding"]) == (415, "identity")
    answer = server.request("POST", "/v1/jobs", body, {
        "Content-Encoding": "identity", "Content-Type": "application/json"})
    assert answer.status == 202


def test_a_failure_says_whose_it_is(server):
    impossible = request(example="castle", parameters={
        "size": [6, 6, 6], "boundary": {"bottom": "air", "west": "grass"}})
    answer = server.request("POST", "/v1/jobs", impossible, {"Prefer": "wait=30"}).json()
    assert answer["state"] == "failed"
    assert answer["error"]["instance"] == f"/v1/jobs/{answer['id']}"


def box(low, high, moved=0.0):
    corners = [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1])
               for z in (low[2], high[2])]
    corners[5][0] += moved
    return corners


FACES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
         [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]


# Of the directions of faces some are told apart, but not all the cells between them.
LOST = 5.4359436e-05


@pytest.mark.parametrize("moved", [LOST, 1e-5, 3e-5, 2e-4, 1e-3])
def test_boxes_that_are_not_quite_straight_do_not_end_the_server(server, moved):
    top = box((0, 3, 0), (4, 4, 4))
    top[7][2] += 0.012329101562
    example = {"kind": "continuous", "name": "tilted",
               "objects": [{"name": "roof"}, {"name": "stone"}],
               "polyhedra": [
                   {"object": "stone", "vertices": box((0, 0, 0), (4, 3, 4), moved),
                    "faces": FACES},
                   {"object": "roof", "vertices": top, "faces": FACES}]}
    answer = server.request("POST", "/v1/examples", example)
    assert answer.status in (201, 422), answer.body
    if moved == LOST:
        assert "so nearly the same" in answer.json()["errors"][0]["detail"]
    assert server.get("/healthz").status == 200


@pytest.mark.parametrize("query,pointers,status", [
    ("state=lost&limit=0&limits=1", ["/limit", "/limits", "/state"], 400),
    ("state=lost&limit=101", ["/limit", "/state"], 422),
    ("limit=ten&cursor=", ["/cursor", "/limit"], 400),
    ("limit=1&limit=2", ["/limit"], 400),
    ("a%2Fb~c=1", ["/a~1b~0c"], 400),
])
def test_all_that_is_wrong_with_a_query_is_told(server, query, pointers, status):
    answer = server.get(f"/v1/jobs?{query}")
    assert answer.status == status, answer.body
    told = answer.json()
    assert sorted(error["pointer"] for error in told["errors"]) == pointers
    assert all(error["detail"] for error in told["errors"])


@pytest.mark.parametrize("query,pointers", [
    ("profile=flat&compression=zip&alternative=x", ["/alternative", "/compression", "/profile"]),
    ("profile=", ["/profile"]),
])
def test_all_that_is_wrong_with_the_form_of_a_model_is_told(server, query, pointers):
    job = server.wait(server.submit((4, 4, 4))["id"])
    told = server.get(f"/v1/jobs/{job['id']}/model.glb?{query}").json()
    assert sorted(error["pointer"] for error in told["errors"]) == pointers


@pytest.mark.parametrize("method,path", [
    ("POST", "/v1/jobs"), ("POST", "/v1/jobs/{id}/cancel"), ("DELETE", "/v1/jobs/{id}"),
    ("GET", "/v1/jobs/{id}/preview.glb"), ("GET", "/v1/examples"), ("POST", "/v1/examples"),
    ("GET", "/v1/examples/castle"), ("DELETE", "/v1/examples/castle"),
    ("GET", "/v1/examples/castle/model.glb"), ("GET", "/v1/examples/castle/pieces.glb"),
    ("GET", "/v1/examples/castle/analysis"), ("GET", "/v1/examples/castle/success.svg"),
    ("GET", "/v1/examples/houses/figures.svg"), ("GET", "/v1/solvers"),
    ("GET", "/v1/solvers/discrete"), ("POST", "/v1/tickets"), ("GET", "/v1/limits"),
])
def test_a_parameter_that_a_resource_does_not_know_is_refused(server, method, path):
    job = server.wait(server.submit((4, 4, 4))["id"])
    path = path.replace("{id}", job["id"])
    answer = server.request(method, f"{path}?verbose=1", {} if method == "POST" else None)
    assert answer.status == 400, answer.body
    assert [error["pointer"] for error in answer.json()["errors"]] == ["/verbose"]
    assert server.get(f"/v1/jobs/{job['id']}").json()["state"] == "succeeded"


@pytest.mark.parametrize("path", ["/", "/docs", "/healthz", "/readyz", "/metrics"])
def test_pages_and_probes_take_any_parameter(server, path):
    assert server.get(f"{path}?from=mail").status == 200


def test_a_job_that_ended_before_its_first_block_has_no_preview_to_wait_for(server):
    job = server.submit((6, 4, 6), parameters={
        "size": [6, 4, 6], "constraints": [{"kind": "fixed", "pieces": ["grass"],
                                            "box": {"min": [0, 3, 0], "max": [6, 4, 6]}}]})
    assert server.wait(job["id"])["state"] == "failed"
    answer = server.get(f"/v1/jobs/{job['id']}/preview.glb")
    assert answer.status == 409 and answer.json()["type"] == "/problems/no-model", answer.body


@pytest.mark.parametrize("size", [[0, 4, 6], "large", [10 ** 6, 10 ** 6, 10 ** 6]], ids=str)
def test_unknown_names_are_told_beside_a_size_that_is_none(server, size):
    request = {"solver": "discrete", "example": "castle", "parameters": {
        "size": size, "boundary": {"bottom": "lava", "top": ["air", "stars"]},
        "weights": {"dragon": 2},
        "constraints": [{"kind": "fixed", "pieces": ["grass", "moat"], "cells": [[900, 0, 0]]}]}}
    told = {error["pointer"] for error in server.request("POST", "/v1/jobs", request).json()["errors"]}
    assert {pointer for pointer in told if not pointer.startswith("/parameters/size")} == {
        "/parameters/boundary/bottom", "/parameters/boundary/top/1", "/parameters/weights/dragon",
        "/parameters/constraints/0/pieces/1"}
    assert told & {"/parameters/size", "/parameters/size/0"}

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

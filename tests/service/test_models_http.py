"""Models over HTTP: entity tags, ranges, profiles, previews, and what is not there yet."""

import hashlib
import json
import struct

import pytest

from checks import (HILLS, STRIPES, assert_problem, endless_job, job_request, make_job, state_of,
                    together, wait_until)
from raw_http import Wire


@pytest.fixture(scope="module")
def model(server):
    """A finished job, its server and its model."""
    job = make_job(server, {"size": [16, 4, 16]}, example=HILLS)
    body = server.get(job["urls"]["model"]).body
    return server, job, body


def get(model, path=None, method="GET", **headers):
    server, job, _ = model
    return server.request(method, path or job["urls"]["model"],
                          headers={name.replace("_", "-"): value
                                   for name, value in headers.items()})


# --- the whole

def test_the_model_is_what_the_result_says(model):
    _, job, body = model
    answer = get(model)
    assert answer.status == 200
    assert answer.headers["content-type"] == "model/gltf-binary"
    assert len(answer.body) == int(answer.headers["content-length"]) == job["result"]["bytes"]
    assert hashlib.sha256(answer.body).hexdigest() == job["result"]["sha256"]
    assert answer.headers["accept-ranges"] == "bytes"
    assert struct.unpack("<4sII", body[:12]) == (b"glTF", 2, len(body))


def test_the_entity_tag_is_strong_and_stays_the_same(model):
    tag = get(model).headers["etag"]
    assert tag.startswith('"') and tag.endswith('"') and len(tag) > 2
    assert get(model).headers["etag"] == tag


def test_two_jobs_with_one_model_share_the_tag_and_other_models_do_not(model):
    server, job, _ = model
    same = make_job(server, {"size": [16, 4, 16]}, example=HILLS)
    other = make_job(server, {"size": [16, 4, 17]}, example=HILLS)
    tags = [server.get(which["urls"]["model"]).headers["etag"] for which in (job, same, other)]
    assert tags[0] == tags[1] != tags[2]


PROFILES = ["nodes", "instanced", "merged"]


@pytest.mark.parametrize("profile", PROFILES)
def test_each_profile_is_a_glb_with_a_tag_of_its_own(model, profile):
    _, job, _ = model
    path = f"{job['urls']['model']}?profile={profile}"
    answer = get(model, path)
    assert answer.status == 200
    assert struct.unpack("<4sII", answer.body[:12]) == (b"glTF", 2, len(answer.body))
    document = json.loads(answer.body[20:20 + struct.unpack("<I", answer.body[12:16])[0]])
    instancing = "EXT_mesh_gpu_instancing"
    assert (instancing in document.get("extensionsRequired", [])) == (profile == "instanced")
    assert get(model, path).body == answer.body
    assert get(model, path, If_None_Match=answer.headers["etag"]).status == 304
    part = get(model, path, Range="bytes=0-3")
    assert (part.status, part.body) == (206, b"glTF")


def test_no_two_profiles_share_a_tag_and_nodes_is_the_default(model):
    _, job, _ = model
    tags = [get(model, f"{job['urls']['model']}?profile={profile}").headers["etag"]
            for profile in PROFILES]
    assert len(set(tags)) == 3
    assert get(model).headers["etag"] == tags[0]
    assert get(model, f"{job['urls']['model']}?profile=nodes&compression=none").headers["etag"] == \
        tags[0]


def test_ten_clients_that_want_a_new_profile_at_once_all_get_it(server):
    job = make_job(server, {"size": [9, 4, 9]}, example=HILLS)
    answers = together(10, lambda number: server.get(
        f"{job['urls']['model']}?profile={PROFILES[number % 3]}"))
    assert {answer.status for answer in answers} == {200}
    assert len({answer.body for answer in answers}) == 3


@pytest.mark.parametrize(("query", "statuses"), [
    ("profile=fast", {422}), ("profile=", {422}), ("profile=Nodes", {422}),
    ("compression=draco", {422}), ("compression=", {422}), ("format=obj", {400, 422}),
    ("profile=nodes&profile=merged", {400, 422}),
])
def test_a_wrong_query_for_a_model_is_refused(model, query, statuses):
    _, job, _ = model
    answer = get(model, f"{job['urls']['model']}?{query}")
    assert answer.status in statuses
    assert_problem(answer, answer.status, instance=job["urls"]["model"])


# --- conditions (RFC 9110, section 13)

def conditions(tag):
    other = '"' + "0" * 64 + '"'
    return {
        "none match, same": ({"If-None-Match": tag}, 304),
        "none match, other": ({"If-None-Match": other}, 200),
        "none match, list": ({"If-None-Match": f"{other}, {tag}"}, 304),
        "none match, list without spaces": ({"If-None-Match": f"{other},{tag}"}, 304),
        "none match, weak": ({"If-None-Match": f"W/{tag}"}, 304),
        "none match, any": ({"If-None-Match": "*"}, 304),
        "none match, unquoted": ({"If-None-Match": tag.strip('"')}, 200),
        "none match, malformed": ({"If-None-Match": '"'}, 200),
        "none match before range": ({"If-None-Match": tag, "Range": "bytes=0-3"}, 304),
        "match, same": ({"If-Match": tag}, 200),
        "match, any": ({"If-Match": "*"}, 200),
        "match, other": ({"If-Match": other}, 412),
        "match, weak": ({"If-Match": f"W/{tag}"}, 412),
        "match before none match": ({"If-Match": other, "If-None-Match": tag}, 412),
        "match before range": ({"If-Match": tag, "Range": "bytes=0-3"}, 206),
        "if-range, same": ({"If-Range": tag, "Range": "bytes=0-3"}, 206),
        "if-range, other": ({"If-Range": other, "Range": "bytes=0-3"}, 200),
        "if-range, weak": ({"If-Range": f"W/{tag}", "Range": "bytes=0-3"}, 200),
        "if-range, date": ({"If-Range": "Sun, 06 Nov 1994 08:49:37 GMT", "Range": "bytes=0-3"},
                           200),
        "if-range, beyond": ({"If-Range": other, "Range": "bytes=999999999-"}, 200),
        "if-range without range": ({"If-Range": tag}, 200),
    }


@pytest.mark.parametrize("method", ["GET", "HEAD"])
@pytest.mark.parametrize("case", conditions('""'))
def test_conditions_are_kept_as_http_says(model, case, method):
    server, job, body = model
    tag = get(model).headers["etag"]
    headers, status = conditions(tag)[case]
    if method == "HEAD" and status == 206:
        status = 200  # a range is for GET alone
    answer = server.request(method, job["urls"]["model"], headers=headers)
    assert answer.status == status
    if status in (200, 206, 304):
        assert answer.headers["etag"] == tag
    if method == "HEAD" or status == 304:
        assert answer.body == b""
    elif status in (200, 206):
        assert answer.body == (body if status == 200 else body[:4])
    if status == 304:
        assert "content-range" not in answer.headers


def test_a_list_of_tags_may_be_spread_over_two_header_lines(model):
    server, job, _ = model
    tag = get(model).headers["etag"].encode()
    for name, status in ((b"If-None-Match", 304), (b"If-Match", 200)):
        with Wire(server) as wire:
            wire.send(b"GET " + job["urls"]["model"].encode() + b" HTTP/1.1\r\nHost: x\r\n" +
                      name + b': "other"\r\n' + name + b": " + tag + b"\r\n\r\n")
            assert wire.answer().status == status


# --- ranges

def ranges(size):
    return {
        "bytes=0-0": (0, 0), "bytes=0-3": (0, 3), "bytes=4-": (4, size - 1),
        "bytes=-4": (size - 4, size - 1), f"bytes=0-{size - 1}": (0, size - 1),
        f"bytes=0-{size}": (0, size - 1), "bytes=0-999999999999": (0, size - 1),
        f"bytes=-{size * 2}": (0, size - 1), f"bytes={size - 1}-": (size - 1, size - 1),
        "bytes=100-199": (100, 199), "bytes= 5-6": (5, 6),
    }


@pytest.mark.parametrize("number", range(len(ranges(1000))))
def test_one_range_is_answered_with_just_it(model, number):
    _, _, body = model
    text, (first, last) = list(ranges(len(body)).items())[number]
    answer = get(model, Range=text)
    assert answer.status == 206
    assert answer.body == body[first:last + 1]
    assert answer.headers["content-range"] == f"bytes {first}-{last}/{len(body)}"
    assert int(answer.headers["content-length"]) == len(answer.body)
    assert answer.headers["content-type"] == "model/gltf-binary"


@pytest.mark.parametrize("place", ["at the end", "far beyond", "none from the end"])
def test_a_range_beyond_the_file_is_416_and_tells_the_size(model, place):
    _, job, body = model
    text = {"at the end": f"bytes={len(body)}-", "far beyond": "bytes=99999999999-",
            "none from the end": "bytes=-0"}[place]
    answer = get(model, Range=text)
    assert_problem(answer, 416, instance=job["urls"]["model"])
    assert answer.headers["content-range"] == f"bytes */{len(body)}"


@pytest.mark.parametrize("text", [
    "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=5-2", "bytes=1", "bytes=1-2-3", "items=0-5",
    "bytes=--5", "bytes=0x0-0x5", "bytes=+1-5", "0-5", "bytes=0-1;2-3", ",",
])
def test_a_range_that_is_none_is_ignored(model, text):
    _, _, body = model
    answer = get(model, Range=text)
    assert answer.status == 200 and answer.body == body


@pytest.mark.parametrize("text", ["bytes=0-1,4-5", "bytes=0-0, -1",
                                  "bytes=" + "0-1," * 400 + "0-1"],
                         ids=["two", "both ends", "very many"])
def test_several_ranges_are_answered_whole_or_in_parts(model, text):
    _, _, body = model
    answer = get(model, Range=text)
    assert answer.status in (200, 206)
    assert answer.status == 206 or answer.body == body
    assert len(answer.body) < 3 * len(body) + 100_000


def test_a_download_can_be_resumed_in_pieces(model):
    _, _, body = model
    tag = get(model).headers["etag"]
    parts = [get(model, Range=f"bytes={at}-{at + 9999}", If_Range=tag)
             for at in range(0, len(body), 10_000)]
    assert {part.status for part in parts} == {206}
    assert b"".join(part.body for part in parts) == body


# What two answers never have in common.
OF_ONE_ANSWER = {"date", "x-request-id"}


# --- HEAD

@pytest.mark.parametrize("path", ["model", "labels", "preview", "self"])
def test_head_says_what_get_would_and_sends_nothing(model, path):
    _, job, _ = model
    whole, head = (get(model, job["urls"][path], method) for method in ("GET", "HEAD"))
    assert whole.status == head.status == 200
    assert head.body == b""
    assert {name: value for name, value in head.headers.items() if name not in OF_ONE_ANSWER} == \
        {name: value for name, value in whole.headers.items() if name not in OF_ONE_ANSWER}


def test_head_of_what_is_not_there_has_no_body(server):
    answer = server.request("HEAD", "/v1/jobs/nope/model.glb")
    assert answer.status == 404 and answer.body == b""
    assert int(answer.headers["content-length"]) > 0


# --- labels and previews

def test_labels_have_a_tag_too(model):
    _, job, _ = model
    answer = get(model, job["urls"]["labels"])
    assert answer.headers["content-type"] == "application/json"
    labels = answer.json()
    assert len(labels["cells"]) == 16 * 4 * 16
    assert get(model, job["urls"]["labels"], If_None_Match=answer.headers["etag"]).status == 304


def test_the_preview_of_a_finished_job_is_its_model(model):
    _, job, body = model
    assert get(model, job["urls"]["preview"]).body == body


def test_a_preview_grows_while_the_job_is_running(make_server):
    server = make_server(workers=1)
    with endless_job(server) as job:
        answer = wait_until(lambda: (lambda got: got if got.status == 200 else None)(
            server.get(job["urls"]["preview"])))
        assert answer.headers["content-type"] == "model/gltf-binary"
        assert struct.unpack("<4sII", answer.body[:12]) == (b"glTF", 2, len(answer.body))
        wait_until(lambda: server.get(job["urls"]["preview"]).headers["etag"] !=
                   answer.headers["etag"])
        for name in ("model", "labels"):
            assert_problem(server.get(job["urls"][name]), 409, "not-finished", job["urls"][name])
        for profile in PROFILES:
            assert_problem(server.get(f"{job['urls']['model']}?profile={profile}"), 409,
                           "not-finished")
    # What there was of a cancelled job stays to be looked at.
    assert server.get(job["urls"]["preview"]).body[:4] == b"glTF"
    for name in ("model", "labels"):
        assert_problem(server.get(job["urls"][name]), 409)


def test_a_queued_job_has_neither_model_nor_preview(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        job = server.request("POST", "/v1/jobs", job_request()).json()
        assert state_of(server, job) == "queued"
        for name in ("model", "labels", "preview"):
            problem = assert_problem(server.get(job["urls"][name]), 409, "not-finished",
                                     job["urls"][name])
            assert problem["detail"]


def test_a_job_that_never_began_has_no_preview(server):
    job = make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}},
                   example=STRIPES)
    assert job["state"] == "failed"
    for name in ("model", "labels", "preview"):
        assert_problem(server.get(job["urls"][name]), 409)


def test_the_model_of_a_failed_job_is_not_said_to_be_on_its_way(server):
    job = make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}})
    problem = assert_problem(server.get(job["urls"]["model"]), 409)
    assert problem["type"] != "/problems/not-finished"


def test_an_expired_model_is_gone_but_its_job_is_known(make_server):
    server = make_server("--retention-hours", 0.001)  # 3.6 seconds
    job = make_job(server)
    assert server.get(job["urls"]["model"]).status == 200
    wait_until(lambda: server.get(job["urls"]["model"]).status == 410, timeout=10)
    for name in ("model", "labels", "preview"):
        assert_problem(server.get(job["urls"][name]), 410, "expired", job["urls"][name])
    assert server.get(job["urls"]["self"]).json()["state"] == "succeeded"
    assert server.get("/v1/jobs/00000000000000000000000000/model.glb").status == 404

"""What a resource can be had as: content codings, compressed models, long polls, pages, HEAD."""

import gzip
import hashlib
import json
import re
import time

import pytest

from checks import (HILLS, assert_problem, endless_job, files_of, job_request,
                    make_job, together, wait_until)
from glb_file import INSTANCING, GlbFile
from raw_http import Wire
from test_continuous import make, textured_hut
from test_gltf import PROFILES, run_tool, tools  # noqa: F401 (a fixture)
from workload import YARD

MESHOPT = "EXT_meshopt_compression"
GZIP = {"Accept-Encoding": "gzip"}


@pytest.fixture(scope="module")
def job(server):
    return make_job(server, {"size": [16, 4, 16]}, example=HILLS)


@pytest.fixture(scope="module")
def paths(server, job):
    """Everything that has a strong tag, by name."""
    solids = make(server)
    return {
        "model": job["urls"]["model"],
        "merged": job["urls"]["model"] + "?profile=merged",
        "meshopt": job["urls"]["model"] + "?profile=instanced&compression=meshopt",
        "model of solids": solids["urls"]["model"] + "?compression=meshopt",
        "preview": job["urls"]["preview"],
        "labels": job["urls"]["labels"],
        "job": job["urls"]["self"],
        "example": "/v1/examples/castle",
        "examples": "/v1/examples",
        "example's model": "/v1/examples/castle/model.glb",
        "pieces": "/v1/examples/castle/pieces.glb",
        "analysis": "/v1/examples/castle/analysis",
        "success": "/v1/examples/castle/success.svg",
        "figures": "/v1/examples/domes/figures.svg",
        "figure": "/v1/examples/domes/figures.svg?figure=3",
        "solvers": "/v1/solvers",
        "solver": "/v1/solvers/continuous",
    }


NAMES = ["model", "merged", "meshopt", "model of solids", "preview", "labels", "job", "example",
         "examples", "example's model", "pieces", "analysis", "success", "figures", "figure",
         "solvers", "solver"]


# --- codings

@pytest.mark.parametrize("name", NAMES)
def test_each_coding_has_a_tag_of_its_own_and_the_same_content(server, paths, name):
    plain = server.get(paths[name])
    coded = server.get(paths[name], headers=GZIP)
    assert plain.status == coded.status == 200
    assert plain.headers["etag"] == f'"{hashlib.sha256(plain.body).hexdigest()}"'
    assert coded.headers["etag"] == plain.headers["etag"][:-1] + '-gzip"'
    assert coded.headers["content-encoding"] == "gzip" and "content-encoding" not in plain.headers
    assert coded.headers["vary"] == plain.headers["vary"] == "Accept-Encoding, Origin"
    assert plain.headers["accept-ranges"] == "bytes" and "accept-ranges" not in coded.headers
    assert coded.headers["content-type"] == plain.headers["content-type"]
    assert gzip.decompress(coded.body) == plain.body
    assert len(coded.body) < len(plain.body)
    assert coded.body[4:8] == bytes(4), "a time in a file that is to be repeatable"
    assert server.get(paths[name], headers=GZIP).body == coded.body


@pytest.mark.parametrize("name", NAMES)
def test_conditions_and_ranges_are_those_of_the_coding(server, paths, name):
    path = paths[name]
    whole = server.get(path)
    plain, coded = whole.headers["etag"], server.get(path, headers=GZIP).headers["etag"]

    def status(**headers):
        return server.get(path, headers={key.replace("_", "-"): value
                                         for key, value in headers.items()}).status

    assert status(If_None_Match=plain) == 304
    assert status(If_None_Match=coded) == 200
    assert status(If_None_Match=coded, Accept_Encoding="gzip") == 304
    assert status(If_None_Match=plain, Accept_Encoding="gzip") == 200
    assert status(If_Match=plain, Accept_Encoding="gzip") == 412
    assert status(If_Match=coded, Accept_Encoding="gzip") == 200
    unchanged = server.get(path, headers={**GZIP, "If-None-Match": coded})
    assert (unchanged.status, unchanged.body) == (304, b"")
    assert (unchanged.headers["etag"], unchanged.headers["vary"]) == (coded, "Accept-Encoding, Origin")

    part = server.get(path, headers={**GZIP, "Range": "bytes=2-9"})
    assert (part.status, part.body, part.headers["etag"]) == (206, whole.body[2:10], plain)
    assert "content-encoding" not in part.headers
    assert part.headers["vary"] == "Accept-Encoding, Origin"
    assert status(Range="bytes=2-9", If_Range=plain, Accept_Encoding="gzip") == 206
    moved = server.get(path, headers={**GZIP, "Range": "bytes=2-9", "If-Range": coded})
    assert (moved.status, moved.body) == (200, whole.body)
    beyond = server.get(path, headers={**GZIP, "Range": "bytes=99999999-"})
    assert beyond.headers["content-range"] == f"bytes */{len(whole.body)}"
    assert_problem(beyond, 416)


@pytest.mark.parametrize(("accepted", "coding"), [
    (None, None), ("", None), ("br", None), ("identity", None), ("gzip", "gzip"),
    ("x-gzip", "gzip"), ("*", "gzip"), ("gzip, deflate, br, zstd", "gzip"), ("gzip;q=0", None),
    ("*;q=0, gzip", "gzip"), ("gzip;q=0.2, identity;q=0.3", None), ("br, *;q=0.1", "gzip"),
    ("gzip;q=0.001", "gzip"), ("identity;q=0, gzip;q=0.5", "gzip"), ("gzip;q=7", None),
])
@pytest.mark.parametrize("name", ["model", "labels"])
def test_the_weights_of_codings_are_kept(server, paths, name, accepted, coding):
    answer = server.get(paths[name], headers={} if accepted is None else
                        {"Accept-Encoding": accepted})
    assert answer.status == 200
    assert answer.headers.get("content-encoding") == coding
    assert answer.headers["vary"] == "Accept-Encoding, Origin"


@pytest.mark.parametrize("accepted", ["identity;q=0", "*;q=0", "gzip;q=0, *;q=0", "br, *;q=0"])
def test_who_takes_no_coding_and_nothing_as_it_is_is_told(server, paths, accepted):
    answer = server.get(paths["model"], headers={"Accept-Encoding": accepted})
    assert_problem(answer, 406)
    assert answer.headers["vary"] == "Accept-Encoding, Origin"
    # What was done is told in any case.
    posted = server.request("POST", "/v1/jobs", job_request(), headers={
        "Accept-Encoding": accepted})
    assert posted.status == 202 and posted.json()["id"]


def test_a_range_is_left_out_for_who_takes_nothing_as_it_is(server, paths):
    answer = server.get(paths["model"], headers={
        "Accept-Encoding": "gzip, identity;q=0", "Range": "bytes=0-3"})
    assert (answer.status, answer.headers["content-encoding"]) == (200, "gzip")
    assert gzip.decompress(answer.body) == server.get(paths["model"]).body


def test_answers_that_no_tag_can_have_are_coded_when_they_are_long(server):
    long = server.request("POST", "/v1/jobs", job_request(), headers={**GZIP, "Prefer": "wait=60"})
    assert long.status == 200 and long.headers["content-encoding"] == "gzip"
    assert len(gzip.decompress(long.body)) >= 1024
    assert json.loads(gzip.decompress(long.body))["state"] == "succeeded"
    faults = {**job_request(), **{f"field {number}": 1 for number in range(40)}}
    refused = server.request("POST", "/v1/jobs", faults, headers=GZIP)
    assert refused.status == 422 and refused.headers["content-encoding"] == "gzip"
    assert len(json.loads(gzip.decompress(refused.body))["errors"]) == 40
    for path in ("/healthz", "/v1/jobs/nope"):
        short = server.get(path, headers=GZIP)
        assert len(short.body) < 1024 and "content-encoding" not in short.headers
        assert short.headers["vary"] == "Accept-Encoding, Origin" and short.json()


def test_events_are_never_coded(server, job):
    answer = server.get(job["urls"]["events"], headers=GZIP)
    assert "content-encoding" not in answer.headers and answer.headers["vary"] == "Origin"
    assert len(answer.body) > 1024 and answer.body.startswith(b"retry:")


def test_a_coded_model_is_made_once_and_goes_with_its_job(make_server):
    server = make_server()
    job = make_job(server, {"size": [16, 4, 16]}, example=HILLS)
    path = f"{job['urls']['model']}?profile=merged&compression=meshopt"
    before = files_of(server, "artifacts")
    answers = together(8, lambda _: server.get(path, headers=GZIP))
    assert {answer.status for answer in answers} == {200}
    assert len({answer.body for answer in answers}) == 1
    kept = files_of(server, "artifacts")
    assert len(kept) == len(before) + 2  # the file, and the file coded
    assert hashlib.sha256(answers[0].body).hexdigest() in " ".join(kept).replace("/", "")
    server.stop()
    server.start()
    assert server.get(path, headers=GZIP).body == answers[0].body
    assert files_of(server, "artifacts") == kept
    assert server.request("DELETE", job["urls"]["self"]).status == 204
    wait_until(lambda: not files_of(server, "artifacts", "tmp"))


# --- compressed models

class Pair:
    """A model in a profile, as it is and compressed."""

    def __init__(self, server, job, profile, query=""):
        path = f"{job['urls']['model']}?profile={profile}{query}"
        self.plain, self.packed = (server.get(path + suffix)
                                   for suffix in ("", "&compression=meshopt"))
        assert self.plain.status == self.packed.status == 200
        assert self.plain.headers["etag"] != self.packed.headers["etag"]


@pytest.fixture(scope="module")
def pairs(server):
    jobs = {"yard": make_job(server, {"size": [37, 5, 19], "weights": "uniform"}, example=YARD),
            "castle": make_job(server, {"size": [18, 8, 18]}, example="castle"),
            "textures": make(server, example=textured_hut()),
            "houses": make(server, example="houses", parameters={"size": [12, 6, 12]}),
            "domes": make(server, example="domes", parameters={"size": [12, 8, 12]})}
    return {f"{name}, {profile}": Pair(server, job, profile)
            for name, job in jobs.items() for profile in PROFILES}


@pytest.fixture(scope="module")
def pair_files(pairs, tmp_path_factory):
    directory = tmp_path_factory.mktemp("pairs")
    files = {}
    for number, (name, pair) in enumerate(pairs.items()):
        for form in ("plain", "packed"):
            files[name, form] = directory / f"{number}-{form}.glb"
            files[name, form].write_bytes(getattr(pair, form).body)
    return files


def test_a_compressed_model_requires_its_extension_and_is_smaller(pairs):
    for name, pair in pairs.items():
        document = GlbFile(pair.packed.body).json
        wanted = {MESHOPT} | ({INSTANCING} if name.endswith("instanced") else set())
        assert set(document["extensionsRequired"]) == set(document["extensionsUsed"]) == wanted
        # Of a small model the text that tells of the extension is the larger part.
        sizes = [len(GlbFile(answer.body).binary) for answer in (pair.packed, pair.plain)]
        assert sizes[0] < sizes[1] * 0.8, name
        assert name.startswith("yard") or len(pair.packed.body) < len(pair.plain.body) * 0.8
        stored, fallback = document["buffers"]
        assert "uri" not in fallback and fallback["extensions"] == {MESHOPT: {"fallback": True}}
        packed = [view for view in document["bufferViews"] if "extensions" in view]
        assert all(view["buffer"] == 1 for view in packed) and packed
        ends = [view["extensions"][MESHOPT]["byteOffset"] + view["extensions"][MESHOPT]["byteLength"]
                for view in packed]
        assert max(ends) <= stored["byteLength"]
        assert max(view["byteOffset"] + view["byteLength"] for view in packed) \
            <= fallback["byteLength"]


def test_the_images_of_a_compressed_model_stay_as_they_are(pairs):
    for profile in PROFILES:
        document = GlbFile(pairs[f"textures, {profile}"].packed.body).json
        views = [document["bufferViews"][image["bufferView"]] for image in document["images"]]
        assert [view["buffer"] for view in views] == [0]


def test_the_khronos_validator_finds_nothing_wrong_with_compressed_models(tools, pair_files):  # noqa: F811
    files = {name: path for (name, form), path in pair_files.items() if form == "packed"}
    reports = run_tool(tools, "validate.mjs", files)
    assert len(reports) == 15
    assert {name: report["messages"] for name, report in reports.items()
            if report["errors"] or report["warnings"]} == {}


def test_a_compressed_model_decoded_has_every_byte_of_the_model(tools, pair_files, pairs):  # noqa: F811
    views = run_tool(tools, "decode_meshopt.mjs", pair_files)
    for name, pair in pairs.items():
        assert views[name, "packed"] == views[name, "plain"] != [], name
        plain, packed = (GlbFile(answer.body).json for answer in (pair.plain, pair.packed))
        for part in ("accessors", "meshes", "materials", "nodes", "scenes", "images"):
            assert packed.get(part) == plain.get(part), (name, part)


def test_three_draws_a_compressed_model_as_the_model(tools, pair_files, pairs):  # noqa: F811
    drawn = run_tool(tools, "load_three.mjs", pair_files)
    for name in pairs:
        assert drawn[name, "packed"] == drawn[name, "plain"], name
        assert drawn[name, "packed"]["triangles"] > 0


def test_a_compressed_model_has_the_same_bytes_on_every_server(make_server, server):
    request = {"parameters": {"size": [9, 4, 9]}, "example": HILLS}
    tags = []
    for each in (server, make_server(workers=1)):
        model = make_job(each, **request)["urls"]["model"]
        tags.append([each.get(f"{model}?profile={profile}&compression=meshopt").headers["etag"]
                     for profile in PROFILES])
    assert tags[0] == tags[1] and len(set(tags[0])) == 3


def test_an_alternative_can_be_had_compressed_and_coded(server):
    job = make_job(server, {"size": [12, 4, 12], "weights": "uniform"}, example=HILLS,
                   alternatives=2)
    first, second = (Pair(server, job, "merged", f"&alternative={number}") for number in (0, 1))
    assert first.packed.body != second.packed.body
    path = f"{job['urls']['model']}?alternative=1&profile=merged&compression=meshopt"
    assert gzip.decompress(server.get(path, headers=GZIP).body) == second.packed.body


def test_a_model_of_nothing_can_be_had_compressed(server):
    nothing = {"kind": "discrete", "name": "nothing", "pieces": [{"name": "air"}],
               "size": [2, 2, 2], "cells": [0] * 8, "empty": "air"}
    job = make_job(server, {"size": [2, 2, 2]}, example=nothing)
    path = job["urls"]["model"]
    assert server.get(f"{path}?compression=meshopt").body == server.get(path).body


def test_a_compressed_model_is_no_example(server, pairs):
    answer = server.request("POST", "/v1/examples", pairs["houses, merged"].packed.body,
                            headers={"Content-Type": "model/gltf-binary"})
    problem = assert_problem(answer, 422)
    assert MESHOPT in json.dumps(problem)


# --- long polls

def poll(server, job, **query):
    fields = "&".join(f"{name}={value}" for name, value in query.items())
    return server.get(f"/v1/jobs/{job['id']}?{fields}", timeout=90)


def test_a_job_tells_its_newest_event(server, job):
    events = server.events(job["id"])
    assert job["seq"] == events[-1]["seq"] == server.get(job["urls"]["self"]).json()["seq"]
    listed = {each["id"]: each["seq"] for each in server.get("/v1/jobs?limit=100").json()["items"]}
    assert listed[job["id"]] == job["seq"]


def test_polling_a_job_tells_of_its_events_until_it_has_ended(make_server):
    server = make_server(workers=1)
    with endless_job(server, wait_running=False) as job:
        seqs = [job["seq"]]
        assert seqs == [1]
        while len(seqs) < 12:
            answer = poll(server, job, wait=60, since=seqs[-1])
            assert answer.status == 200
            seqs.append(answer.json()["seq"])
        assert all(a < b for a, b in zip(seqs, seqs[1:]))
        # What has come already is told at once, and without a wait.
        assert poll(server, job, wait=60, since=1).json()["seq"] >= seqs[-1]
        assert poll(server, job, since=0).json()["seq"] >= seqs[-1]
        assert server.request("POST", job["urls"]["cancel"]).status == 200
        ended = server.wait(job["id"])
    assert ended["seq"] == server.events(job["id"])[-1]["seq"]
    for query in ({"wait": 60, "since": ended["seq"]}, {"wait": 60}, {"wait": 9007199254740991}):
        assert poll(server, job, **query).json() == ended


def test_a_poll_waits_no_longer_than_it_is_told(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        waiting = server.submit()
        begun = time.monotonic()
        answer = poll(server, waiting, wait=1, since=1)
        assert time.monotonic() - begun >= 0.9
        assert (answer.status, answer.json()["state"], answer.json()["seq"]) == (200, "queued", 1)
        unchanged = server.get(f"{waiting['urls']['self']}?wait=1&since=1",
                               headers={"If-None-Match": answer.headers["etag"]})
        assert (unchanged.status, unchanged.body) == (304, b"")
        # Without `since`, what has come by now is known. The job is cancelled while one waits.
        polls = together(3, lambda number: poll(server, waiting, wait=60) if number < 2 else
                         wait_until(lambda: server.request("POST", waiting["urls"]["cancel"])))
        assert [answer.json()["state"] for answer in polls[:2]] == ["cancelled"] * 2


def test_a_poll_ends_when_its_job_is_deleted(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        waiting = server.submit()
        with Wire(server, timeout=90) as wire:
            wire.send(b"GET /v1/jobs/%s?wait=60&since=1 HTTP/1.1\r\nHost: x\r\n\r\n"
                      % waiting["id"].encode())
            assert server.request("DELETE", waiting["urls"]["self"]).status == 204
            assert wire.answer().status == 404


def test_a_job_has_a_tag_that_changes_with_it(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        waiting = server.submit()
        first = server.get(waiting["urls"]["self"])
        assert server.get(waiting["urls"]["self"],
                          headers={"If-None-Match": first.headers["etag"]}).status == 304
        server.request("POST", waiting["urls"]["cancel"])
        second = server.get(waiting["urls"]["self"],
                            headers={"If-None-Match": first.headers["etag"]})
        assert (second.status, second.json()["state"]) == (200, "cancelled")


@pytest.mark.parametrize(("query", "status", "place"), [
    ("wait=", 400, "wait"), ("wait=-1", 422, "wait"), ("wait=1.5", 400, "wait"),
    ("wait=long", 400, "wait"), ("wait=99999999999999999999", 422, "wait"),
    ("wait=9007199254740992", 422, "wait"), ("since=x", 400, "since"), ("since=-1", 422, "since"),
    ("wait=1&since=", 400, "since"), ("wait=1&since=9999", 422, "since"),
    ("since=9999", 422, "since"), ("wait=1&wait=2", 400, "wait"), ("after=1", 400, "after"),
])
def test_a_poll_that_makes_no_sense_is_refused_with_the_place(server, job, query, status, place):
    answer = server.get(f"{job['urls']['self']}?{query}")
    problem = assert_problem(answer, status, instance=job["urls"]["self"])
    assert f'"{place}"' in problem["detail"]


# --- pages

def test_pages_show_what_is_there_all_the_time_exactly_once(make_server):
    server = make_server(workers=1)
    with endless_job(server):
        old = [server.submit() for _ in range(24)]
        stays = {job["id"] for job in old[::2]}
        to_delete, to_cancel = old[1::4], old[3::4]
        for query in ("limit=3&state=queued", "limit=2"):
            seen, cursor = [], None
            while cursor is not None or not seen:
                page = server.get(f"/v1/jobs?{query}" + (f"&cursor={cursor}" if cursor else ""))
                items, cursor = page.json()["items"], page.json()["next"]
                seen += [job["id"] for job in items]
                # Before the page, behind it or on it, and the one that the cursor was made from.
                server.submit()
                if to_delete and to_cancel:
                    assert server.request("DELETE", to_delete.pop()["urls"]["self"]).status == 204
                    assert server.request("POST", to_cancel.pop(0)["urls"]["cancel"]).status == 200
                last = items[-1]
                if last["id"] in [job["id"] for job in to_delete]:
                    to_delete = [job for job in to_delete if job["id"] != last["id"]]
                    assert server.request("DELETE", last["urls"]["self"]).status == 204
            assert len(seen) == len(set(seen))
            assert stays <= set(seen)
            assert seen == sorted(seen, reverse=True)
        assert to_delete == [] or to_cancel == []


# --- HEAD

def lasting(headers):
    """What does not differ between two answers that are equal."""
    return {name: value for name, value in headers.items() if name not in ("date", "x-request-id")}


@pytest.mark.parametrize("headers", [{}, GZIP, {"If-Match": '"other"'}, {"If-None-Match": "*"},
                                     {"Accept-Encoding": "identity;q=0"}],
                         ids=["plain", "gzip", "changed", "known", "nothing taken"])
def test_head_is_get_without_the_body_everywhere(server, paths, job, headers):
    failed = make_job(server, {"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}})
    assert failed["state"] == "failed"
    everywhere = [*paths.values(), "/v1/jobs", "/v1/jobs?limit=1", "/v1/jobs?limit=x",
                  "/v1/jobs?state=failed", job["urls"]["events"], job["urls"]["stream"],
                  f"{job['urls']['events']}?after={job['seq']}", failed["urls"]["self"],
                  failed["urls"]["model"], failed["urls"]["preview"], "/v1/jobs/nope/model.glb",
                  "/v1/jobs/nope/labels.json", "/v1/jobs/nope", "/v1/examples/nope",
                  "/v1/solvers/nope", "/problems/contradiction", "/problems/nope", "/healthz",
                  "/readyz", "/nope", f"{job['urls']['model']}?profile=x"]
    for path in everywhere:
        whole, head = (server.request(method, path, headers=headers) for method in ("GET", "HEAD"))
        assert (head.status, head.body) == (whole.status, b""), path
        assert lasting(head.headers) == lasting(whole.headers), path


def test_head_becomes_no_websocket(server, job):
    with Wire(server) as wire:
        wire.send(b"HEAD %s HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                  b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                  b"Sec-WebSocket-Protocol: modelsynth.v1\r\n\r\n"
                  % job["urls"]["stream"].encode())
        assert wire.answer(head_only=True).status == 426
        assert wire.send(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n").answer().status == 200


# --- drawings

def test_a_drawing_is_told_apart_from_another_by_its_tag(server):
    urls = ["/v1/examples/castle/success.svg", "/v1/examples/domes/figures.svg",
            "/v1/examples/houses/figures.svg", "/v1/examples/domes/figures.svg?figure=0",
            "/v1/examples/domes/figures.svg?figure=1"]
    answers = [server.get(url) for url in urls]
    assert {answer.headers["content-type"] for answer in answers} == {"image/svg+xml"}
    tags = [answer.headers["etag"] for answer in answers]
    assert len(set(tags)) == len(tags)
    assert all(re.fullmatch('"[0-9a-f]{64}"', tag) for tag in tags)

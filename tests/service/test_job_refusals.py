"""Job requests that are refused, each with its place."""

import json
import re

import pytest

from checks import (STRIPES, assert_faults, assert_problem, compact, job_request, pointers,
                    post_job, resolves, short)


# --- what is refused

GOOD = job_request()
FIXED = {"kind": "fixed", "pieces": ["red"]}


def with_(**parameters):
    return job_request(parameters)


@pytest.mark.parametrize(("request_", "expected"), [
    ({}, ["/solver", "/example"]),
    ([], [""]), (7, [""]), ("text", [""]), (None, [""]), (True, [""]),
    ({"solver": "discrete"}, ["/example"]),
    ({**GOOD, "solver": "quantum"}, ["/solver"]),
    ({**GOOD, "solver": None}, ["/solver"]),
    ({**GOOD, "example": 7}, ["/example"]),
    ({**GOOD, "example": None}, ["/example"]),
    ({**GOOD, "example": "no such example"}, ["/example"]),
    ({**GOOD, "example": "../../etc/passwd"}, ["/example"]),
    ({**GOOD, "example": "n" * 100_000}, ["/example"]),
    ({**GOOD, "seed": -1}, ["/seed"]), ({**GOOD, "seed": 2**53}, ["/seed"]),
    ({**GOOD, "seed": 2**64}, ["/seed"]), ({**GOOD, "seed": 10**40}, ["/seed"]),
    ({**GOOD, "seed": 1.5}, ["/seed"]), ({**GOOD, "seed": "7"}, ["/seed"]),
    ({**GOOD, "seed": None}, ["/seed"]), ({**GOOD, "seed": True}, ["/seed"]),
    ({**GOOD, "priority": 11}, ["/priority"]), ({**GOOD, "priority": -11}, ["/priority"]),
    ({**GOOD, "priority": 0.5}, ["/priority"]), ({**GOOD, "priority": False}, ["/priority"]),
    ({**GOOD, "deadline": 0}, ["/deadline"]), ({**GOOD, "deadline": -1}, ["/deadline"]),
    ({**GOOD, "deadline": "30"}, ["/deadline"]), ({**GOOD, "deadline": 1e300}, ["/deadline"]),
    ({**GOOD, "tags": []}, ["/tags"]), ({**GOOD, "tags": {"a": 1}}, ["/tags/a"]),
    ({**GOOD, "tags": {"a/b~c": None}}, ["/tags/a~1b~0c"]),
    ({**GOOD, "tags": {str(i): "" for i in range(200)}}, ["/tags"]),
    ({**GOOD, "bogus": 1}, ["/bogus"]), ({**GOOD, "a/b~c": 1}, ["/a~1b~0c"]),
    ({**GOOD, "": 1}, ["/"]), ({**GOOD, "Seed": 1}, ["/Seed"]),
    ({**GOOD, "parameters": None}, ["/parameters"]), ({**GOOD, "parameters": []}, ["/parameters"]),
    (with_(colour="red"), ["/parameters/colour"]),
    (with_(size=[6, 2]), ["/parameters/size"]), (with_(size=[6, 2, 4, 1]), ["/parameters/size"]),
    (with_(size="6x2x4"), ["/parameters/size"]), (with_(size=None), ["/parameters/size"]),
    (with_(size=[0, 2, 4]), ["/parameters/size/0"]), (with_(size=[6, -2, 4]),
                                                      ["/parameters/size/1"]),
    (with_(size=[6, 2, 4.5]), ["/parameters/size/2"]),
    (with_(size=[0, "2", None]), [f"/parameters/size/{i}" for i in range(3)]),
    (with_(size=[2**31, 2**32, 2**64]), [f"/parameters/size/{i}" for i in range(3)]),
    (with_(blocks=5), ["/parameters/blocks"]), (with_(blocks=False), ["/parameters/blocks"]),
    (with_(blocks={"size": [0, 1, 1]}), ["/parameters/blocks/size/0"]),
    (with_(blocks={"overlap": 1}), ["/parameters/blocks/overlap"]),
    (with_(blocks={"overlap": -0.1}), ["/parameters/blocks/overlap"]),
    (with_(blocks={"passes": 0}), ["/parameters/blocks/passes"]),
    (with_(blocks={"attempts": 0}), ["/parameters/blocks/attempts"]),
    (with_(blocks={"attempts": "8"}), ["/parameters/blocks/attempts"]),
    (with_(blocks={"stride": 3}), ["/parameters/blocks/stride"]),
    (with_(boundary=[]), ["/parameters/boundary"]), (with_(boundary="free"),
                                                     ["/parameters/boundary"]),
    (with_(boundary={"up": "free"}), ["/parameters/boundary/up"]),
    (with_(boundary={"top": 3}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": None}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": []}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": ["air", 3]}), ["/parameters/boundary/top/1"]),
    (with_(boundary={"top": ["air", "cloud"]}), ["/parameters/boundary/top/1"]),
    (with_(boundary={"top": "cloud"}), ["/parameters/boundary/top"]),
    (with_(boundary={"west": "periodic"}), ["/parameters/boundary/west"]),
    (with_(boundary={"east": "periodic", "west": "red"}), ["/parameters/boundary/east"]),
    (with_(boundary={"south": "periodic"}), ["/parameters/boundary/south"]),
    (with_(boundary={"top": "periodic"}), ["/parameters/boundary/top"]),
    (with_(boundary={"top": "FREE"}), ["/parameters/boundary/top"]),
    (with_(order="spiral"), ["/parameters/order"]), (with_(order=0), ["/parameters/order"]),
    (with_(order=None), ["/parameters/order"]),
    (with_(weights="heavy"), ["/parameters/weights"]), (with_(weights=1), ["/parameters/weights"]),
    (with_(weights={"red": -1}), ["/parameters/weights/red"]),
    (with_(weights={"red": "1"}), ["/parameters/weights/red"]),
    (with_(weights={"cloud": 1}), ["/parameters/weights/cloud"]),
    (with_(weights={"clo/ud~": 1}), ["/parameters/weights/clo~1ud~0"]),
    (with_(constraints={}), ["/parameters/constraints"]),
    (with_(constraints=[3]), ["/parameters/constraints/0"]),
    (with_(constraints=[{}]), ["/parameters/constraints/0/kind",
                               "/parameters/constraints/0/pieces"]),
    (with_(constraints=[FIXED, {**FIXED, "kind": "glued"}]), ["/parameters/constraints/1/kind"]),
    (with_(constraints=[{**FIXED, "pieces": []}]), ["/parameters/constraints/0/pieces"]),
    (with_(constraints=[{**FIXED, "pieces": "red"}]), ["/parameters/constraints/0/pieces"]),
    (with_(constraints=[{**FIXED, "pieces": ["red", "cloud"]}]),
     ["/parameters/constraints/0/pieces/1"]),
    (with_(constraints=[{**FIXED, "where": []}]), ["/parameters/constraints/0/where"]),
    (with_(constraints=[{**FIXED, "box": {"min": [0, 0, 0]}}]),
     ["/parameters/constraints/0/box/max"]),
    (with_(constraints=[{**FIXED, "box": {"min": [0, 0, 0], "max": [7, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [6, 0, 0], "max": [7, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [2, 0, 0], "max": [2, 1, 1]}}]),
     ["/parameters/constraints/0/box"]),
    (with_(constraints=[{**FIXED, "box": {"min": [-1, 0, 0], "max": [2, 1, 1]}}]),
     ["/parameters/constraints/0/box/min/0"]),
    (with_(constraints=[{**FIXED, "cells": []}]), ["/parameters/constraints/0/cells"]),
    (with_(constraints=[{**FIXED, "cells": [[0, 0, 0], [0, 2, 0], [0, 0, 4]]}]),
     ["/parameters/constraints/0/cells/1", "/parameters/constraints/0/cells/2"]),
    (with_(constraints=[{**FIXED, "cells": [[0, 0]]}]), ["/parameters/constraints/0/cells/0"]),
], ids=short)
def test_a_wrong_request_is_refused_with_a_pointer_to_each_fault(server, request_, expected):
    before = server.get("/v1/jobs?limit=1").json()["items"]
    answer = post_job(server, json.dumps(request_))
    problem = assert_faults(answer, request_, expected)
    assert problem["type"] == "/problems/invalid-request"
    assert problem["instance"] == "/v1/jobs"
    assert server.get("/v1/jobs?limit=1").json()["items"] == before


def test_all_faults_of_a_request_are_found_at_once(server):
    request = {
        "solver": "quantum", "example": {**STRIPES, "name": 3}, "seed": -1, "priority": 99,
        "deadline": 0, "tags": {"a": 1}, "bogus": 1,
        "parameters": {
            "size": [0, 1, "2"], "order": 3, "weights": {"red": -1}, "bogus": 1,
            "blocks": {"overlap": 2, "passes": 0}, "boundary": {"top": 3, "up": "free"},
            "constraints": [{"kind": "glued", "pieces": []}]}}
    assert_faults(post_job(server, request), request, [
        "/solver", "/example/name", "/seed", "/priority", "/deadline", "/tags/a", "/bogus",
        "/parameters/size/0", "/parameters/size/2", "/parameters/order",
        "/parameters/weights/red", "/parameters/bogus", "/parameters/blocks/overlap",
        "/parameters/blocks/passes", "/parameters/boundary/top", "/parameters/boundary/up",
        "/parameters/constraints/0/kind", "/parameters/constraints/0/pieces"])


def test_all_unknown_pieces_of_a_request_are_found_at_once(server):
    request = with_(boundary={"west": ["cloud"], "bottom": ["red", "sea"], "south": "periodic"},
                    weights={"mist": 1}, constraints=[{**FIXED, "pieces": ["fog"]},
                                                      {**FIXED, "cells": [[99, 0, 0]]}])
    assert_faults(post_job(server, request), request, [
        "/parameters/boundary/west/0", "/parameters/boundary/bottom/1",
        "/parameters/boundary/south", "/parameters/weights/mist",
        "/parameters/constraints/0/pieces/0", "/parameters/constraints/1/cells/0"])


def test_faults_of_form_do_not_hide_faults_of_meaning(server):
    request = {**with_(boundary={"west": ["cloud"]}), "bogus": 1, "seed": -1}
    assert_faults(post_job(server, request), request,
                  ["/bogus", "/seed", "/parameters/boundary/west/0"])


def test_very_many_faults_are_cut_to_a_list_that_can_be_read(server):
    request = {**GOOD, **{f"bogus{number}": 1 for number in range(1000)}}
    problem = assert_problem(post_job(server, request), 422, "invalid-request")
    assert 10 <= len(problem["errors"]) <= 50
    assert all(resolves(request, pointer) for pointer in pointers(problem))


@pytest.mark.parametrize("text", ["\x00", "\x1f", "\"", "\\", "\u2028", "\U0001F600", "</script>",
                                  "the limit "], ids=repr)
def test_odd_characters_in_a_name_come_back_whole_in_the_problem(server, text):
    request = with_(weights={text: 1})
    problem = assert_faults(post_job(server, request), request, [f"/parameters/weights/{text}"
                            .replace("</", "<~1")])
    assert problem["type"] == "/problems/invalid-request"


@pytest.mark.parametrize("parameters", [
    {"size": [4096, 4096, 4096]}, {"size": [4096, 1, 4096]},
    {"size": [200, 10, 200], "blocks": {"size": [1, 1, 1]}},
    {"size": [200, 10, 200], "blocks": {"size": [2, 2, 2], "overlap": 0.95, "passes": 100}},
    {"blocks": {"size": [1, 1, 1], "passes": 100}},
], ids=["cells", "cells of one floor", "blocks", "passes", "blocks at the default size"])
def test_what_passes_a_limit_is_refused_at_once_and_the_limit_is_named(server, parameters):
    request = {"solver": "discrete", "example": "castle", "parameters": parameters}
    answer = post_job(server, request)
    if answer.status == 202:
        server.request("DELETE", answer.headers["location"])
    problem = assert_problem(answer, 422, "too-large")
    assert re.search(r"_max\b", problem["detail"] + str(problem["errors"]))
    assert all(resolves(request, pointer) for pointer in pointers(problem))


def test_the_limit_of_cells_holds_at_its_edge(make_server):
    server = make_server("--model-cells-max", 48)
    assert post_job(server, job_request({"size": [6, 2, 4]})).status == 202
    assert_problem(post_job(server, job_request({"size": [7, 2, 4]})), 422, "too-large")
    request = {"solver": "discrete", "example": "castle"}  # its default size is larger
    assert_problem(post_job(server, request), 422, "too-large")


# --- malformed JSON

@pytest.mark.parametrize(("body", "byte"), [
    (b"", 0), (b" ", 1), (b"{", 1), (b'{"solver":', 10), (b'{"a":1,}', 7), (b"[1 2]", 3),
    (b'{"a" 1}', 5), (b"{'a':1}", 1), (b"{} {}", 3), (b'{"a":1}x', 7), (b"]", 0), (b"[,1]", 1),
    (b'{"a":1 /* b */}', 7), (b'["a\nb"]', 3), (b'["\\x"]', 3), (b'["\xff"]', 2),
    (b'["\xc0\xaf"]', 2), (b'["\xed\xa0\x80"]', 3), (b'{"a":1}\x00', 7), (b'\x00{"a":1}', 0),
    (b'{"\xc3\xa4\xc3\xb6":,}', 8), (b"\xff\xfe{\x00}\x00", 0),
])
def test_broken_json_is_refused_with_the_byte_where_reading_stopped(server, body, byte):
    problem = assert_problem(post_job(server, body, Content_Type="application/json"), 400,
                             "malformed-json", "/v1/jobs")
    assert re.search(rf"\b{byte}\b", problem["detail"]), problem


@pytest.mark.parametrize("body", [
    b"nul", b"NaN", b"[Infinity]", b"[+1]", b"[.5]", b"[1.]", b"[0x10]", b"[01]", b"[1e]",
    b'["\\ud800"]', b'["\\u12"]', b'{"a":1,"a":2}', b'{"a":{"b":1,"b":1}}', b"{1:2}",
    b"undefined", b"\x1f\x8b\x08\x00", b"solver=discrete&example=castle", b"<job/>",
])
def test_what_is_no_json_is_refused(server, body):
    assert_problem(post_job(server, body, Content_Type="application/json"), 400, "malformed-json")


@pytest.mark.parametrize("tail", [b"\x00", b"\x00\x00", b"\x00{", b"\x00 garbage", b"\x1a"])
def test_nothing_may_follow_the_json_not_even_after_a_nul(server, tail):
    answer = post_job(server, compact(GOOD) + tail, Content_Type="application/json")
    assert_problem(answer, 400, "malformed-json")


@pytest.mark.parametrize("number", [b"1e400", b"-1e400", b"9" * 5000, b"1" + b"0" * 400],
                         ids=short)
def test_a_number_beyond_all_numbers_is_refused(server, number):
    body = compact(GOOD).replace(b'"seed":1', b'"seed":' + number)
    answer = post_job(server, body, Content_Type="application/json")
    assert answer.status in (400, 422)
    assert_problem(answer, answer.status)


@pytest.mark.parametrize("depth", [10_000, 1_000_000])
@pytest.mark.parametrize(("opening", "closing"), [(b"[", b"]"), (b'{"a":', b"}")])
def test_very_deep_json_is_refused(server, opening, closing, depth):
    body = opening * depth + b"1" + closing * depth
    assert_problem(post_job(server, body, Content_Type="application/json"), 400, "malformed-json")
    assert_problem(post_job(server, opening * depth, Content_Type="application/json"), 400)


def test_the_limit_of_depth_holds_at_its_edge(server):
    def nested(depth):
        return compact(GOOD)[:-1] + b',"bogus":' + b"[" * (depth - 1) + b"]" * (depth - 1) + b"}"

    assert_problem(post_job(server, nested(64)), 422, "invalid-request")
    assert_problem(post_job(server, nested(65)), 400, "malformed-json")


def test_more_values_than_are_taken_are_refused(server):
    body = b"[" + b"0," * 1_000_000 + b"0]"
    assert_problem(post_job(server, body, Content_Type="application/json"), 400, "malformed-json")

"""What is said of an example before anything is made of it."""

import itertools
import xml.etree.ElementTree

import pytest

from checks import STRIPES, assert_problem, together

# Any two of them may be neighbours.
FREE = {"kind": "discrete", "name": "free & <easy>", "pieces": [{"name": "a"}, {"name": "b"}],
        "adjacency": {axis: [[a, b] for a in "ab" for b in "ab"] for axis in "xz"}}


def uploaded(server, example):
    answer = server.request("POST", "/v1/examples", example)
    assert answer.status == 201, answer.body
    return answer.json()["id"]


def analysis(server, example_id):
    answer = server.get(f"/v1/examples/{example_id}/analysis")
    assert answer.status == 200, answer.body
    assert answer.headers["content-type"] == "application/json"
    return answer.json()


@pytest.mark.parametrize("example_id", ["castle", "city", "canyon"])
def test_a_built_in_example_is_analysed(server, example_id):
    found = analysis(server, example_id)
    example = server.get(f"/v1/examples/{example_id}").json()
    names = {piece["name"] for piece in example["pieces"]}
    assert found["verdict"] in ("infallible", "fallible", "unknown")
    assert found["labels"] == len(names)
    # They are too large to be split in the time.
    assert found["splitting"] is None
    for warning in found["warnings"]:
        assert set(warning) == {"code", "message", "pieces"}
        assert set(warning["pieces"]) <= names and warning["message"]
    for point in found["success"]:
        assert 0 <= point["successes"] <= point["runs"]
        assert point["size"][1] == example["default_size"][1]
    assert len({tuple(point["size"]) for point in found["success"]}) >= 4


def test_what_has_one_label_of_each_kind_is_infallible_with_its_proof(server):
    found = analysis(server, uploaded(server, FREE))
    assert (found["verdict"], found["proof"]["kind"]) == ("infallible", "equation_3_11")
    # Planar: 2 x 2 and 3 x 3 cells of two labels each.
    assert [(one["size"], one["models"], one["exact"]) for one in found["models"]] == \
        [([2, 1, 2], 2 ** 4, True), ([3, 1, 3], 2 ** 9, True)]
    assert all(point["successes"] == point["runs"] for point in found["success"])
    assert found["description"]


# Tiles whose edges must have one colour, east, south, west, north.
def _tiles(edges):
    names = [f"t{index}" for index in range(len(edges))]
    return {"kind": "discrete", "name": "tiles", "pieces": [{"name": name} for name in names],
            "adjacency": {
                "x": [[a, b] for (a, s), (b, t) in itertools.product(zip(names, edges), repeat=2)
                      if s[0] == t[2]],
                "z": [[a, b] for (a, s), (b, t) in itertools.product(zip(names, edges), repeat=2)
                      if s[1] == t[3]]}}


def test_a_counterexample_has_no_completion(server):
    """Checked by trying everything in its box."""
    example = _tiles([(0, 2, 1, 0), (1, 1, 1, 2), (0, 2, 2, 1), (2, 1, 2, 2),
                      (0, 1, 0, 2), (0, 0, 2, 1), (1, 2, 0, 1), (2, 1, 0, 0)])
    found = analysis(server, uploaded(server, example))
    assert found["verdict"] == "fallible", found["verdict"]
    proof = found["proof"]
    assert proof["kind"] == "counterexample" and proof["message"]
    width, height, depth = proof["box"]
    assert height == 1
    placed = {tuple(one["cell"]): one["piece"] for one in proof["core"]}
    if proof["choice"]:
        placed[tuple(proof["choice"]["cell"])] = proof["choice"]["piece"]
    allowed = {axis: {tuple(pair) for pair in example["adjacency"][axis]} for axis in "xz"}
    names = [piece["name"] for piece in example["pieces"]]
    places = [(x, 0, z) for z in range(depth) for x in range(width)]

    def completes(model, index):
        if index == len(places):
            return True
        x, _, z = place = places[index]
        for name in ([placed[place]] if place in placed else names):
            west, north = model.get((x - 1, 0, z)), model.get((x, 0, z - 1))
            if ((west is None or (west, name) in allowed["x"]) and
                    (north is None or (north, name) in allowed["z"])):
                model[place] = name
                if completes(model, index + 1):
                    return True
                del model[place]
        return False

    assert placed and placed.keys() <= set(places) and not completes({}, 0)
    # None of it is idle: without any one of these cells there is a completion.
    for place in [tuple(one["cell"]) for one in proof["core"]]:
        name = placed.pop(place)
        assert completes({}, 0), place
        placed[place] = name


# Every 2 has a 6 two cells to its right, joined to it by one of two paths (Merrell's thesis, Fig.
# 3.5): which of them a 0 is within tells it apart from the others. Rows from the bottom.
PATHS = {"kind": "discrete", "name": "paths", "pieces": [{"name": str(n)} for n in range(9)],
         "size": [4, 1, 10],
         "cells": [int(row[z]) for z in range(10)
                   for row in ("1216112161", "0345007080", "0000003450", "0000000000")]}


def test_a_fallible_example_is_told_how_to_split_its_labels(server):
    found = analysis(server, uploaded(server, PATHS))
    assert found["verdict"] == "fallible"
    assert found["splitting"] == {
        "labels": 11, "method": "rules", "proof": "equation_3_11",
        "split": [{"piece": "0", "into": 2}, {"piece": "1", "into": 2}], "lost": []}


def test_what_is_infallible_is_not_split(server):
    assert analysis(server, uploaded(server, FREE))["splitting"] is None


FREE_SIDES = {side: "free" for side in ("bottom", "top", "north", "south", "west", "east")}


@pytest.mark.parametrize("example", [FREE, {**STRIPES, "boundary": FREE_SIDES}],
                         ids=lambda example: example["name"])
def test_what_is_proved_infallible_is_made_whole_in_one_pass(server, example):
    assert analysis(server, uploaded(server, example))["verdict"] == "infallible"
    height = 1 if example is FREE else 2
    answer = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": example, "parameters": {"size": [30, height, 60]}},
        headers={"Prefer": "wait=60"})
    job = answer.json()
    assert job["state"] == "succeeded", job["error"]
    assert job["request"]["parameters"]["blocks"] is None
    assert job["result"]["stats"]["solved_by"]["first_try"] == 1
    assert job["result"]["stats"]["backtracks"] == 0


@pytest.mark.parametrize("parameters", [
    {"size": [513, 1, 512]}, {"blocks": {}}, {"order": "random"}, {"weights": {"a": 0}},
    {"boundary": {"west": "a"}}, {"boundary": {"west": "periodic", "east": "periodic"}},
    {"constraints": [{"kind": "max_run", "pieces": ["a"], "max": 3}]}], ids=str)
def test_what_the_proof_does_not_cover_is_made_in_blocks(server, parameters):
    assert analysis(server, uploaded(server, FREE))["verdict"] == "infallible"
    answer = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": FREE, "deadline": 0.001,
        "parameters": {"size": [30, 1, 60], **parameters}})
    assert answer.status == 202, answer.body
    assert answer.json()["request"]["parameters"]["blocks"]["size"]


def test_labels_to_be_warned_of_are_named(server):
    example = {**STRIPES, "pieces": STRIPES["pieces"] + [{"name": "unused"}],
               "boundary": {"bottom": "red", "top": "air"}}
    warnings = analysis(server, uploaded(server, example))["warnings"]
    codes = {warning["code"]: warning for warning in warnings}
    assert codes["never_stands"]["pieces"] == ["unused"]
    assert "unused" in codes["never_stands"]["message"]
    assert codes.keys() & {"nothing_fits", "unreachable"}, "a floor of red alone has no model"


def test_the_drawing_is_a_picture_of_the_same_figures(server):
    example_id = uploaded(server, FREE)
    answer = server.get(f"/v1/examples/{example_id}/success.svg")
    assert answer.status == 200
    assert answer.headers["content-type"] == "image/svg+xml"
    root = xml.etree.ElementTree.fromstring(answer.body)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert "free & <easy>" in "".join(root.itertext())
    assert analysis(server, example_id)["urls"]["drawing"] == \
        f"/v1/examples/{example_id}/success.svg"


def test_analyses_asked_for_at_once_are_the_same_or_put_off(server):
    example_id = uploaded(server, {**FREE, "name": "asked for at once"})
    answers = together(
        6, lambda _: server.request("GET", f"/v1/examples/{example_id}/analysis"))
    good = [answer.body for answer in answers if answer.status == 200]
    assert good and len(set(good)) == 1
    for answer in answers:
        if answer.status != 200:
            assert_problem(answer, 503, "busy")
            assert answer.headers["retry-after"]


def test_an_unknown_example_has_no_analysis(server):
    for name in ("analysis", "success.svg"):
        assert_problem(server.get(f"/v1/examples/nothing/{name}"), 404, "not-found")

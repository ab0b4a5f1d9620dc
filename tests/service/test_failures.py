"""Why jobs fail, as their problem documents tell it, and wholes that only CaDiCaL makes. What is
said to be in conflict is asked for again by itself, and again without each of its parts."""

import copy

import pytest

from checks import STRIPES, Grid, job_request, make_job, make_model

# Halves of slabs that cover two cells of a floor, and pillars; whatever is no other half may meet.
HALVES = {"east": ("x", "w", "e"), "south": ("z", "n", "s")}
SLABS = {
    "kind": "discrete", "name": "slabs",
    "pieces": [{"name": name} for name in ["w", "e", "n", "s", "pillar"]],
    "adjacency": {"y": [], **{axis: [[a, b] for a in ["w", "e", "n", "s", "pillar"]
                                     for b in ["w", "e", "n", "s", "pillar"]
                                     if (a == first) == (b == second)]
                              for axis, first, second in HALVES.values()}},
}
WALLS = {"west": ["w", "n", "s", "pillar"], "east": ["e", "n", "s", "pillar"],
         "north": ["w", "e", "n", "pillar"], "south": ["w", "e", "s", "pillar"]}


def floor(extent, pillars):
    """Parameters: a square floor to cover, with pillars at these numbers of cells."""
    places = [[i % extent, 0, i // extent] for i in range(extent * extent)]
    there = [place for i, place in enumerate(places) if i in pillars]
    elsewhere = [place for i, place in enumerate(places) if i not in pillars]
    return {"size": [extent, 1, extent], "boundary": WALLS, "blocks": None, "constraints": [
        {"kind": "fixed", "pieces": ["pillar"], "cells": there},
        {"kind": "forbidden", "pieces": ["pillar"], "cells": elsewhere}]}


def fail(server, kind, parameters, **more):
    job = make_job(server, parameters, **more)
    assert job["state"] == "failed", job
    assert job["error"]["type"] == f"/problems/{kind}", job["error"]
    assert server.events(job["id"])[-1]["error"] == job["error"]
    return job["error"]


def only(parameters, conflict, without=None):
    """The parameters with the causes of a conflict alone, or with all of them but one."""
    causes = [cause for cause in parts(conflict) if cause != without]
    kept = copy.deepcopy(parameters)
    kept["boundary"] = {side: "free" for side in
                        ("bottom", "top", "north", "south", "west", "east")}
    for what, which in causes:
        if what == "side":
            kept["boundary"][which] = parameters["boundary"][which]
        elif what == "axis":
            for side in {"x": ("west", "east"), "y": ("bottom", "top"),
                         "z": ("north", "south")}[which]:
                kept["boundary"][side] = "periodic"
    kept["constraints"] = [constraint for i, constraint in
                           enumerate(parameters.get("constraints", []))
                           if ("constraint", i) in causes]
    kept["weights"] = {which: 0 for what, which in causes if what == "removed"}
    return kept


def parts(conflict):
    return ([("side", side) for side in conflict["sides"]] +
            [("axis", axis) for axis in conflict["periodic"]] +
            [("constraint", constraint["index"]) for constraint in conflict["constraints"]] +
            [("removed", piece) for piece in conflict["removed"]])


def check_conflict(server, parameters, conflict, example):
    """That the causes are in conflict, that each is needed, and that it shows at the cells."""
    assert set(conflict) == {"sides", "constraints", "periodic", "removed", "origin", "cells",
                             "minimal"}
    for constraint in conflict["constraints"]:
        assert parameters["constraints"][constraint["index"]]["kind"] == constraint["kind"]
    fail(server, "contradiction", only(parameters, conflict), example=example)
    assert conflict["minimal"] is True
    for cause in parts(conflict):
        job = make_job(server, only(parameters, conflict, without=cause), example=example)
        assert job["state"] == "succeeded", (cause, job["error"])
    if conflict["cells"] and all(place["labels"] for place in conflict["cells"]):
        rules = [one for one in only(parameters, conflict)["constraints"]
                 if one["kind"] not in ("fixed", "forbidden", "probability")]
        shown = {"size": parameters["size"], "boundary": only(parameters, {
            **conflict, "sides": []})["boundary"], "constraints": rules + [
                {"kind": "fixed", "pieces": place["labels"], "cells": [place["cell"]]}
                for place in conflict["cells"]]}
        fail(server, "contradiction", shown, example=example)


@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
@pytest.mark.parametrize("parameters, sides, constraints, periodic, removed", [
    # Something is, but not beside each other: red is followed by green.
    ({"boundary": {"west": ["red", "air"], "east": ["green", "air"]}, "size": [4, 2, 3],
      "weights": {"red": 2}}, {"west", "east"}, [], [], []),
    ({"constraints": [{"kind": "fixed", "pieces": ["air"], "cells": [[5, 1, 3]]},
                      {"kind": "fixed", "pieces": ["red"], "cells": [[1, 0, 2]]},
                      {"kind": "fixed", "pieces": ["blue"], "cells": [[2, 0, 2]]}]},
     set(), [1, 2], [], []),
    ({"constraints": [{"kind": "fixed", "pieces": ["red"],
                       "box": {"min": [0, 0, 0], "max": [2, 1, 1]}}]}, set(), [0], [], []),
    ({"constraints": [{"kind": "forbidden", "pieces": ["green"]}]}, set(), [0], [], []),
    ({"weights": {"green": 0}}, set(), [], [], ["green"]),
    # Stripes of three close on themselves after three cells only.
    ({"boundary": {"west": "periodic", "east": "periodic"}, "size": [4, 2, 3],
      "constraints": [{"kind": "fixed", "pieces": ["air"], "cells": [[1, 1, 1]]}]},
     set(), [], ["x"], []),
], ids=["apart", "fixed cells", "one constraint", "forbidden", "removed", "periodic"])
def test_a_contradiction_names_the_fewest_causes(
        server, parameters, sides, constraints, periodic, removed, blocks):
    error = fail(server, "contradiction",
                 {**parameters, **({"blocks": None} if blocks is None else {})})
    conflict = error["conflict"]
    asked = job_request(parameters)["parameters"]
    assert set(conflict["sides"]) == sides, error
    assert [one["index"] for one in conflict["constraints"]] == constraints, error
    assert conflict["periodic"] == periodic and conflict["removed"] == removed, error
    for side in sides:
        assert side in error["detail"]
    for one in conflict["constraints"]:
        assert f"constraint {one['index']} ({one['kind']} of " in error["detail"]
    check_conflict(server, asked, conflict, STRIPES)


# Any piece beside any other.
ANY = {"kind": "discrete", "name": "any", "pieces": [{"name": "red"}, {"name": "green"}],
       "adjacency": {axis: [[a, b] for a in ("red", "green") for b in ("red", "green")]
                     for axis in "xyz"}}


@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
@pytest.mark.parametrize("parameters, sides, constraints, cells", [
    ({"constraints": [{"kind": "count", "pieces": ["red"], "max": 1},
                      {"kind": "fixed", "pieces": ["red"], "cells": [[2, 0, 0], [4, 1, 2]]}]},
     set(), [0, 1], 2),
    ({"constraints": [{"kind": "count", "pieces": ["green"], "min": 30}],
      "boundary": {"bottom": "red", "north": ["red"]}}, {"bottom"}, [0], None),
    ({"constraints": [{"kind": "count", "pieces": ["red"], "min": 9},
                      {"kind": "count", "pieces": ["green"], "max": 0},
                      {"kind": "path", "pieces": ["green"], "from": [0, 0, 0], "to": [5, 0, 0]}]},
     set(), [1, 2], None),
    ({"constraints": [{"kind": "separation", "pieces": ["red"], "distance": 3},
                      {"kind": "fixed", "pieces": ["red"], "cells": [[0, 0, 0], [1, 1, 0]]}]},
     set(), [0, 1], 2),
    ({"constraints": [{"kind": "forbidden", "pieces": ["green"], "box": {
                          "min": [2, 0, 0], "max": [3, 2, 4]}},
                      {"kind": "connected", "pieces": ["green"]},
                      {"kind": "fixed", "pieces": ["green"], "cells": [[0, 0, 0]]},
                      {"kind": "fixed", "pieces": ["green"], "cells": [[5, 0, 0]]}]},
     set(), [0, 1, 2, 3], 10),
], ids=["count of cells", "count beside a side", "path", "separation", "connected"])
def test_constraints_on_many_cells_are_named_with_what_they_cannot_hold_with(
        server, parameters, sides, constraints, cells, blocks):
    asked = job_request(parameters)["parameters"]
    conflict = fail(server, "contradiction",
                    {**asked, **({"blocks": None} if blocks is None else {})},
                    example=ANY)["conflict"]
    assert set(conflict["sides"]) == sides
    assert [one["index"] for one in conflict["constraints"]] == constraints
    assert cells is None or len(conflict["cells"]) == cells
    check_conflict(server, asked, conflict, ANY)


@pytest.mark.parametrize("parameters, sides, is_minimal", [
    ({"boundary": {"bottom": "red", "west": "green", "top": "green"}}, {"bottom", "west"}, True),
    ({"boundary": {"bottom": "red", "top": "green"}, "size": [3, 1, 3]}, {"bottom", "top"}, True),
    # That stripes are all red is impossible by itself, but this is plainer.
    ({"boundary": {"north": "red", "west": "blue", "east": ["air", "red"], "top": "free"}},
     {"north", "west"}, False),
])
def test_sides_that_leave_nothing_where_they_meet_are_both_named(
        server, parameters, sides, is_minimal):
    example = ANY if is_minimal else STRIPES
    conflict = fail(server, "contradiction", parameters, example=example)["conflict"]
    assert set(conflict["sides"]) == sides
    assert conflict["minimal"] is is_minimal
    place, = conflict["cells"]
    assert place["labels"] == []
    if is_minimal:
        check_conflict(server, job_request(parameters)["parameters"], conflict, example)


def test_where_nothing_is_left_the_cell_is_told_with_what_each_cause_wants(server):
    error = fail(server, "contradiction", {
        "boundary": {"bottom": "red", "west": "blue", "top": "free"}})
    place, = error["conflict"]["cells"]
    assert place["labels"] == [] and place["cell"][:2] == [0, 0]
    assert 'only "red" for the bottom side' in error["detail"]
    assert 'only "blue" for the west side' in error["detail"]


def test_fixed_cells_that_cannot_stand_together_are_told_with_their_labels(server):
    """Red, anything, red: two cells apart, though three would do."""
    error = fail(server, "contradiction", {"constraints": [
        {"kind": "fixed", "pieces": ["red"], "cells": [[0, 0, 1]]},
        {"kind": "fixed", "pieces": ["red"], "cells": [[2, 0, 1]]},
        {"kind": "fixed", "pieces": ["red"], "cells": [[3, 0, 1]]}]})
    cells = {tuple(place["cell"]): place["labels"] for place in error["conflict"]["cells"]}
    assert len(cells) == 2 and (2, 0, 1) in cells
    assert set(map(tuple, cells.values())) == {("red",)}
    assert len(error["conflict"]["constraints"]) == 2


def test_an_example_that_cannot_fill_a_size_is_to_blame_by_itself(server):
    line = {"kind": "discrete", "name": "line", "pieces": [{"name": "a"}, {"name": "b"}],
            "size": [2, 1, 1], "cells": [0, 1]}
    error = fail(server, "contradiction", {"size": [3, 1, 1]}, example=line)
    assert error["conflict"] == {"sides": [], "constraints": [], "periodic": [], "removed": [],
                                 "origin": False, "cells": [], "minimal": True}


def test_what_is_kept_of_an_earlier_model_may_be_to_blame(server):
    first = make_job(server, {"boundary": {"bottom": "red"}}, example=ANY)
    error = fail(server, "contradiction", {"boundary": {"bottom": "free"}, "constraints": [
        {"kind": "count", "pieces": ["red"], "max": 3}]}, example=ANY,
        **{"from": {"job": first["id"], "cells": [[0, 0, 0]]}})
    conflict = error["conflict"]
    assert conflict["origin"] is True and conflict["minimal"] is True
    assert [one["index"] for one in conflict["constraints"]] == [0] and not conflict["sides"]
    assert len(conflict["cells"]) == 4
    assert "the model that this one starts from" in error["detail"]


# --- what only CaDiCaL decides

# Every attempt of the search fails at these, whatever the seed.
HARD_PILLARS = {
    0, 32, 53, 57, 70, 83, 85, 100, 109, 120, 131, 134, 137, 138, 161, 179, 186, 207, 210, 212, 214,
    218, 241, 244, 249, 252, 255, 265, 273, 275, 286, 298, 299, 301, 310, 318, 323, 330, 336, 345,
    368, 375, 388, 399}


def assert_covered(labels, pillars):
    """That each half of a slab lies beside its other half, and pillars stand where they should."""
    names, grid = labels["pieces"], Grid(labels["size"], labels["cells"])
    at = {place: names[grid.at(*place)] for place in grid.places()}
    partner = {"w": ((1, 0), "e"), "e": ((-1, 0), "w"), "n": ((0, 1), "s"), "s": ((0, -1), "n")}
    for (x, y, z), name in at.items():
        assert (name == "pillar") == (x + grid.size[0] * z in pillars)
        if name != "pillar":
            (step_x, step_z), other = partner[name]
            assert at.get((x + step_x, y, z + step_z)) == other, (x, z)


@pytest.mark.parametrize("blocks", [None, {"size": [6, 1, 6]}], ids=["at once", "blocks"])
def test_a_hard_whole_is_made(server, blocks):
    parameters = {**floor(20, HARD_PILLARS), "blocks": blocks}
    models = set()
    for seed in (1, 2):
        job, labels = make_model(server, parameters, example=SLABS, seed=seed)
        assert_covered(labels, HARD_PILLARS)
        if blocks is None:
            assert job["result"]["stats"]["solved_by"]["sat"] == 1
        again, _ = make_model(server, parameters, example=SLABS, seed=seed)
        assert again["result"]["sha256"] == job["result"]["sha256"]
        models.add(job["result"]["sha256"])
    assert len(models) == 2


def test_a_mutilated_chessboard_is_proved_to_have_no_cover(server):
    """Both missing corners are of one colour, and each slab covers a cell of each."""
    error = fail(server, "contradiction", floor(6, {0, 35}), example=SLABS)
    conflict = error["conflict"]
    assert set(conflict["sides"]) == set(WALLS)
    assert [one["index"] for one in conflict["constraints"]] == [0, 1]
    check_conflict(server, floor(6, {0, 35}), conflict, SLABS)


@pytest.mark.parametrize("blocks", [None, {"size": [6, 1, 6]}], ids=["at once", "blocks"])
def test_a_search_that_gives_up_tells_where_it_met_its_dead_ends(server, blocks):
    parameters = {**floor(14, {0, 195}), "blocks": blocks}
    error = fail(server, "gave-up", parameters, example=SLABS)
    assert "conflict" not in error
    times = [place["times"] for place in error["hottest"]]
    assert 1 <= len(times) <= 8 and times == sorted(times, reverse=True) and times[-1] > 0
    for place in error["hottest"]:
        assert all(0 <= at < extent for at, extent in zip(place["cell"], parameters["size"]))
    assert fail(server, "gave-up", parameters, example=SLABS)["hottest"] == error["hottest"]


def test_a_count_that_is_not_reached_tells_its_dead_ends_too(server):
    """No two neighbours are alike: half of the cells at most, which no propagation sees."""
    example = {"kind": "discrete", "name": "apart", "pieces": [{"name": "a"}, {"name": "b"}],
               "adjacency": {axis: [["a", "b"], ["b", "a"], ["b", "b"]] for axis in "xyz"}}
    error = fail(server, "gave-up", {"size": [9, 1, 9], "constraints": [
        {"kind": "count", "pieces": ["a"], "min": 42}]}, example=example)
    assert error["hottest"]


def test_the_pages_of_the_problems_tell_of_the_members(server):
    for kind, member in (("contradiction", "conflict"), ("gave-up", "hottest")):
        assert member in server.get(f"/problems/{kind}").body.decode()

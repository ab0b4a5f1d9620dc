"""What a job makes of its request."""

import re

import pytest

from checks import (HILLS, STRIPES, Grid, assert_fits, assert_problem, box_places, endless_job,
                    job_request, make_job, make_model, post_job, short, state_of, wait_until)

SIDE_NAMES = ["bottom", "top", "north", "south", "west", "east"]


FREE = dict.fromkeys(SIDE_NAMES, "free")
PERIODIC_X = {"west": "periodic", "east": "periodic"}
PERIODIC_Z = {"north": "periodic", "south": "periodic"}


@pytest.mark.parametrize("parameters", [
    {"size": [7, 4, 5]}, {"size": [1, 4, 9]}, {"size": [13, 4, 1]}, {"size": [30, 4, 17]},
    {"blocks": None}, {"blocks": {"size": [3, 4, 3], "overlap": 0.4}},
    {"blocks": {"size": [5, 2, 4], "overlap": 0}}, {"blocks": {"passes": 3, "attempts": 1}},
    {"blocks": {"size": [1, 1, 1], "overlap": 0}}, {"blocks": {"size": [64, 64, 64]}},
    {"order": "scan"}, {"order": "min_entropy"}, {"order": "random"},
    {"order": "min_entropy", "blocks": None}, {"order": "random", "blocks": None},
    {"weights": "uniform"}, {"weights": "example"}, {"weights": {"tree": 50, "rock": 0.01}},
    {"boundary": FREE}, {"boundary": {**FREE, "top": "air"}},
    {"boundary": dict.fromkeys(SIDE_NAMES, "example")},
    {"boundary": {"west": "air", "bottom": "free"}},
    {"boundary": {"north": ["air", "grass", "path"]}},
    {"boundary": {"east": ["air", "grass"]}}, {"boundary": {"south": "example"}},
    {"boundary": PERIODIC_X}, {"boundary": PERIODIC_Z}, {"boundary": {**PERIODIC_X, **PERIODIC_Z}},
    {"boundary": {**FREE, "top": "periodic", "bottom": "periodic"}},
    {"boundary": {**PERIODIC_X, **PERIODIC_Z}, "blocks": None},
    {"boundary": {**PERIODIC_X, **PERIODIC_Z}, "size": [23, 4, 27], "order": "random"},
], ids=short)
def test_a_model_keeps_to_its_example_and_to_its_boundary(server, parameters):
    job, labels = make_model(server, {"size": [12, 4, 9], **parameters}, example=HILLS, seed=11)
    echo = job["request"]["parameters"]
    assert labels["size"] == echo["size"] == parameters.get("size", [12, 4, 9])
    for name in ("order", "weights"):
        assert name not in parameters or echo[name] == parameters[name]
    if parameters.get("blocks", {}) is None:
        assert echo["blocks"] is None and job["progress"]["blocks_total"] == 1
    else:
        assert echo["blocks"].items() >= parameters.get("blocks", {}).items()
    for side, wanted in parameters.get("boundary", {}).items():
        special = wanted in ("free", "periodic", "example") or isinstance(wanted, list)
        assert echo["boundary"][side] in ([wanted] if special else [wanted, [wanted]])
    assert_fits(labels, HILLS, echo["boundary"])


@pytest.mark.parametrize("example_id", ["castle", "city", "canyon"])
def test_a_model_of_a_built_in_example_keeps_to_it(server, example_id):
    example = server.get(f"/v1/examples/{example_id}").json()
    job, labels = make_model(server, {"size": [15, 10, 12]}, example=example_id)
    assert_fits(labels, example, job["request"]["parameters"]["boundary"])


@pytest.mark.parametrize("size", [[3, 2, 3], [9, 2, 2], [12, 2, 5], [24, 2, 24]])
def test_stripes_close_on_themselves_where_the_size_lets_them(server, size):
    job, labels = make_model(server, {"size": size, "boundary": PERIODIC_X})
    model = assert_fits(labels, STRIPES, job["request"]["parameters"]["boundary"])
    floor = [model.at(x, 0, 0) for x in range(size[0])]
    assert floor == [1 + (x + floor[0] - 1) % 3 for x in range(size[0])]


def test_stripes_that_cannot_close_on_themselves_fail(server):
    job = make_job(server, {"size": [10, 2, 4], "boundary": PERIODIC_X})
    assert job["state"] == "failed" and job["result"] is None
    assert job["error"]["type"] in ("/problems/contradiction", "/problems/gave-up")
    assert_problem(server.get(job["urls"]["model"]), 409)
    assert_problem(server.get(job["urls"]["labels"]), 409)


def test_weights_change_how_often_a_piece_stands(server):
    def trees(weight):
        _, labels = make_model(server, {"size": [24, 4, 24], "weights": {"tree": weight}},
                               example=HILLS, seed=5)
        return labels["cells"].count(3)

    assert trees(0) == 0
    assert trees(0.01) < trees(1) < trees(100)


def test_a_piece_of_weight_nought_in_the_example_s_weights_is_never_chosen(server):
    job, labels = make_model(server, {"size": [20, 4, 20], "weights": {"rock": 0, "tree": 0}},
                             example=HILLS)
    model = assert_fits(labels, HILLS, job["request"]["parameters"]["boundary"])
    assert not {2, 3} & set(model.cells)


def test_passes_go_over_the_model_again(server):
    once = make_job(server, {"size": [20, 4, 20]}, example=HILLS)
    thrice = make_job(server, {"size": [20, 4, 20], "blocks": {"size": [10, 4, 10], "passes": 3}},
                      example=HILLS)
    assert thrice["progress"]["blocks_total"] == 3 * once["progress"]["blocks_total"]


def test_smaller_blocks_are_more_blocks(server):
    totals = [make_job(server, {"size": [20, 4, 20], "blocks": {"size": [side, 4, side]}},
                       example=HILLS)["progress"]["blocks_total"] for side in (5, 10, 20)]
    assert totals[0] > totals[1] > totals[2] == 1


@pytest.mark.parametrize("order", ["scan", "min_entropy", "random"])
def test_the_seed_decides_the_model(server, order):
    def sha(seed):
        job = make_job(server, {"size": [16, 4, 16], "order": order}, example=HILLS, seed=seed)
        return job["result"]["sha256"]

    assert sha(1) == sha(1)
    assert len({sha(seed) for seed in range(4)}) > 1


SIZE = [12, 4, 9]


@pytest.mark.parametrize("constraints", [
    [("fixed", ["rock"], {"cells": [[3, 1, 4]]})],
    [("fixed", ["rock", "tree"], {"box": {"min": [2, 1, 3], "max": [3, 2, 4]}})],
    [("fixed", ["air"], {"box": {"min": [0, 1, 0], "max": [12, 4, 9]}})],
    [("fixed", ["path"], {"box": {"min": [5, 0, 0], "max": [6, 1, 9]}})],
    [("fixed", ["air"], {"box": {"min": [0, 2, 0], "max": [12, 4, 9]}}),
     ("forbidden", ["tree"], {})],
    [("forbidden", ["rock", "path"], {})],
    [("forbidden", ["grass", "rock", "tree"], {"cells": [[0, 0, 0], [11, 0, 8], [5, 0, 4]]})],
    [("forbidden", ["path"], {"box": {"min": [0, 0, 0], "max": [12, 1, 9]}}),
     ("fixed", ["tree"], {"cells": [[6, 1, 4]]})],
    [("fixed", ["path"], {"cells": [[0, 0, 8]], "box": {"min": [0, 0, 0], "max": [1, 1, 2]}})],
], ids=short)
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_fixed_and_forbidden_hold_in_every_cell_they_name(server, constraints, blocks):
    sent = [{"kind": kind, "pieces": pieces, **where} for kind, pieces, where in constraints]
    parameters = {"size": SIZE, "constraints": sent}
    if blocks is None:
        parameters["blocks"] = None
    job, labels = make_model(server, parameters, example=HILLS)
    assert job["request"]["parameters"]["constraints"] == sent
    held = {"fixed": [], "forbidden": []}
    for kind, pieces, where in constraints:
        places = [tuple(cell) for cell in where.get("cells", [])]
        if "box" in where:
            places += box_places(where["box"]["min"], where["box"]["max"])
        held[kind].append((places if where else box_places([0, 0, 0], SIZE), pieces))
    assert_fits(labels, HILLS, job["request"]["parameters"]["boundary"], **held)


@pytest.mark.parametrize(("parameters", "named"), [
    ({"size": [3, 1, 3], "boundary": {"bottom": "red", "top": "air"}}, ["bottom", "top"]),
    ({"boundary": {"bottom": "red", "west": "blue"}}, ["bottom", "west"]),
    ({"boundary": {"north": "red", "east": "air"}}, ["north", "east"]),
    ({"boundary": {"south": ["red", "green"], "top": ["air", "blue"]}}, ["south", "top"]),
    ({"boundary": {"bottom": ["red", "blue"], "west": ["red", "green"],
                   "south": ["green", "blue"]}},
     ["bottom", "west", "south"]),
    ({"boundary": {"west": "example", "east": "blue"}, "size": [1, 2, 4]}, ["west", "east"]),
])
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_sides_that_leave_nothing_where_they_meet_are_a_problem_that_names_them(
        server, parameters, named, blocks):
    job = make_job(server, {**parameters, **({"blocks": None} if blocks is None else {})})
    assert job["state"] == "failed"
    error = job["error"]
    assert error["type"] == "/problems/contradiction"
    assert error["status"] == 422 and error["title"]
    for side in named:
        assert re.search(rf"\b{side}\b", error["detail"]), error["detail"]
    assert job["finished"] is not None
    assert server.events(job["id"])[-1]["error"] == error


@pytest.mark.parametrize("constraints", [
    [{"kind": "fixed", "pieces": ["red"], "cells": [[0, 0, 0]]},
     {"kind": "fixed", "pieces": ["blue"], "cells": [[0, 0, 0]]}],
    [{"kind": "forbidden", "pieces": ["air"]}],
    [{"kind": "fixed", "pieces": ["red"], "box": {"min": [0, 0, 0], "max": [2, 1, 1]}}],
    [{"kind": "forbidden", "pieces": ["air", "red", "green", "blue"]}],
], ids=["two at once", "no air", "neighbours", "nothing left"])
@pytest.mark.parametrize("blocks", [{}, None], ids=["blocks", "at once"])
def test_constraints_that_nothing_can_meet_are_a_proved_contradiction(server, constraints, blocks):
    job = make_job(server, {"constraints": constraints,
                            **({"blocks": None} if blocks is None else {})})
    assert job["state"] == "failed"
    assert job["error"]["type"] == "/problems/contradiction", job["error"]


def test_a_deadline_fails_the_job_and_keeps_its_preview(server):
    # Seconds of work, of which the first block is done at once, also in the slowest build.
    parameters = {"size": [100, 10, 100], "blocks": {"passes": 100}}
    job = post_job(server, {"solver": "discrete", "example": "castle", "parameters": parameters,
                            "deadline": 0.3}, Prefer="wait=30").json()
    assert job["state"] == "failed"
    assert job["error"]["type"] == "/problems/deadline-exceeded"
    assert job["progress"]["blocks_done"] < job["progress"]["blocks_total"]
    assert server.get(job["urls"]["preview"]).body[:4] == b"glTF"
    assert_problem(server.get(job["urls"]["model"]), 409)


def test_waiting_in_the_queue_does_not_count_to_the_deadline(make_server):
    server = make_server(workers=1)
    with endless_job(server) as running:
        job = post_job(server, job_request(deadline=2.0)).json()
        # Over before ten blocks are done, if waiting counted.
        short_one = post_job(server, job_request(deadline=0.001, priority=-1)).json()
        self_url = running["urls"]["self"]
        wait_until(lambda: server.get(self_url).json()["progress"]["blocks_done"] > 9)
        assert state_of(server, short_one) == "queued"
    assert server.wait(job["id"])["state"] == "succeeded"


def test_the_checker_of_models_sees_every_kind_of_fault(server):
    """The checks of this file are worth something only if they can fail."""
    boundary = {"bottom": "example", "top": ["air"], "north": "free", "south": "free",
                "west": "periodic", "east": "periodic"}
    _, labels = make_model(server, {"size": [6, 2, 4], "boundary": boundary})
    assert_fits(labels, STRIPES, boundary)

    def fails(change=None, boundary=boundary, **held):
        cells = labels["cells"] if change is None else change(list(labels["cells"]))
        with pytest.raises(AssertionError):
            assert_fits({**labels, "cells": cells}, STRIPES, boundary, **held)

    for place in range(len(labels["cells"])):
        fails(lambda cells: cells[:place] + [(cells[place] + 1) % 4] + cells[place + 1:])
    fails(lambda cells: cells[24:] + cells[:24])  # upside down
    fails(lambda cells: cells[::-1])
    fails(boundary={**boundary, "top": ["red"]})
    fails(boundary={**boundary, "north": "red"})
    fails(fixed=[([(0, 1, 0)], ["red"])])
    fails(forbidden=[([(0, 1, 0)], ["air"])])
    _, odd = make_model(server, {"size": [5, 2, 4]})
    assert_fits(odd, STRIPES, {**boundary, "west": "free", "east": "free"})
    with pytest.raises(AssertionError):
        assert_fits(odd, STRIPES, boundary)  # does not close on itself


def test_the_labels_are_laid_out_floor_by_floor(server):
    _, labels = make_model(server, {"size": [5, 4, 3], "boundary": {"bottom": "grass",
                                                                  "top": "air"}}, example=HILLS)
    assert set(labels) == {"size", "pieces", "cells"}
    assert labels["cells"][:15] == [1] * 15 and labels["cells"][-15:] == [0] * 15
    assert Grid(labels["size"], labels["cells"]).at(4, 0, 2) == 1

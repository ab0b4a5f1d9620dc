"""What several tests need: answers judged by the contract, models judged by their example.

Nothing here knows the server's code; neighbours, layers and pointers are worked out anew.
"""

import contextlib
import json
import pathlib
import re
import threading

ENDED = ("succeeded", "failed", "cancelled")

# Keeps one worker busy for many minutes unless it is cancelled.
ENDLESS = {"size": [300, 10, 300],
           "blocks": {"size": [20, 10, 20], "overlap": 0.75, "passes": 60}}

# Three stripes along x, each as long as one likes along z: x and z cannot be mixed up unnoticed.
STRIPES = {
    "kind": "discrete", "name": "stripes", "cell": [1, 2, 3],
    "pieces": [{"name": "air"}, {"name": "red"}, {"name": "green"}, {"name": "blue"}],
    "size": [4, 2, 2],
    "cells": [1, 2, 3, 1, 1, 2, 3, 1] + [0] * 8,
    "empty": "air",
}

# Hills of two heights with trees beside them: several pieces for most cells, no two axes alike.
HILLS = {
    "kind": "discrete", "name": "hills", "cell": [1, 1, 1],
    "pieces": [{"name": "air"}, {"name": "grass"}, {"name": "rock"}, {"name": "tree"},
               {"name": "path"}],
    "size": [6, 4, 5],
    "cells": [1, 1, 1, 4, 1, 1, 1, 2, 1, 4, 1, 1, 1, 2, 1, 4, 1, 3, 1, 2, 1, 4, 1, 1,
              1, 1, 1, 4, 1, 1] +
             [0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0,
              0, 3, 0, 0, 0, 0] +
             [0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0] + [0] * 18 +
             [0] * 30,
    "empty": "air",
    "boundary": {"bottom": "example", "top": "air"},
}


# --- problems

def assert_problem(answer, status, kind=None, instance=None):
    """That the answer is a problem of the contract's form; gives its document."""
    assert answer.status == status, (answer.status, answer.body[:500])
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["status"] == status
    for name in ("type", "title", "detail"):
        assert isinstance(problem[name], str) and problem[name], problem
    if kind is not None:
        assert problem["type"] == f"/problems/{kind}", problem
    if instance is not None:
        assert problem["instance"] == instance, problem
    for error in problem.get("errors", []):
        assert set(error) == {"pointer", "detail"} and error["detail"], error
    return problem


def pointers(problem):
    return [error["pointer"] for error in problem.get("errors", [])]


def resolves(document, pointer):
    """Whether a JSON Pointer (RFC 6901) names a place in the document, or a field that one of its
    objects lacks."""
    if pointer == "":
        return True
    assert pointer.startswith("/"), pointer
    parts = [part.replace("~1", "/").replace("~0", "~") for part in pointer[1:].split("/")]
    for depth, part in enumerate(parts):
        if isinstance(document, dict):
            if part not in document:
                return depth == len(parts) - 1
            document = document[part]
        elif isinstance(document, list):
            if not re.fullmatch(r"0|[1-9][0-9]*", part) or int(part) >= len(document):
                return False
            document = document[int(part)]
        else:
            return False
    return True


def assert_faults(answer, sent, expected):
    """That the answer is a 422 that names exactly these places, each one there in what was sent."""
    problem = assert_problem(answer, 422)
    for pointer in pointers(problem):
        assert resolves(sent, pointer), f"{pointer} is no place in {sent}"
    assert set(pointers(problem)) == set(expected), problem
    return problem


def short(value):
    """The name of a parametrised case."""
    text = json.dumps(value, default=str) if not isinstance(value, (bytes, str)) else str(value)
    return text.replace(json.dumps(STRIPES), "STRIPES")[:70]


# --- jobs

def job_request(parameters=None, **more):
    request = {"solver": "discrete", "example": STRIPES, "seed": 1,
               "parameters": {"size": [6, 2, 4], **(parameters or {})}}
    request.update(more)
    return request


def post_job(server, body, **headers):
    return server.request("POST", "/v1/jobs", body,
                          headers={name.replace("_", "-"): value
                                   for name, value in headers.items()})


def make_job(server, parameters=None, **more):
    """Submits a job and returns it once it has ended."""
    answer = server.request("POST", "/v1/jobs", job_request(parameters, **more),
                            headers={"Prefer": "wait=60"})
    assert answer.status == 200, answer.body
    return answer.json()


def make_model(server, parameters=None, **more):
    """The job, succeeded, and its labels.json."""
    job = make_job(server, parameters, **more)
    assert job["state"] == "succeeded", job["error"]
    return job, server.get(f"/v1/jobs/{job['id']}/labels.json").json()


@contextlib.contextmanager
def endless_job(server, wait_running=True, **more):
    """A job that is being solved for as long as the test likes."""
    answer = server.request("POST", "/v1/jobs", {
        "solver": "discrete", "example": "castle", "parameters": ENDLESS, **more})
    assert answer.status == 202, answer.body
    job = answer.json()
    try:
        if wait_running:
            wait_until(lambda: state_of(server, job) == "running")
        yield job
    finally:
        if server.request("POST", f"/v1/jobs/{job['id']}/cancel").status == 200:
            server.wait(job["id"])


def state_of(server, job):
    return server.get(f"/v1/jobs/{job['id']}").json()["state"]


def wait_until(condition, timeout=30):
    """Waits for a condition that something else brings about, and gives what it says."""
    pause = threading.Event()
    for _ in range(int(timeout / 0.01)):
        value = condition()
        if value:
            return value
        pause.wait(0.01)
    raise AssertionError("this did not come about")


# --- models

AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
SIDES = {"west": ("x", 0), "east": ("x", -1), "bottom": ("y", 0), "top": ("y", -1),
         "north": ("z", 0), "south": ("z", -1)}


class Grid:
    """Cells of a model or an example by place, from the flat array of the contract."""

    def __init__(self, size, cells):
        self.size = tuple(size)
        self.cells = cells
        assert len(cells) == self.size[0] * self.size[1] * self.size[2]

    def at(self, x, y, z):
        return self.cells[x + self.size[0] * (z + self.size[2] * y)]

    def places(self):
        width, height, depth = self.size
        return [(x, y, z) for y in range(height) for z in range(depth) for x in range(width)]

    def layer(self, side):
        axis, end = SIDES[side]
        number = "xyz".index(axis)
        wanted = 0 if end == 0 else self.size[number] - 1
        return {place for place in self.places() if place[number] == wanted}

    def pairs(self, axis, wraps=False):
        """All (lower, upper) neighbours along an axis with the place of the lower one."""
        step = AXES[axis]
        for place in self.places():
            beside = [p + s for p, s in zip(place, step)]
            if beside["xyz".index(axis)] == self.size["xyz".index(axis)]:
                if not wraps:
                    continue
                beside["xyz".index(axis)] = 0
            yield place, self.at(*place), self.at(*beside)


def assert_fits(labels, example, boundary, fixed=(), forbidden=()):
    """That a labels.json keeps to its example and to what was asked of it.

    example: as GET /v1/examples/{id} tells it, or an inline one; boundary: as the request echoes
    it; fixed, forbidden: pairs (places, names)."""
    names = [piece["name"] for piece in example["pieces"]]
    assert labels["pieces"] == names
    source = Grid(example["size"], example["cells"])
    model = Grid(labels["size"], labels["cells"])
    assert set(model.cells) <= set(source.cells), "a piece that stands nowhere in the example"
    for axis, (low, high) in {"x": ("west", "east"), "y": ("bottom", "top"),
                              "z": ("north", "south")}.items():
        allowed = {(a, b) for _, a, b in source.pairs(axis)}
        wraps = boundary[low] == "periodic"
        assert wraps == (boundary[high] == "periodic")
        for place, a, b in model.pairs(axis, wraps):
            assert (a, b) in allowed, f"{names[a]} then {names[b]} along {axis} at {place}"
    for side, wanted in boundary.items():
        if wanted in ("free", "periodic"):
            continue
        if wanted == "example":
            may = {source.at(*place) for place in source.layer(side)}
        else:
            may = {names.index(name) for name in ([wanted] if isinstance(wanted, str) else wanted)}
        for place in model.layer(side):
            assert model.at(*place) in may, f"{names[model.at(*place)]} on the {side} at {place}"
    for places, wanted in fixed:
        for place in places:
            assert names[model.at(*place)] in wanted, f"{names[model.at(*place)]} at {place}"
    for places, unwanted in forbidden:
        for place in places:
            assert names[model.at(*place)] not in unwanted, f"{names[model.at(*place)]} at {place}"
    return model


def box_places(low, high):
    return [(x, y, z) for x in range(low[0], high[0]) for y in range(low[1], high[1])
            for z in range(low[2], high[2])]


# --- the store, seen from outside

def files_of(server, *folders):
    """The files in folders of the server's data directory."""
    return {str(path.relative_to(server.data)) for folder in folders
            for path in pathlib.Path(server.data, folder).rglob("*") if path.is_file()}


def together(count, work):
    """Runs work(0) ... work(count - 1) at once, each in a thread of its own; gives what they
    returned."""
    barrier = threading.Barrier(count)
    results = [None] * count
    failures = []

    def run(number):
        try:
            barrier.wait(timeout=30)
            results[number] = work(number)
        except Exception as failure:  # told by the caller's thread
            failures.append(failure)

    threads = [threading.Thread(target=run, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
    assert not failures, failures
    return results


def compact(document):
    return json.dumps(document, separators=(",", ":")).encode()


def check_events(events, log, after=0):
    """That what came is the log after that event, but for what a snapshot stands for."""
    seq = after
    for event in events:
        if event["type"] == "snapshot":
            assert event["seq"] > seq
            assert event["job"]["id"] == _log_id(log) and event["job"]["state"] == "running"
            blocks = [each for each in log[:event["seq"]] if each["type"] == "block"]
            assert event["job"]["progress"]["blocks_done"] == len(blocks)
        else:
            assert event["seq"] == seq + 1
            assert event == log[event["seq"] - 1]
        seq = event["seq"]
    assert events[-1] == log[-1]


def _log_id(log):
    return log[-1]["result"]["model"].split("/")[3]

"""How soon a cancel frees the worker, as a table. Starts a server of its own with one worker.

    /usr/bin/python3 tests/load/cancel.py [--times 20] [--only NAME] [--seed N]

Of each kind of job, as large as the server takes it or nearly, some are cancelled at random moments
of their first seconds, each with a small job queued behind it: what counts is the time from the
cancel until that one has begun.
"""

import argparse
import datetime
import os
import pathlib
import random
import shutil
import statistics
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))

from conftest import Server  # noqa: E402
from workload import YARD  # noqa: E402

GOAL_MS = 50
STREETS = ["street_x", "street_z", "street_lamps_x", "street_lamps_z", "street_cars_x",
           "street_cars_z", "street_crossing"] + [
    f"street_{what}_{side}" for what in ("zebra", "fork", "end", "turn") for side in "enws"]


def constraint(kind, **more):
    return {"constraints": [{"kind": kind, **more}]}


# Solver, example, size, further parameters; the seconds in which it is cancelled.
JOBS = {
    "city in blocks": ("discrete", "city", (632, 10, 632), {}, 3),
    "castle in passes": ("discrete", "castle", (632, 10, 632), {"blocks": {"passes": 4}}, 3),
    "castle at once": ("discrete", "castle", (400, 16, 400), {"blocks": None}, 3),
    "castle at once, by entropy": (
        "discrete", "castle", (300, 10, 300), {"blocks": None, "order": "min_entropy"}, 3),
    "castle, trees apart": (
        "discrete", "castle", (500, 10, 500),
        constraint("separation", pieces=["tree", "cypress"], distance=5), 3),
    "city, streets connected": (
        "discrete", "city", (400, 10, 400), constraint("connected", pieces=STREETS), 3),
    "city, symmetric": ("discrete", "city", (400, 10, 400), constraint("symmetry", reflect="z"), 3),
    "castle, few trees": (
        "discrete", "castle", (400, 10, 400),
        constraint("objective", terms=[{"term": "count", "pieces": ["tree"], "target": 0}]), 3),
    "pentagons": ("continuous", "pentagons", (60, 20, 60), {}, 2),
    "skyscrapers": ("continuous", "skyscrapers", (160, 24, 160), {}, 2),
    "houses": ("continuous", "houses", (150, 12, 150), {}, 3),
    "houses, symmetric": (
        "continuous", "houses", (60, 12, 60), constraint("symmetry", reflect="z"), 3),
    "roads": ("continuous", "roads", (300, 9, 300), {}, 3),
    "terrain": ("continuous", "terrain", (120, 20, 120), {}, 4),
    "spaceships": ("continuous", "spaceships", (120, 20, 120), {}, 4),
}


def ask(server, method, path):
    answer = server.request(method, path)
    assert answer.status == 200, (path, answer.status, answer.body)
    return answer.json()


def seconds_of(time_text):
    return datetime.datetime.fromisoformat(time_text.replace("Z", "+00:00")).timestamp()


def cancel_once(server, job, seed, after):
    """Milliseconds from the cancel to the start of the job behind, and the blocks done by then;
    None when the job had ended."""
    solver, example, size, parameters, _ = job
    # Each of another width, so that nothing is there from the one before.
    large = server.submit((size[0] - seed, *size[1:]), seed, example, solver, parameters=parameters)
    behind = server.submit((6, 3, 6), seed, YARD)
    while ask(server, "GET", f"/v1/jobs/{large['id']}")["state"] == "queued":
        time.sleep(0.002)
    time.sleep(after)
    begun = time.time()
    ended = ask(server, "POST", f"/v1/jobs/{large['id']}/cancel")
    behind = ask(server, "GET", f"/v1/jobs/{behind['id']}?wait=60")
    while behind["state"] != "succeeded":
        behind = ask(server, "GET", f"/v1/jobs/{behind['id']}?wait=60&since={behind['seq']}")
    started = seconds_of(behind["started"])
    if started < begun - 0.001:
        return None
    return (started - begun) * 1000, ended["progress"]["blocks_done"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--only", choices=JOBS)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-cancel-"))
    server = Server(directory / "data", workers=1).start()
    print(f"Milliseconds from the cancel to the start of the job behind; goal {GOAL_MS}\n\n"
          "| job | cancelled | median | worst | when | blocks done then | over the goal |\n"
          "|---|---|---|---|---|---|---|", flush=True)
    try:
        for name, job in JOBS.items():
            if options.only not in (None, name):
                continue
            moments = random.Random(f"{options.seed} {name}")
            taken = []
            for seed in range(options.times):
                after = moments.uniform(0, job[-1])
                once = cancel_once(server, job, seed, after)
                if once:
                    taken.append((*once, after))
            if not taken:
                print(f"| {name} | none: each had ended | | | | | |", flush=True)
                continue
            worst, blocks, after = max(taken)
            late = sum(each[0] > GOAL_MS for each in taken)
            print(f"| {name} | {len(taken)} | {statistics.median(t[0] for t in taken):.0f} "
                  f"| {worst:.0f} | {after:.2f} s | {blocks} | {late} |", flush=True)
    finally:
        server.kill()
        shutil.rmtree(directory)
    print(f"\nLoad of the machine at the end: {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()

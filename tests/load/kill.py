"""kill -9 again and again under load, and what must hold after each start.

    /usr/bin/python3 tests/load/kill.py [--kills 200] [--seed N] [--clients 6]

Clients submit, watch, cancel and delete jobs all the time while the server is killed at random
moments. After each start every job that was acknowledged is there or was deleted, has one end at
most, events 1..n without a gap that are those seen before, and, if it succeeded, the bytes that an
undisturbed server makes. Exit code 1 when something does not hold; the seed is printed.
"""

import argparse
import hashlib
import http.client
import json
import pathlib
import random
import shutil
import statistics
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "service"))

from conftest import Server, parse_sse  # noqa: E402
from event_reader import EventReader, StreamBroken  # noqa: E402
from workload import TILES, YARD  # noqa: E402

ENDS = ("succeeded", "failed", "cancelled")
SIZES = [(12, 6, 12), (30, 6, 30), (60, 6, 60), (100, 6, 100)]
UNFINISHED_MAX = 40


def requests():
    """What is asked for, over and over: each with a seed, so that its model is known."""
    yard = [{"solver": "discrete", "example": YARD, "seed": seed, "parameters": {
        "size": list(size), "weights": "uniform"}} for seed, size in enumerate(SIZES * 2)]
    tiles = [{"solver": "discrete", "example": TILES, "seed": seed, "parameters": {
        "size": [40, 1, 40], "weights": "uniform",
        "blocks": {"size": [8, 1, 8], "overlap": 0, "attempts": 1}}} for seed in range(2)]
    return yard + tiles


class Wrong(AssertionError):
    pass


def must(condition, *what):
    if not condition:
        raise Wrong(" ".join(str(each) for each in what))


class Job:
    """What the clients know of a job that was acknowledged."""

    def __init__(self, number):
        self.number = number  # of its request
        self.texts = []       # of the events seen, in order
        self.end = None       # as first seen
        self.cancel = False   # somebody asked for it
        self.delete = None    # "asked" or "done"
        self.checked = False  # whole log and model, after its end

    def saw(self, seq, text):
        must(seq <= len(self.texts) + 1, "a gap before event", seq)
        if seq <= len(self.texts):
            must(self.texts[seq - 1] == text, "event", seq, "was", self.texts[seq - 1], "is", text)
        else:
            self.texts.append(text)


class Soak:
    def __init__(self, server, seed):
        self.server = server
        self.random = random.Random(seed)
        self.requests = requests()
        self.digests = {}
        self.jobs = {}
        self.lock = threading.Lock()
        self.stop = threading.Event()
        self.up = threading.Event()  # what is asked meanwhile can be answered
        self.wrong = []
        self.counts = dict.fromkeys(
            ["submitted", "replayed", "cancels", "deletes", "streams", "cut streams", "checked",
             *ENDS, "crashed"], 0)

    def count(self, name):
        with self.lock:
            self.counts[name] += 1

    # --- clients

    def client(self, seed):
        rng = random.Random(seed)
        while not self.stop.is_set():
            if not self.up.wait(0.1):
                continue
            act = rng.choices([self.submit, self.watch, self.cancel, self.delete],
                              [5, 4, 1, 2])[0]
            try:
                act(rng)
            except (OSError, http.client.HTTPException, StreamBroken, TimeoutError):
                self.stop.wait(0.01)  # killed meanwhile
            except Exception as error:  # pylint: disable=broad-except
                self.wrong.append(f"{act.__name__}: {type(error).__name__}: {error}")
                self.stop.set()

    def known(self, wanted):
        with self.lock:
            return [job_id for job_id, job in self.jobs.items() if wanted(job)]

    def submit(self, rng):
        if len(self.known(lambda job: job.end is None and not job.delete)) >= UNFINISHED_MAX:
            self.stop.wait(0.01)
            return
        number = rng.randrange(len(self.requests))
        key = f"{rng.random()}"
        first = None
        for attempt in range(100):
            try:
                answer = self.server.request("POST", "/v1/jobs", self.requests[number],
                                             {"Idempotency-Key": key}, timeout=10)
            except (OSError, http.client.HTTPException):
                if self.stop.wait(0.05):
                    return
                continue
            if answer.status == 503:
                return
            must(answer.status == 202, "submitting was answered with", answer.status, answer.body)
            job_id = answer.json()["id"]
            if first not in (None, job_id):
                # A key lives as long as its job.
                must(self.jobs[first].delete, "one key made", first, "and", job_id)
                first = None
            with self.lock:
                self.jobs.setdefault(job_id, Job(number))
            if first is None:
                self.count("submitted")
                if attempt == 0 and rng.random() < 0.8:
                    return
                first = job_id  # and once more, as a client that lost the answer would
                continue
            self.count("replayed")
            must(answer.headers.get("idempotent-replayed") == "true", "no word of the replay")
            return

    def watch(self, rng):
        ids = self.known(lambda job: not job.delete and not job.checked)
        if not ids:
            return
        job_id = rng.choice(ids)
        job = self.jobs[job_id]
        self.count("streams")
        after = rng.randrange(len(job.texts) + 1)
        try:
            with EventReader(self.server.port, job_id, f"?after={after}", timeout=10) as reader:
                if reader.status == 404:
                    must(job.delete, job_id, "is 404")
                    return
                if reader.status == 204:
                    return
                must(reader.status == 200, "the events were answered with", reader.status)
                seq = after
                while (event := reader.next()) is not None:
                    if event["type"] == "snapshot":
                        return
                    seq += 1
                    must(event["seq"] == seq, "event", event["seq"], "instead of", seq)
                    with self.lock:
                        job.saw(seq, event.text)
                    if rng.random() < 0.02:
                        return  # a client that vanishes
        except StreamBroken:
            self.count("cut streams")

    def cancel(self, rng):
        ids = self.known(lambda job: job.end is None and not job.delete)
        if ids and rng.random() < 0.5:
            job_id = rng.choice(ids)
            self.jobs[job_id].cancel = True
            answer = self.server.request("POST", f"/v1/jobs/{job_id}/cancel", timeout=10)
            must(answer.status == 200 or self.jobs[job_id].delete, "cancel:", answer.status)
            self.count("cancels")

    def delete(self, rng):
        ids = self.known(lambda job: (job.checked or rng.random() < 0.03) and not job.delete)
        if ids:
            job_id = rng.choice(ids)
            self.jobs[job_id].delete = "asked"
            answer = self.server.request("DELETE", f"/v1/jobs/{job_id}", timeout=10)
            must(answer.status in (204, 404), "delete:", answer.status, answer.body)
            if answer.status == 204:
                self.jobs[job_id].delete = "done"
                self.count("deletes")

    # --- what must hold

    def check(self, job_id, job):
        answer = self.server.get(f"/v1/jobs/{job_id}")
        if job.delete:
            must(answer.status == 404 or job.delete == "asked", job_id, "was deleted, and is",
                 answer.status)
            return
        must(answer.status == 200, job_id, "was acknowledged, and is", answer.status)
        state = answer.json()["state"]
        must(job.end in (None, state), job_id, "was", job.end, "and is", state)
        if state not in ENDS or job.checked:
            return
        stream = self.server.get(f"/v1/jobs/{job_id}/events")
        must(stream.status == 200, job_id, "has events", stream.status)
        texts = [line[6:] for line in stream.body.decode().split("\n") if line.startswith("data: ")]
        events = parse_sse(stream.body.decode())
        must([event["seq"] for event in events] == list(range(1, len(events) + 1)), job_id,
             "has a gap")
        with self.lock:
            seen = list(job.texts)
        must(texts[:len(seen)] == seen, job_id, "has other events than were seen")
        ends = [event["type"] for event in events if event["type"] in ENDS]
        must(ends == [state] and events[-1]["type"] == state, job_id, state, "ended with", ends)
        must(state != "cancelled" or job.cancel, job_id, "was cancelled by nobody")
        blocks = [event["index"] for event in events if event["type"] == "block"]
        must(blocks == list(range(len(blocks))), job_id, "has blocks", blocks)
        if state == "succeeded":
            model = self.server.get(f"/v1/jobs/{job_id}/model.glb")
            digest = hashlib.sha256(model.body).hexdigest()
            must(digest == self.digests[job.number] == answer.json()["result"]["sha256"],
                 job_id, "has another model")
        if state == "failed":
            problem = answer.json()["error"]["type"]
            must(problem == "/problems/crashed", job_id, "failed:", problem)
            self.count("crashed")
        self.count(state)
        self.count("checked")
        job.end, job.checked = state, True

    def check_all(self):
        """While the clients go on; what they delete meanwhile is no fault."""
        for job_id in self.known(lambda job: job.delete != "forgotten"):
            job = self.jobs[job_id]
            try:
                was_deleted = job.delete == "done"
                self.check(job_id, job)
                if was_deleted:
                    job.delete = "forgotten"  # seen to stay away after a start
            except Wrong:
                if not job.delete:
                    raise


def undisturbed(soak, server):
    for number, request in enumerate(soak.requests):
        job = server.request("POST", "/v1/jobs", request, {"Prefer": "wait=60"}).json()
        must(job["state"] == "succeeded", job)
        soak.digests[number] = job["result"]["sha256"]


def run(options, directory):
    server = Server(directory / "data", workers=2)
    soak = Soak(server, options.seed)
    reference = Server(directory / "reference", workers=1).start()
    undisturbed(soak, reference)
    reference.stop()
    threads = [threading.Thread(target=soak.client, args=(options.seed * 1000 + number,))
               for number in range(options.clients)]
    starts = []
    for thread in threads:
        thread.start()
    try:
        for kill in range(options.kills):
            begun = time.monotonic()
            server.start()
            starts.append(time.monotonic() - begun)
            soak.up.set()
            # Some before the server has done anything, most in the middle of work.
            time.sleep(soak.random.choice([0.0, 0.01, 0.1, 0.3, 0.6]) * soak.random.random())
            if kill % 2:
                soak.check_all()
            soak.up.clear()
            server.kill()
            if soak.wrong:
                break
        server.start()
        soak.up.set()
        soak.stop.set()
        for thread in threads:
            thread.join()
        for job_id in soak.known(lambda job: not job.delete):
            server.wait(job_id, timeout=120)
        soak.check_all()
        left = [name for name in (directory / "data/tmp").iterdir()]
        must(not left, "left in tmp/:", left)
        must(server.stop() == 0, "no clean end")
    finally:
        soak.stop.set()
        server.kill()
    must(not soak.wrong, *soak.wrong)
    return soak, starts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--clients", type=int, default=6)
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 20))
    options = parser.parse_args()
    print(f"seed {options.seed}", flush=True)
    directory = pathlib.Path(tempfile.mkdtemp(prefix="modelsynth-kill-"))
    begun = time.monotonic()
    try:
        soak, starts = run(options, directory)
    except Wrong as wrong:
        print(f"WRONG: {wrong}\nthe store is kept in {directory}")
        return 1
    shutil.rmtree(directory)
    print(json.dumps({
        "kills": options.kills, "seconds": round(time.monotonic() - begun),
        "start_ms_median": round(statistics.median(starts) * 1000),
        "start_ms_worst": round(max(starts) * 1000), **soak.counts}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())

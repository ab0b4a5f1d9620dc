"""Times the service as a client sees it and prints a table. Starts a server of its own.

    python3 tests/bench/service_bench.py [--bin DIR] [--rounds N]
"""

import argparse
import http.client
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def request(port, method, path, body=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
    headers = {"Content-Type": "application/json", "Prefer": "wait=60"} if body else {}
    connection.request(method, path, json.dumps(body) if body else None, headers)
    answer = connection.getresponse()
    data = answer.read()
    connection.close()
    assert answer.status in (200, 202), data
    return data


def job(size, seed):
    return {"solver": "discrete", "example": "castle", "seed": seed, "parameters": {"size": size}}


def first_block(port, seed):
    """From sending the request to the first `block` event, both over HTTP."""
    begun = time.perf_counter()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("POST", "/v1/jobs", json.dumps(job([40, 10, 40], seed)),
                       {"Content-Type": "application/json"})
    identity = json.loads(connection.getresponse().read())["id"]
    connection.request("GET", f"/v1/jobs/{identity}/events")
    stream = connection.getresponse()
    while not stream.readline().startswith(b"event: block"):
        pass
    taken = time.perf_counter() - begun
    stream.read()
    connection.close()
    return taken


def round_trip(port, seed):
    """Submit, solve, fetch the GLB."""
    begun = time.perf_counter()
    done = json.loads(request(port, "POST", "/v1/jobs", job([20, 8, 20], seed)))
    model = request(port, "GET", f"/v1/jobs/{done['id']}/model.glb")
    assert model[:4] == b"glTF"
    return time.perf_counter() - begun


def cancel_to_next(port, seed):
    """From sending the cancel of a big running job to the `started` event of the one that waits
    behind it on the only worker."""
    headers = {"Content-Type": "application/json"}
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)

    def submit(size, blocks, wanted):
        """The job's id and its stream, read up to the wanted event."""
        wanted_line = f"event: {wanted}".encode()
        connection.request("POST", "/v1/jobs", json.dumps({
            **job(size, seed), "parameters": {"size": size, "blocks": blocks}}), headers)
        identity = json.loads(connection.getresponse().read())["id"]
        stream = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
        stream.request("GET", f"/v1/jobs/{identity}/events")
        answer = stream.getresponse()
        while not answer.readline().startswith(wanted_line):
            pass
        return identity, stream, answer

    running, watching, _ = submit(
        [300, 10, 300], {"size": [20, 10, 20], "overlap": 0.75, "passes": 60}, "block")
    watching.close()
    _, stream, events = submit([20, 8, 20], {}, "queued")
    begun = time.perf_counter()
    connection.request("POST", f"/v1/jobs/{running}/cancel")
    while not events.readline().startswith(b"event: started"):
        pass
    taken = time.perf_counter() - begun
    connection.getresponse().read()
    events.read()
    stream.close()
    connection.close()
    return taken


def start(options, data, *more):
    server = subprocess.Popen(
        [options.bin / "modelsynthd", "--data", data, "--listen", "127.0.0.1:0",
         "--log-level", "warn", *more], stdout=subprocess.PIPE, text=True)
    return server, int(server.stdout.readline().rsplit(":", 1)[1])


def peak_megabytes(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", default=ROOT / "build/release/bin", type=pathlib.Path)
    parser.add_argument("--rounds", default=15, type=int)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as data:
        server, port = start(options, data)
        try:
            round_trip(port, 0)
            rows = [
                ("request to first block event, castle 40x10x40",
                 [first_block(port, seed) * 1000 for seed in range(options.rounds)], "ms", 30),
                ("round trip with GLB, castle 20x8x20",
                 [round_trip(port, seed) * 1000 for seed in range(options.rounds)], "ms", 60),
            ]
            request(port, "POST", "/v1/jobs", job([200, 10, 200], 1))
            rows.append(("peak memory after castle 200x10x200", [peak_megabytes(server)], "MB",
                         200))
        finally:
            server.terminate()
            server.wait(30)
    with tempfile.TemporaryDirectory() as data:
        server, port = start(options, data, "--workers", "1")
        try:
            rows.append(("cancel of castle 300x10x300 to the next job's started event, 1 worker",
                         [cancel_to_next(port, seed) * 1000 for seed in range(options.rounds)],
                         "ms", 50))
        finally:
            server.terminate()
            server.wait(30)
    print("| what | median | worst | goal |\n|---|---|---|---|")
    for name, values, unit, goal in rows:
        print(f"| {name} | {statistics.median(values):.1f} {unit} | {max(values):.1f} {unit} "
              f"| {goal} {unit} |")


main()

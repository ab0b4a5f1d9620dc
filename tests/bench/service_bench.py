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


def peak_megabytes(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", default=ROOT / "build/release/bin", type=pathlib.Path)
    parser.add_argument("--rounds", default=15, type=int)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as data:
        server = subprocess.Popen(
            [options.bin / "modelsynthd", "--data", data, "--listen", "127.0.0.1:0",
             "--log-level", "warn"], stdout=subprocess.PIPE, text=True)
        try:
            port = int(server.stdout.readline().rsplit(":", 1)[1])
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
    print("| what | median | worst | goal |\n|---|---|---|---|")
    for name, values, unit, goal in rows:
        print(f"| {name} | {statistics.median(values):.1f} {unit} | {max(values):.1f} {unit} "
              f"| {goal} {unit} |")


main()

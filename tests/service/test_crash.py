"""kill -9 at any moment, and a start on the same store: every acknowledged job is there and ends,
its log goes on where it was, and the model is the one an undisturbed server makes."""

import concurrent.futures
import hashlib
import os
import subprocess
import time

import pytest

from event_reader import EventReader, texts
from workload import ENDLESS_JOB, SMALL_JOB, STEADY_JOB, TILES_JOB, YARD, submit

TERMINAL = {"succeeded", "failed", "cancelled"}


@pytest.fixture(scope="module")
def undisturbed(server):
    """The result of STEADY_JOB on a server that nobody kills."""
    job = server.wait(submit(server, STEADY_JOB)["id"])
    assert job["state"] == "succeeded"
    return job


def read_all(server, job_id):
    with EventReader(server.port, job_id) as reader:
        return reader.rest()


def restart(server):
    server.kill()
    return server.start()


def check_ended_job(server, job_id, seen, expected_sha256, kills):
    """The job ends as if nothing had happened, and its log begins with what was seen."""
    job = server.wait(job_id)
    assert job["state"] == "succeeded"
    assert job["result"]["sha256"] == expected_sha256
    model = server.get(f"/v1/jobs/{job_id}/model.glb")
    assert hashlib.sha256(model.body).hexdigest() == expected_sha256
    events = read_all(server, job_id)
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert texts(events)[:len(seen)] == texts(seen)
    ends = [event["type"] for event in events if event["type"] in TERMINAL]
    assert ends == ["succeeded"]
    assert events[-1]["result"] == job["result"]
    assert events[0]["type"] == "queued"
    assert [event["type"] for event in events].count("queued") == 1
    # No block is logged twice or left out, whatever was solved again.
    blocks = [event for event in events if event["type"] == "block"]
    assert [block["index"] for block in blocks] == list(range(blocks[0]["blocks_total"]))
    starts = [event for event in events if event["type"] == "started"]
    assert "resumed" not in starts[0]
    assert all(start["resumed"] is True for start in starts[1:])
    assert len({start["blocks_total"] for start in starts}) == 1
    assert 1 <= len(starts) <= kills + 1
    return events


def files_in_tmp(server):
    return os.listdir(server.data / "tmp")


def test_jobs_killed_right_after_they_were_acknowledged_are_there_and_end(
        make_server, undisturbed):
    server = make_server()
    jobs = [submit(server, STEADY_JOB) for _ in range(3)]
    server.kill()
    server.start()
    for job in jobs:
        check_ended_job(server, job["id"], [], undisturbed["result"]["sha256"], kills=1)
    listed = [job["id"] for job in server.get("/v1/jobs").json()["items"]]
    assert listed == [job["id"] for job in reversed(jobs)]
    assert files_in_tmp(server) == []


@pytest.mark.parametrize("moment,begun_anew", [
    (lambda event: event["type"] == "started", True),
    (lambda event: event["type"] == "block", True),
    (lambda event: event.get("fraction", 0) > 0.1, True),
    (lambda event: event.get("fraction", 0) > 0.4, True),
    # Here the log may have been ahead of what was read, up to the end.
    (lambda event: event.get("fraction", 0) > 0.99, None),
    (lambda event: event.get("fraction", 0) == 1, None)],
    ids=["after started", "after the first block", "early", "in the middle", "near the end",
         "after the last block"])
def test_a_job_killed_in_the_course_of_it_goes_on_to_the_same_model(
        make_server, undisturbed, moment, begun_anew):
    server = make_server()
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(moment)
        server.kill()
        seen += reader.rest_before_crash()
    server.start()
    assert files_in_tmp(server) == []
    events = check_ended_job(
        server, job["id"], seen, undisturbed["result"]["sha256"], kills=1)
    if begun_anew:
        assert [event["type"] for event in events].count("started") == 2


def test_a_job_killed_right_after_its_last_event_stays_as_it_was(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(lambda event: event["type"] == "succeeded")
    server.kill()
    server.start()
    assert server.get(f"/v1/jobs/{job['id']}").json()["state"] == "succeeded"
    events = check_ended_job(
        server, job["id"], seen, undisturbed["result"]["sha256"], kills=0)
    assert len(events) == len(seen)


def test_a_job_killed_six_times_on_its_way_ends_with_the_same_model(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    seen = []
    for turn in range(6):
        goal = (turn + 1) / 7
        with EventReader(server.port, job["id"], f"?after={len(seen)}") as reader:
            seen += reader.until_event(lambda event: event["type"] == "started")
            seen += reader.until_event(lambda event: event.get("fraction", 0) > goal)
            server.kill()
            seen += reader.rest_before_crash()
        server.start()
    events = check_ended_job(
        server, job["id"], seen, undisturbed["result"]["sha256"], kills=6)
    assert [event["type"] for event in events].count("started") == 7


def test_a_job_killed_six_times_before_it_gets_anywhere_still_ends(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(lambda event: event.get("fraction", 0) > 0.5)
        server.kill()
        seen += reader.rest_before_crash()
    for _ in range(5):
        server.start()
        server.kill()
    server.start()
    check_ended_job(server, job["id"], seen, undisturbed["result"]["sha256"], kills=6)


def test_a_watcher_who_comes_back_with_last_event_id_misses_nothing(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(lambda event: event.get("fraction", 0) > 0.4)
        server.kill()
        seen += reader.rest_before_crash()
    server.start()
    with EventReader(server.port, job["id"],
                     headers={"Last-Event-ID": str(len(seen))}) as reader:
        seen += reader.rest()
    assert texts(seen) == texts(read_all(server, job["id"]))
    assert seen[-1]["result"]["sha256"] == undisturbed["result"]["sha256"]


def test_many_jobs_of_all_states_survive_a_crash(make_server, server):
    expected = server.wait(submit(server, TILES_JOB)["id"])["result"]["sha256"]
    crashed = make_server()
    done = crashed.wait(submit(crashed, TILES_JOB)["id"])
    before = read_all(crashed, done["id"])
    running = [submit(crashed, STEADY_JOB, seed=seed)["id"] for seed in (1, 2)]
    waiting = [submit(crashed, TILES_JOB)["id"] for _ in range(10)]
    with EventReader(crashed.port, running[0]) as reader:
        reader.until_event(lambda event: event["type"] == "block")
    crashed.kill()
    crashed.start()
    assert texts(read_all(crashed, done["id"])) == texts(before)
    assert crashed.get(f"/v1/jobs/{done['id']}").json() == done
    for job_id in waiting:
        check_ended_job(crashed, job_id, [], expected, kills=1)
    for job_id in running:
        assert crashed.wait(job_id)["state"] == "succeeded"
    assert files_in_tmp(crashed) == []


def test_cancelled_jobs_stay_cancelled_after_a_crash(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB)["id"], submit(server, SMALL_JOB)["id"]
    with EventReader(server.port, running) as reader:
        reader.until_event(lambda event: event["type"] == "block")
    for job_id in (waiting, running):
        assert server.request("POST", f"/v1/jobs/{job_id}/cancel").status == 200
    server.kill()
    server.start()
    # Whoever comes after them is served, and they are not.
    assert server.wait(submit(server, SMALL_JOB)["id"])["state"] == "succeeded"
    for job_id in (running, waiting):
        job = server.get(f"/v1/jobs/{job_id}").json()
        assert job["state"] == "cancelled"
        assert job["finished"] is not None
        events = read_all(server, job_id)
        assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
        assert [event["type"] for event in events if event["type"] in TERMINAL] == ["cancelled"]
        assert events[-1]["type"] == "cancelled"
    assert [event["type"] for event in read_all(server, waiting)] == ["queued", "cancelled"]


def test_deleted_jobs_stay_forgotten_after_a_crash(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB)["id"], submit(server, SMALL_JOB)["id"]
    for job_id in (waiting, running):
        assert server.request("DELETE", f"/v1/jobs/{job_id}").status == 204
    server.kill()
    server.start()
    for job_id in (running, waiting):
        assert server.get(f"/v1/jobs/{job_id}").status == 404
    assert server.get("/v1/jobs").json()["items"] == []


def test_the_preview_of_a_begun_job_that_waits_again_after_a_crash_is_still_there(make_server):
    server = make_server(workers=1)
    job = submit(server, ENDLESS_JOB)["id"]
    with EventReader(server.port, job) as reader:
        reader.until_event(lambda event: event.get("blocks_done", 0) > 300)
    assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200
    first_in_line = submit(server, ENDLESS_JOB, priority=10)["id"]
    restart(server)
    with EventReader(server.port, first_in_line) as reader:
        reader.until_event(lambda event: event["type"] == "started")
    assert server.get(f"/v1/jobs/{job}").json()["state"] == "queued"
    assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200
    assert server.get(f"/v1/jobs/{job}").json()["state"] == "queued"


def test_a_job_has_a_preview_from_its_first_block_on_whenever_the_server_is_killed(make_server):
    server = make_server(workers=1)
    job = submit(server, ENDLESS_JOB)["id"]
    with EventReader(server.port, job) as reader:
        reader.until_event(lambda event: event.get("outcome") == "accepted")
        server.kill()
    server.start()
    # Before the job runs again, while it does, and after it was cancelled.
    assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200
    with EventReader(server.port, job) as reader:
        reader.until_event(lambda event: event.get("resumed"))
        assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200
    server.request("POST", f"/v1/jobs/{job}/cancel")
    assert server.wait(job)["state"] == "cancelled"
    assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200


def test_a_cancelled_job_that_waited_again_after_a_crash_keeps_its_preview(make_server):
    server = make_server(workers=1)
    job = submit(server, ENDLESS_JOB)["id"]
    with EventReader(server.port, job) as reader:
        reader.until_event(lambda event: event.get("blocks_done", 0) > 300)
    first_in_line = submit(server, ENDLESS_JOB, priority=10)["id"]
    restart(server)
    with EventReader(server.port, first_in_line) as reader:
        reader.until_event(lambda event: event["type"] == "started")
    assert server.request("POST", f"/v1/jobs/{job}/cancel").json()["state"] == "cancelled"
    assert server.get(f"/v1/jobs/{job}/preview.glb").status == 200


def test_an_idempotency_key_survives_a_crash(make_server):
    server = make_server()
    body = {"solver": "discrete", "example": YARD, "parameters": {"size": [20, 6, 20]}}
    headers = {"Idempotency-Key": "once"}
    first = server.request("POST", "/v1/jobs", body, headers).json()
    server.kill()
    server.start()
    again = server.request("POST", "/v1/jobs", body, headers)
    assert again.json()["id"] == first["id"]
    assert again.json()["seed"] == first["seed"]
    assert len(server.get("/v1/jobs").json()["items"]) == 1


def test_an_uploaded_example_and_its_job_survive_a_crash(make_server, undisturbed):
    server = make_server()
    example = server.request("POST", "/v1/examples", YARD)
    assert example.status == 201
    job = submit(server, STEADY_JOB, example=example.json()["id"])
    server.kill()
    server.start()
    assert server.get(f"/v1/examples/{example.json()['id']}").json() == example.json()
    check_ended_job(server, job["id"], [], undisturbed["result"]["sha256"], kills=1)


def test_finished_models_survive_a_crash_byte_for_byte(make_server):
    server = make_server()
    job = server.wait(submit(server, SMALL_JOB)["id"])
    paths = [f"/v1/jobs/{job['id']}/{name}" for name in (
        "model.glb", "model.glb?profile=instanced", "model.glb?profile=merged", "labels.json")]
    before = [server.get(path) for path in paths]
    server.kill()
    server.start()
    for path, old in zip(paths, before):
        new = server.get(path)
        assert (new.status, new.body, new.headers["etag"]) == (200, old.body, old.headers["etag"])


def test_what_a_crash_left_in_tmp_is_swept_at_the_start(make_server):
    server = make_server()
    server.kill()
    (server.data / "tmp" / "torn").write_bytes(b"half an artif")
    server.start()
    assert files_in_tmp(server) == []


def test_a_second_process_on_the_same_directory_is_refused(make_server):
    server = make_server()
    job = submit(server, STEADY_JOB)
    second = subprocess.run(
        [server.bin_dir / "modelsynthd", "--data", server.data, "--listen", "127.0.0.1:0"],
        capture_output=True, text=True, timeout=60, check=False)
    assert second.returncode != 0
    assert second.stdout == ""
    assert str(server.data) in second.stderr
    assert server.wait(job["id"])["state"] == "succeeded"
    # A crash leaves no lock behind.
    server.kill()
    server.start()
    assert server.get(f"/v1/jobs/{job['id']}").json()["state"] == "succeeded"


def test_a_job_stopped_gently_goes_on_to_the_same_model(make_server, undisturbed):
    server = make_server()
    job = submit(server, STEADY_JOB)
    seen = []
    for goal in (0.0, 0.3, 0.6):
        with EventReader(server.port, job["id"], f"?after={len(seen)}") as reader:
            seen += reader.until_event(lambda event: event.get("fraction", 0) > goal)
            # Read on meanwhile: of a client that does not, the server cannot take a proper leave.
            with concurrent.futures.ThreadPoolExecutor() as pool:
                rest = pool.submit(reader.rest)
                assert server.stop() == 0
            seen += rest.result()
        server.start()
        if seen[-1]["type"] == "succeeded":  # the job was quicker than its reader
            assert goal > 0
            break
    check_ended_job(server, job["id"], seen, undisturbed["result"]["sha256"], kills=3)
    assert files_in_tmp(server) == []


def test_a_job_that_waited_is_solved_after_a_gentle_stop(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB)["id"], submit(server, SMALL_JOB)["id"]
    with EventReader(server.port, running) as reader:
        reader.until_event(lambda event: event["type"] == "started")
    assert server.stop() == 0
    server.start()
    server.request("POST", f"/v1/jobs/{running}/cancel")
    assert server.wait(running)["state"] == "cancelled"
    assert server.wait(waiting)["state"] == "succeeded"


def test_jobs_that_were_cancelled_expire_like_others(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB)["id"], submit(server, SMALL_JOB)["id"]
    with EventReader(server.port, running) as reader:
        reader.until_event(lambda event: event["type"] == "block")
    for job_id in (waiting, running):
        server.request("POST", f"/v1/jobs/{job_id}/cancel")
    restart(server)
    for job_id in (running, waiting):
        job = server.get(f"/v1/jobs/{job_id}").json()
        assert job["state"] == "cancelled"
        assert job["expires"] is not None


def test_what_has_expired_is_gone_with_its_files_after_the_next_start(make_server):
    server = make_server("--retention-hours", "0.001")  # 3.6 seconds
    job = server.wait(server.submit()["id"])
    model = f"/v1/jobs/{job['id']}/model.glb"
    assert server.get(model).status == 200
    until = time.monotonic() + 30
    while server.get(model).status == 200 and time.monotonic() < until:
        time.sleep(0.1)
    assert server.get(model).status == 410
    server.stop()
    server.start()
    while list(server.data.glob("artifacts/*/*/*")) and time.monotonic() < until:
        time.sleep(0.05)
    assert not list(server.data.glob("artifacts/*/*/*"))
    assert server.get(model).status == 410
    assert server.get(f"/v1/jobs/{job['id']}").json()["state"] == "succeeded"

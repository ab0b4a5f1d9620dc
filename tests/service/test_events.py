"""The event log of a job, as Server-Sent Events carry it."""

import datetime
import re
import threading
import time

import pytest

from checks import check_events
from event_reader import EventReader, texts
from workload import DECLINED_JOB, ENDLESS_JOB, SMALL_JOB, STEADY_JOB, TILES_JOB, submit

TERMINAL = {"succeeded", "failed", "cancelled"}
TIME = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z")


def read_all(server, job_id, query="", **kwargs):
    with EventReader(server.port, job_id, query, **kwargs) as reader:
        assert reader.status == 200
        return reader.rest()


@pytest.fixture(scope="module")
def finished(server):
    """A small job that succeeded, and its events."""
    job = server.wait(submit(server, SMALL_JOB)["id"])
    assert job["state"] == "succeeded"
    return job, read_all(server, job["id"])


def in_threads(*calls):
    """Runs the calls at the same time; returns what they return."""
    results = [None] * len(calls)

    def run(index, call):
        results[index] = call()

    threads = [threading.Thread(target=run, args=pair) for pair in enumerate(calls)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=90)
        assert not thread.is_alive()
    return results


# --- the log


def test_seq_counts_from_one_without_gaps(finished):
    _, events = finished
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))


def test_a_job_is_queued_then_started_then_solved_in_blocks_then_ends_once(finished):
    _, events = finished
    kinds = [event["type"] for event in events]
    assert kinds == ["queued", "started"] + ["block"] * (len(kinds) - 3) + ["succeeded"]
    assert len(kinds) > 10
    assert "resumed" not in events[1]


def test_every_event_has_its_time_in_utc_and_time_does_not_run_backwards(finished):
    job, events = finished
    for event in events:
        assert TIME.fullmatch(event["time"]), event
    times = [datetime.datetime.fromisoformat(event["time"].replace("Z", "+00:00"))
             for event in events]
    assert times == sorted(times)
    assert events[0]["time"] == job["created"]


def test_the_queued_event_tells_the_position(finished):
    _, events = finished
    assert events[0]["position"] == 0


@pytest.mark.parametrize("workload", [SMALL_JOB, TILES_JOB, DECLINED_JOB],
                         ids=["infallible", "fallible", "declined"])
def test_block_events_tell_place_outcome_and_progress(server, workload):
    job = server.wait(submit(server, workload)["id"])
    events = read_all(server, job["id"])
    blocks = [event for event in events if event["type"] == "block"]
    total = events[1]["blocks_total"]
    assert total == len(blocks) == job["progress"]["blocks_total"]
    for index, block in enumerate(blocks):
        assert block["index"] == index
        assert block["blocks_done"] == index + 1
        assert block["blocks_total"] == total
        assert abs(block["fraction"] - (index + 1) / total) < 1e-5
        assert block["outcome"] in ("accepted", "reverted")
        assert block["attempts"] >= 1
        low, high = block["region"]["min"], block["region"]["max"]
        for axis in range(3):
            assert 0 <= low[axis] < high[axis] <= workload["size"][axis]
    outcomes = [block["outcome"] for block in blocks]
    assert outcomes.count("accepted") == job["result"]["stats"]["blocks_accepted"]
    assert outcomes.count("reverted") == job["result"]["stats"]["blocks_reverted"]
    if workload is DECLINED_JOB:
        assert "reverted" in outcomes


def test_the_blocks_cover_every_cell_of_the_model(finished):
    _, events = finished
    covered = set()
    for event in events:
        if event["type"] == "block":
            (x0, y0, z0), (x1, y1, z1) = event["region"]["min"], event["region"]["max"]
            covered |= {(x, y, z) for x in range(x0, x1) for y in range(y0, y1)
                        for z in range(z0, z1)}
    width, height, depth = SMALL_JOB["size"]
    assert len(covered) == width * height * depth


def test_the_succeeded_event_carries_the_result_of_the_job(finished):
    job, events = finished
    assert events[-1]["result"] == job["result"]


def test_the_failed_event_carries_the_problem_of_the_job(server):
    job = server.wait(submit(server, ENDLESS_JOB, deadline=0.2)["id"])
    assert job["state"] == "failed"
    last = read_all(server, job["id"])[-1]
    assert last["type"] == "failed"
    assert last["error"] == job["error"]
    assert last["error"]["type"].endswith("/problems/deadline-exceeded")
    assert {"type", "title", "status", "detail"} <= last["error"].keys()


def test_a_job_that_waits_tells_how_many_go_before_it(make_server):
    server = make_server(workers=1)
    running = submit(server, ENDLESS_JOB)
    with EventReader(server.port, running["id"]) as reader:
        reader.until_event(lambda event: event["type"] == "started")
    first, second = submit(server, SMALL_JOB), submit(server, SMALL_JOB)
    with EventReader(server.port, first["id"]) as a, EventReader(server.port, second["id"]) as b:
        assert a.next()["position"] == 0
        assert b.next()["position"] == 1
        server.request("POST", f"/v1/jobs/{running['id']}/cancel")
        assert a.rest()[-1]["type"] == "succeeded"
        assert b.rest()[-1]["type"] == "succeeded"


# --- the carrier


def test_the_answer_is_an_event_stream_that_nobody_may_store(server, finished):
    job, _ = finished
    with EventReader(server.port, job["id"]) as reader:
        assert reader.headers["content-type"].split(";")[0] == "text/event-stream"
        assert reader.headers["cache-control"] == "no-store"
        assert "content-length" not in reader.headers


def test_the_stream_ends_by_itself_after_the_last_event(server):
    job = submit(server, SMALL_JOB)
    with EventReader(server.port, job["id"]) as reader:
        events = reader.rest()
        assert reader.ended
        assert events[-1]["type"] == "succeeded"
        # The connection is done with too, not only the body.
        reader.socket.settimeout(30)
        assert reader.socket.recv(1) == b""


def test_an_http_1_0_client_gets_the_same_events_with_no_chunks(server, finished):
    job, events = finished
    with EventReader(server.port, job["id"], version="1.0") as reader:
        assert reader.status == 200
        assert "transfer-encoding" not in reader.headers
        assert texts(reader.rest()) == texts(events)


def test_an_http_1_0_client_watches_a_running_job_to_its_end(server):
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"], version="1.0") as reader:
        live = reader.rest()
    assert live[-1]["type"] == "succeeded"
    check_events(live, read_all(server, job["id"]))


def test_head_of_the_events_has_no_body(server, finished):
    job, _ = finished
    answer = server.request("HEAD", f"/v1/jobs/{job['id']}/events")
    assert answer.status == 200
    assert answer.body == b""
    assert answer.headers["content-type"].startswith("text/event-stream")


# --- reading again


def test_reading_after_k_gives_exactly_the_tail_for_every_k(server, finished):
    job, events = finished
    for after in range(len(events)):
        assert texts(read_all(server, job["id"], f"?after={after}")) == texts(events[after:]), after


def test_reading_after_the_last_event_of_an_ended_job_gives_nothing_and_ends(server, finished):
    job, events = finished
    answer = server.get(f"/v1/jobs/{job['id']}/events?after={len(events)}")
    assert answer.status in (200, 204)
    assert b"data:" not in answer.body


def test_a_long_log_is_read_whole_and_from_any_page(server):
    job = server.wait(submit(server, STEADY_JOB)["id"])
    events = read_all(server, job["id"])
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert len(events) > 3000
    for after in (1, 255, 256, 257, 999, 1000, 1001, 2048, len(events) - 1):
        assert texts(read_all(server, job["id"], f"?after={after}")) == texts(events[after:])


def test_last_event_id_resumes(server, finished):
    job, events = finished
    for last in (0, 1, 5, len(events) - 1):
        again = read_all(server, job["id"], headers={"Last-Event-ID": str(last)})
        assert texts(again) == texts(events[last:])


@pytest.mark.parametrize("after", ["0", "9", "1000000"])
def test_last_event_id_wins_over_after(server, finished, after):
    job, events = finished
    again = read_all(server, job["id"], f"?after={after}", headers={"Last-Event-ID": "4"})
    assert texts(again) == texts(events[4:])


def test_after_beyond_the_last_event_is_422(server, finished):
    job, events = finished
    for place in (len(events) + 1, 10**9):
        answer = server.get(f"/v1/jobs/{job['id']}/events?after={place}")
        assert answer.status == 422
        assert answer.headers["content-type"] == "application/problem+json"
        assert answer.json()["status"] == 422


def test_last_event_id_beyond_the_last_event_is_422(server, finished):
    job, events = finished
    answer = server.get(f"/v1/jobs/{job['id']}/events",
                        headers={"Last-Event-ID": str(len(events) + 1)})
    assert answer.status == 422


@pytest.mark.parametrize("after", ["abc", "1.5", "", "0x1", "1%20", "+1", "1e1"])
def test_after_that_is_no_whole_number_is_400(server, finished, after):
    job, _ = finished
    answer = server.get(f"/v1/jobs/{job['id']}/events?after={after}")
    assert answer.status == 400
    assert answer.headers["content-type"] == "application/problem+json"


def test_a_negative_after_is_refused(server, finished):
    job, _ = finished
    answer = server.get(f"/v1/jobs/{job['id']}/events?after=-1")
    assert answer.status in (400, 422)


def test_last_event_id_that_is_no_number_is_400(server, finished):
    job, _ = finished
    answer = server.get(f"/v1/jobs/{job['id']}/events", headers={"Last-Event-ID": "abc"})
    assert answer.status == 400


def test_the_events_of_an_unknown_job_are_404(server):
    answer = server.get("/v1/jobs/nobody/events")
    assert answer.status == 404
    assert answer.headers["content-type"] == "application/problem+json"


# --- watching


def test_several_watchers_of_a_running_job_see_the_same_events(server):
    job = submit(server, STEADY_JOB)
    seen = in_threads(*[lambda: read_all(server, job["id"]) for _ in range(4)])
    again = read_all(server, job["id"])
    assert len(again) > 3000
    for one in seen:
        check_events(one, again)


def test_watchers_who_join_in_the_middle_miss_nothing(server):
    job = submit(server, STEADY_JOB)
    joined, seen = [], {}

    def read(after, late):
        with late:
            seen[after] = late.rest()

    with EventReader(server.port, job["id"]) as reader:
        for _ in range(5):
            after = reader.until_event(lambda event: event["seq"] % 400 == 0)[-1]["seq"]
            late = EventReader(server.port, job["id"], f"?after={after}")
            # At once: who does not read for a while gets a snapshot in place of events.
            joined.append(threading.Thread(target=read, args=(after, late)))
            joined[-1].start()
        reader.rest()
    for thread in joined:
        thread.join(timeout=90)
    assert len(seen) == len(joined)
    log = read_all(server, job["id"])
    for after, late in seen.items():
        check_events(late, log, after)


def test_a_reader_at_the_head_of_a_running_job_goes_on_with_the_next_event(server):
    job = submit(server, STEADY_JOB)
    with EventReader(server.port, job["id"]) as reader:
        seen = reader.until_event(lambda event: event["seq"] == 500)
        head = seen[-1]["seq"]
    rest = read_all(server, job["id"], f"?after={head}")
    assert rest[0]["seq"] == head + 1
    assert rest[-1]["type"] == "succeeded"


def test_watchers_who_go_away_disturb_nobody(server):
    job = submit(server, STEADY_JOB)
    leaving = [EventReader(server.port, job["id"]) for _ in range(5)]
    for reader in leaving:
        reader.next()
        reader.close()
    assert [event["seq"] for event in read_all(server, job["id"])][-1] > 3000
    assert server.get("/healthz").status == 200


def test_cancelling_ends_every_stream_with_cancelled(server):
    job = submit(server, ENDLESS_JOB)
    readers = [EventReader(server.port, job["id"]) for _ in range(3)]
    readers[0].until_event(lambda event: event["type"] == "block")
    assert server.request("POST", f"/v1/jobs/{job['id']}/cancel").status == 200
    logs = []
    for reader in readers:
        with reader:
            events = reader.rest()
        assert [event["type"] for event in events if event["type"] in TERMINAL] == ["cancelled"]
        assert events[-1]["type"] == "cancelled"
        logs.append(texts(events))
    assert logs[1] == logs[2] == texts(read_all(server, job["id"]))


def test_cancelling_a_job_that_waits_ends_its_streams(make_server):
    server = make_server(workers=1)
    running = submit(server, ENDLESS_JOB)
    with EventReader(server.port, running["id"]) as reader:
        reader.until_event(lambda event: event["type"] == "started")
    waiting = submit(server, SMALL_JOB)
    with EventReader(server.port, waiting["id"]) as reader:
        assert reader.next()["type"] == "queued"
        server.request("POST", f"/v1/jobs/{waiting['id']}/cancel")
        assert [event["type"] for event in reader.rest()] == ["cancelled"]
    assert server.get(f"/v1/jobs/{running['id']}").json()["state"] == "running"


def test_deleting_a_running_job_ends_its_streams(server):
    job = submit(server, ENDLESS_JOB)
    first, second = (EventReader(server.port, job["id"]) for _ in range(2))
    with first, second:
        first.until_event(lambda event: event["type"] == "block")
        assert server.request("DELETE", f"/v1/jobs/{job['id']}").status == 204
        for reader in (first, second):
            events = reader.rest()
            assert not {event["type"] for event in events} & {"succeeded", "failed"}
    assert server.get(f"/v1/jobs/{job['id']}/events").status == 404


def test_cancelling_an_ended_job_adds_no_event(server, finished):
    job, events = finished
    assert server.request("POST", f"/v1/jobs/{job['id']}/cancel").json()["state"] == "succeeded"
    assert texts(read_all(server, job["id"])) == texts(events)


def test_a_hundred_cancelled_at_any_moment_end_exactly_once(server):
    jobs = []
    for index in range(100):
        job = submit(server, SMALL_JOB, seed=index)
        time.sleep(index % 10 * 0.0007)
        server.request("POST", f"/v1/jobs/{job['id']}/cancel")
        jobs.append(job["id"])
    for job_id in jobs:
        job = server.wait(job_id)
        events = read_all(server, job_id)
        assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
        ends = [event["type"] for event in events if event["type"] in TERMINAL]
        assert ends == [job["state"]]
        assert events[-1]["type"] == job["state"]

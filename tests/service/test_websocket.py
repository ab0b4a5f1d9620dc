"""A job's WebSocket: the handshake, the same events as Server-Sent Events, frames of what changed,
lost clients and slow ones."""

import json
import os
import threading
import time

import pytest

from api_document import ApiDocument
from conftest import Server
from event_reader import PATIENCE, EventReader
from glb_file import GlbFile
from websocket_client import (
    BINARY, GLB, GLB_WHOLE, LABELS, LABELS_WHOLE, TEXT, HandshakeRefused, LabelGrid, StateFrame,
    WebSocketClient)
from workload import (
    DECLINED_JOB, ENDLESS_JOB, SMALL_JOB, STEADY_JOB, SWEEP_JOB, TILES_JOB, YARD, submit)

IS_SANITIZED = "MODELSYNTH_SANITIZED" in os.environ


def connect(server, job, partial=None, after=None, **kwargs):
    query = "&".join(f"{name}={value}" for name, value in
                     (("partial", partial), ("after", after)) if value is not None)
    job_id = job if isinstance(job, str) else job["id"]
    return WebSocketClient(
        server.port, f"/v1/jobs/{job_id}/stream{'?' + query if query else ''}", **kwargs)


def watch(server, job, partial=None, after=None, timeout=60):
    with connect(server, job, partial, after) as client:
        return client.messages(timeout)


def events_of(messages):
    return [message for message in messages if isinstance(message, dict)]


def frames_of(messages):
    return [StateFrame(message) for message in messages if isinstance(message, bytes)]


def labels_of(server, job):
    return server.get(f"/v1/jobs/{job['id']}/labels.json").json()["cells"]


def replayed(messages, size):
    """The cells after all frames, which must come in order."""
    grid = LabelGrid(size)
    last = 0
    for frame in frames_of(messages):
        assert frame.seq > last or (frame.is_whole and frame.seq == last)
        last = frame.seq
        grid.apply(frame)
    return grid.cells


def check_order(messages, after=0):
    """No gap but under a snapshot; a frame of a block comes right after its event."""
    seq = after
    for index, message in enumerate(messages):
        if isinstance(message, dict) and message["type"] == "snapshot":
            assert message["seq"] >= seq
            seq = message["seq"]
        elif isinstance(message, dict):
            assert message["seq"] == seq + 1
            seq += 1
        elif isinstance(message, bytes):
            frame = StateFrame(message)
            if not frame.is_whole:
                assert frame.seq == seq == messages[index - 1]["seq"]
                assert messages[index - 1]["outcome"] == "accepted"
                assert frame.min == messages[index - 1]["region"]["min"]
                assert frame.max == messages[index - 1]["region"]["max"]
            else:
                # A whole state stands for everything the client was told so far.
                assert frame.seq >= seq or messages[index + 1]["seq"] == frame.seq + 1
    return seq


def wait_for(condition, timeout=60):
    until = time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < until, "it did not happen in time"
        time.sleep(0.01)


@pytest.fixture(scope="module")
def finished(server):
    """A small job that succeeded, and its events as Server-Sent Events carry them."""
    job = server.wait(submit(server, SMALL_JOB)["id"])
    assert job["state"] == "succeeded"
    return job, server.events(job["id"])


# --- handshake


def test_the_subprotocol_is_echoed(server, finished):
    with connect(server, finished[0]) as client:
        assert client.status == 101
        assert client.headers["sec-websocket-protocol"] == "modelsynth.v1"
        assert "sec-websocket-extensions" not in client.headers


def test_the_subprotocol_is_found_among_others(server, finished):
    with connect(server, finished[0], protocol="chat, modelsynth.v1,other") as client:
        assert client.headers["sec-websocket-protocol"] == "modelsynth.v1"


@pytest.mark.parametrize("protocol", [None, "modelsynth.v2", "MODELSYNTH.V1", "modelsynth.v1x"])
def test_without_the_subprotocol_the_handshake_is_refused_with_400(server, finished, protocol):
    with pytest.raises(HandshakeRefused) as refused:
        connect(server, finished[0], protocol=protocol)
    assert refused.value.status == 400
    assert refused.value.headers["content-type"] == "application/problem+json"


def test_a_plain_get_is_told_to_upgrade(server, finished):
    answer = server.get(f"/v1/jobs/{finished[0]['id']}/stream")
    assert answer.status in (400, 426)
    assert answer.headers["content-type"] == "application/problem+json"
    if answer.status == 426:
        assert answer.headers["upgrade"].lower() == "websocket"


@pytest.mark.parametrize("query,status", [
    ("after=abc", 400), ("after=-1", 422), ("after=1000000", 422), ("partial=everything", 422),
    ("partial=", 422), ("aftr=1", 400)])
def test_a_bad_query_is_refused_before_the_upgrade(server, finished, query, status):
    with pytest.raises(HandshakeRefused) as refused:
        WebSocketClient(server.port, f"/v1/jobs/{finished[0]['id']}/stream?{query}")
    assert refused.value.status == status
    assert refused.value.headers["content-type"] == "application/problem+json"


def test_an_unknown_job_is_404_before_the_upgrade(server):
    with pytest.raises(HandshakeRefused) as refused:
        connect(server, "nobody")
    assert refused.value.status == 404


@pytest.mark.parametrize("headers", [
    {"Sec-WebSocket-Version": "12"}, {"Sec-WebSocket-Version": None},
    {"Sec-WebSocket-Key": None}, {"Sec-WebSocket-Key": "short"}, {"Connection": "keep-alive"}],
    ids=["old version", "no version", "no key", "bad key", "no connection"])
def test_a_handshake_that_lacks_something_is_refused_with_a_problem(server, finished, headers):
    with pytest.raises(HandshakeRefused) as refused:
        connect(server, finished[0], headers=headers)
    assert 400 <= refused.value.status < 500
    assert refused.value.headers["content-type"] == "application/problem+json"


# --- events


def test_a_finished_job_gives_the_same_events_as_sse_and_closes_with_1000(server, finished):
    job, events = finished
    messages = watch(server, job)
    assert messages[:-1] == events
    assert messages[-1].close_code == 1000


def test_a_running_job_gives_the_same_events_as_sse_and_closes_with_1000(server):
    job = submit(server, STEADY_JOB)
    messages = watch(server, job)
    assert messages[-1].close_code == 1000
    assert messages[-2]["type"] == "succeeded"
    assert messages[:-1] == server.events(job["id"])


def test_every_event_is_one_text_message_as_sse_has_it(server, finished):
    job, events = finished
    with EventReader(server.port, job["id"]) as reader:
        texts = [event.text.encode() for event in reader.rest()]
    with connect(server, job) as client:
        assert [client.message().payload for _ in events] == texts


def test_reading_after_k_gives_exactly_the_tail_for_every_k(server, finished):
    job, events = finished
    for after in range(len(events) + 1):
        messages = watch(server, job, after=after)
        assert messages[:-1] == events[after:], after
        assert messages[-1].close_code == 1000


@pytest.mark.parametrize("after", [0, 9, 1000000])
def test_last_event_id_wins_over_after(server, finished, after):
    job, events = finished
    with connect(server, job, after=after, headers={"Last-Event-ID": "4"}) as client:
        assert client.messages()[:-1] == events[4:]


def test_one_event_beyond_the_last_is_refused(server, finished):
    job, events = finished
    with pytest.raises(HandshakeRefused) as refused:
        connect(server, job, after=len(events) + 1)
    assert refused.value.status == 422


def test_a_cancelled_job_ends_with_cancelled_and_1000(server):
    job = submit(server, ENDLESS_JOB)
    with connect(server, job) as client:
        while client.message().opcode != TEXT:
            pass
        server.request("POST", f"/v1/jobs/{job['id']}/cancel")
        messages = client.messages()
    assert messages[-2]["type"] == "cancelled"
    assert messages[-1].close_code == 1000


def test_a_failed_job_ends_with_failed_and_1000(server):
    job = submit(server, ENDLESS_JOB, deadline=0.2)
    messages = watch(server, job)
    assert messages[-2]["type"] == "failed"
    assert messages[-1].close_code == 1000


def test_deleting_the_job_closes_its_websockets(server):
    job = submit(server, ENDLESS_JOB)
    with connect(server, job) as client:
        client.message()
        assert server.request("DELETE", f"/v1/jobs/{job['id']}").status == 204
        messages = client.messages()
    assert not {event["type"] for event in events_of(messages)} & {"succeeded", "failed"}
    # Not 1000: that comes after the last event only.
    assert messages[-1].close_code in (1001, 1008)


# --- frames of what changed


def test_without_partial_there_are_no_binary_frames(server, finished):
    assert frames_of(watch(server, finished[0], partial="none")) == []


def test_label_frames_replayed_from_the_start_give_the_finished_model(server):
    job = submit(server, SMALL_JOB)
    messages = watch(server, job, partial="labels")
    check_order(messages)
    assert {frame.kind for frame in frames_of(messages)} <= {LABELS, LABELS_WHOLE}
    assert replayed(messages, SMALL_JOB["size"]) == labels_of(server, job)


def test_label_frames_give_the_finished_model_though_blocks_were_reverted(server):
    job = submit(server, DECLINED_JOB)
    messages = watch(server, job, partial="labels")
    check_order(messages)
    assert "reverted" in [event.get("outcome") for event in events_of(messages)]
    assert replayed(messages, DECLINED_JOB["size"]) == labels_of(server, job)


def test_label_frames_give_the_finished_model_when_it_is_solved_at_once(server):
    job = server.submit((6, 4, 6), example=YARD, parameters={"blocks": None})
    messages = watch(server, job, partial="labels")
    assert replayed(messages, (6, 4, 6)) == labels_of(server, job)


def test_every_accepted_block_is_followed_by_its_frame_for_all_who_were_there_from_the_start(
        server):
    jobs = [submit(server, {**STEADY_JOB, "parameters": {
        "weights": "uniform", "blocks": {"size": [5, 6, 5], "passes": 3}}}, seed=seed)
        for seed in (1, 2)]
    seen = {}

    def run(key, job):
        seen[key] = watch(server, job, partial="labels")

    threads = [threading.Thread(target=run, args=((index, copy), job))
               for index, job in enumerate(jobs) for copy in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=90)
    assert len(seen) == 6
    for (index, _), messages in seen.items():
        check_order(messages)
        for number, message in enumerate(messages):
            if isinstance(message, dict) and message.get("outcome") == "accepted":
                assert isinstance(messages[number + 1], bytes)
                assert StateFrame(messages[number + 1]).seq == message["seq"]
        assert replayed(messages, STEADY_JOB["size"]) == labels_of(server, jobs[index])


def test_a_reverted_block_has_no_frame(server):
    messages = watch(server, submit(server, TILES_JOB), partial="labels")
    for index, message in enumerate(messages):
        if isinstance(message, dict) and message.get("outcome") == "reverted":
            following = messages[index + 1]
            assert not isinstance(following, bytes) or StateFrame(following).is_whole


def test_no_state_is_sent_before_the_first_block(server):
    """However long that takes: each accepted block is followed by one frame, and that is all."""
    slow_to_begin = {**SMALL_JOB, "size": (300, 6, 300)}
    messages = watch(server, submit(server, slow_to_begin), partial="labels")
    accepted = [event["seq"] for event in events_of(messages)
                if event.get("outcome") == "accepted"]
    frames = frames_of(messages)
    assert frames[0].is_whole and frames[0].seq == accepted[0]
    assert {frame.seq for frame in frames} <= set(accepted)


def test_glb_frames_are_whole_glb_files_within_the_model(server):
    job = submit(server, SMALL_JOB)
    messages = watch(server, job, partial="glb")
    check_order(messages)
    frames = frames_of(messages)
    accepted = [event["seq"] for event in events_of(messages)
                if event.get("outcome") == "accepted"]
    assert [frame.seq for frame in frames] == accepted
    cell = YARD["cell"]
    drawn = 0
    for frame in frames:
        assert frame.kind in (GLB, GLB_WHOLE)
        for placed in GlbFile(frame.payload).placed():
            drawn += 1
            for axis in range(3):
                low, high = frame.min[axis] * cell[axis], frame.max[axis] * cell[axis]
                assert low - 1e-4 <= placed.position[axis] <= high + 1e-4
    assert drawn > 0


def test_glb_frames_of_a_region_show_what_label_frames_say(server):
    job = submit(server, SMALL_JOB)
    by_labels = frames_of(watch(server, job, partial="labels"))
    by_glb = frames_of(watch(server, job, partial="glb"))
    assert len(by_labels) == len(by_glb) > 5
    for labels, glb in zip(by_labels, by_glb):
        assert (labels.seq, labels.min, labels.max) == (glb.seq, glb.min, glb.max)
        drawn = sum(1 for label in labels.labels() if label != YARD["pieces"].index(
            {"name": "air"}))
        assert len(GlbFile(glb.payload).placed()) == drawn


# --- who comes late


def test_who_joins_in_the_middle_can_build_the_finished_model(server):
    job = submit(server, SWEEP_JOB)
    with EventReader(server.port, job["id"]) as reader:
        reader.until_event(lambda event: event["seq"] == 600)
    messages = watch(server, job, partial="labels")
    check_order(messages)
    assert replayed(messages, SWEEP_JOB["size"]) == labels_of(server, job)


def test_who_comes_after_the_end_can_build_the_finished_model(server):
    job = server.wait(submit(server, SWEEP_JOB)["id"])
    messages = watch(server, job, partial="labels")
    check_order(messages)
    assert messages[-2]["type"] == "succeeded"
    assert replayed(messages, SWEEP_JOB["size"]) == labels_of(server, job)


def test_who_reconnects_several_times_goes_on_from_the_state_so_far(server):
    job = submit(server, SWEEP_JOB)
    grid, seq, ended = LabelGrid(SWEEP_JOB["size"]), 0, False
    while not ended:
        with connect(server, job, partial="labels", after=seq) as client:
            for _ in range(501):
                frame = client.message()
                if frame.opcode == BINARY:
                    grid.apply(StateFrame(frame.payload))
                elif frame.opcode == TEXT:
                    event = json.loads(frame.payload)
                    assert event["seq"] == seq + 1
                    # Only now is the block before it known to be whole.
                    seq = event["seq"]
                    ended = event["type"] == "succeeded"
                else:
                    break
            if not ended and frame.opcode == TEXT and event.get("outcome") == "accepted":
                grid.apply(StateFrame(client.message().payload))
    assert grid.cells == labels_of(server, job)


def test_after_a_restart_a_finished_job_has_one_whole_state_before_its_last_event(make_server):
    server = make_server()
    job = server.wait(submit(server, TILES_JOB)["id"])
    server.stop()
    server.start()
    for partial, kind in (("labels", LABELS_WHOLE), ("glb", GLB_WHOLE)):
        messages = watch(server, job, partial=partial)
        assert [frame.kind for frame in frames_of(messages)] == [kind]
        assert isinstance(messages[-3], bytes) and messages[-2]["type"] == "succeeded"
        check_order(messages)
        assert messages[-1].close_code == 1000
        if kind == LABELS_WHOLE:
            assert replayed(messages, TILES_JOB["size"]) == labels_of(server, job)
        else:
            GlbFile(frames_of(messages)[0].payload)


def test_who_joins_while_a_killed_job_is_solved_again_can_build_the_finished_model(make_server):
    server = make_server()
    job = submit(server, SWEEP_JOB)
    with EventReader(server.port, job["id"]) as reader:
        reader.until_event(lambda event: event.get("fraction", 0) > 0.6)
    server.kill()
    server.start()
    messages = watch(server, job, partial="labels")
    check_order(messages)
    assert messages[-2]["type"] == "succeeded"
    assert replayed(messages, SWEEP_JOB["size"]) == labels_of(server, job)


def test_who_joins_a_begun_job_that_waits_again_can_build_the_finished_model(make_server):
    server = make_server(workers=2)
    jobs = [submit(server, SWEEP_JOB, seed=seed) for seed in (1, 2)]
    readers = [EventReader(server.port, job["id"]) for job in jobs]
    for reader in readers:
        with reader:
            reader.until_event(lambda event: event.get("fraction", 0) > 0.3)
    server.kill()
    server.workers = 1  # now one of them has to wait for the other
    server.start()
    clients = [connect(server, job, partial="labels") for job in jobs]
    seen = [None, None]

    def run(index):
        seen[index] = clients[index].messages()

    threads = [threading.Thread(target=run, args=(index,)) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=90)
    for job, messages in zip(jobs, seen):
        assert messages[-2]["type"] == "succeeded"
        assert replayed(messages, SWEEP_JOB["size"]) == labels_of(server, job)


# --- several clients, lost clients, slow clients


def test_a_client_that_is_cut_off_does_not_disturb_another(server):
    job = submit(server, STEADY_JOB)
    with connect(server, job, partial="labels") as staying:
        leaving = [connect(server, job, partial=partial) for partial in ("none", "labels", "glb")]
        for client in leaving:
            client.message()
            client.abort()
        messages = staying.messages()
    check_order(messages)
    assert messages[-1].close_code == 1000
    assert replayed(messages, STEADY_JOB["size"]) == labels_of(server, job)


def test_two_clients_of_one_job_get_the_same_events_and_models(server):
    # Not the same frames: where the whole state that begins them stands depends on the moment.
    job = submit(server, SMALL_JOB)
    with connect(server, job, partial="labels") as first:
        with connect(server, job, partial="labels") as second:
            one, other = first.messages(), second.messages()
    assert events_of(one) == events_of(other)
    assert replayed(one, SMALL_JOB["size"]) == replayed(other, SMALL_JOB["size"])


def peak_resident_mib(server):
    with open(f"/proc/{server.process.pid}/status", encoding="ascii") as status:
        for line in status:
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024
    raise AssertionError("no VmHWM")


def test_a_client_that_stops_reading_still_gets_the_end_and_can_build_the_model(make_server):
    # About 20 MB of frames, more than the kernel's buffers hold for a reader with a small one. A
    # fifth of that is more, too, and a sanitizer takes minutes for a pass.
    size = (300, 6, 300)
    request = {"example": YARD, "parameters": {"weights": "uniform", "blocks": {
        "size": [30, 6, 30], "passes": 1 if IS_SANITIZED else 5}}}

    # The job itself needs memory, most of all while the model is written; what the clients need
    # is what comes on top. A sanitizer holds back what was freed, so there the size of the process
    # says nothing.
    if not IS_SANITIZED:
        alone = make_server(name="alone")
        alone.wait(alone.submit(size, **request)["id"])
        peak_alone = peak_resident_mib(alone)

    # The clients read nothing for as long as the job takes, which may be minutes.
    server = make_server("--write-seconds", int(PATIENCE))
    job = server.submit(size, **request)
    clients = [connect(server, job, partial="labels", receive_buffer=16384) for _ in range(4)]
    for client in clients:
        client.message()
    assert server.wait(job["id"])["state"] == "succeeded"
    time.sleep(2.5)  # long enough to count as slow
    peak = peak_resident_mib(server)
    labels = labels_of(server, job)
    log = server.events(job["id"])
    for client in clients:
        with client:
            messages = client.messages()
        events = events_of(messages)
        assert check_order(messages, after=1) == len(log)
        assert events[-1] == log[-1]
        assert messages[-1].close_code == 1000
        # The events that did come are those of the log.
        for event in events:
            if event["type"] != "snapshot":
                assert event == log[event["seq"] - 1]
        assert replayed(messages, size) == labels
        assert len(events) < len(log) - 1, "the clients were never slow"
    # 4 clients that read everything from memory would need 80 MB.
    if not IS_SANITIZED:
        assert peak - peak_alone < 40, f"{peak_alone} MiB without clients, {peak} MiB with four"


@pytest.fixture(scope="module")
def lagged(server):
    """What a client gets who stops reading for some seconds while the job goes on: log and
    messages."""
    job = server.submit((300, 6, 300), example=YARD, parameters={
        "weights": "uniform",
        "blocks": {"size": [30, 6, 30], "passes": 2 if IS_SANITIZED else 8}})
    with connect(server, job, receive_buffer=4096, partial="labels") as client:
        client.message()
        wait_for(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["fraction"] > 0.5)
        time.sleep(2.5)  # long enough to count as slow
        messages = client.messages()
    log = server.events(job["id"])
    assert "snapshot" in [event["type"] for event in events_of(messages)], "it was never slow"
    return log, messages


def snapshots_of(lagged):
    return [event for event in events_of(lagged[1]) if event["type"] == "snapshot"]


def test_a_lagging_client_misses_nothing_it_is_not_told_of(lagged):
    log, messages = lagged
    assert check_order(messages, after=1) == len(log)
    assert messages[-2] == log[-1]


def test_a_snapshot_holds_the_whole_job(lagged):
    for snapshot in snapshots_of(lagged):
        assert {"id", "state", "solver", "seed", "created", "progress", "request", "result",
                "urls", "error"} <= snapshot["job"].keys()


def test_a_snapshot_is_as_documented(server, lagged):
    asyncapi = ApiDocument(server.get("/asyncapi.json").json())
    payload = asyncapi.at("channels", "jobStream", "messages", "snapshot")["payload"]
    for snapshot in snapshots_of(lagged):
        asyncapi.check(snapshot, payload)


def test_the_seq_of_a_snapshot_is_that_of_the_newest_event_it_includes(lagged):
    log, _ = lagged
    for snapshot in snapshots_of(lagged):
        blocks = [event for event in log[:snapshot["seq"]] if event["type"] == "block"]
        assert snapshot["job"]["progress"]["blocks_done"] == len(blocks)
        if snapshot["seq"] < len(log):
            assert snapshot["job"]["state"] == "running"


def test_the_time_of_a_snapshot_is_not_before_that_of_the_events_it_includes(lagged):
    log, _ = lagged
    for snapshot in snapshots_of(lagged):
        assert snapshot["time"] >= log[snapshot["seq"] - 1]["time"]


# --- stopping the server


def test_sigterm_closes_websockets_with_1001_and_the_server_exits_with_0(make_server):
    server = make_server(workers=1)
    running, waiting = submit(server, ENDLESS_JOB), submit(server, SMALL_JOB)
    clients = [connect(server, running), connect(server, running, partial="labels"),
               connect(server, running, partial="glb"), connect(server, waiting)]
    for client in clients:
        client.message()
    codes = [None] * len(clients)
    lasts = [None] * len(clients)

    def run(index):
        messages = clients[index].messages()
        codes[index] = messages[-1].close_code
        events = events_of(messages)
        lasts[index] = events[-1]["type"] if events else None

    threads = [threading.Thread(target=run, args=(index,)) for index in range(len(clients))]
    for thread in threads:
        thread.start()
    assert server.stop() == 0
    for thread in threads:
        thread.join(timeout=30)
    assert codes == [1001] * len(clients)
    assert not set(lasts) & {"succeeded", "failed", "cancelled"}


def test_sigterm_ends_the_server_though_a_client_does_not_read(make_server):
    server = make_server()
    job = submit(server, ENDLESS_JOB)
    with connect(server, job, partial="labels", receive_buffer=4096) as client:
        client.message()
        wait_for(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["blocks_done"] > 50)
        assert server.stop() == 0

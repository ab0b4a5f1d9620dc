"""GET /v1/stream: one WebSocket for many jobs."""

import json

import jsonschema
import pytest

from checks import wait_until
from conftest import ROOT
from websocket_client import (
    BINARY, CLOSE, PING, PONG, TEXT, HandshakeRefused, LabelGrid, NamedStateFrame,
    WebSocketClient)
from workload import ENDLESS_JOB, SMALL_JOB, STEADY_JOB, SWEEP_JOB, submit

SUBSCRIPTIONS_MAX = 64


def schema(name):
    path = ROOT / f"proto/schemas/{name}.json"
    document = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(document)
    neighbours = jsonschema.RefResolver(path.as_uri(), document)
    return jsonschema.Draft202012Validator(document, resolver=neighbours)


FROM_CLIENT, FROM_SERVER = schema("stream.client"), schema("stream.server")


class SharedStream(WebSocketClient):
    """A client of GET /v1/stream. The texts of the server are checked against the schema, of events
    the first of each type."""

    def __init__(self, server, **kwargs):
        super().__init__(server.port, "/v1/stream", **kwargs)
        self.count = 0
        self.checked = set()

    def ask(self, **fields):
        """Sends a request of a number of its own, which it gives."""
        self.count += 1
        self.send(TEXT, json.dumps({"id": self.count, **fields}).encode())
        return self.count

    def next(self):
        """The next message: a text as a dict, a binary one as a frame."""
        frame = self.message()
        if frame.opcode == BINARY:
            return NamedStateFrame(frame.payload)
        assert frame.opcode == TEXT, (frame.opcode, frame.payload)
        message = json.loads(frame.payload)
        if "time" not in message or message["type"] not in self.checked:
            FROM_SERVER.validate(message)
            self.checked.add(message["type"])
        return message

    def until(self, wanted):
        found = [self.next()]
        while not wanted(found[-1]):
            found.append(self.next())
        return found

    def until_answer(self, number):
        return self.until(lambda message: isinstance(message, dict) and message.get("id") == number)

    def until_ends(self, count):
        """Everything up to the end of so many subscriptions."""
        ends = []
        return self.until(lambda message: is_end(message) and
                          (ends.append(message) or len(ends) == count))

    def answer(self, **fields):
        """Asks and gives the answer, which must be the next message."""
        number = self.ask(**fields)
        message = self.next()
        assert message["id"] == number, message
        return message


def is_end(message):
    return isinstance(message, dict) and message["type"] == "end"


def of_job(messages, job):
    return [message for message in messages if
            (message.get("job_id") if isinstance(message, dict) else message.job_id) == job["id"]]


def events_of(messages, job):
    """The job's events, without what this carrier adds."""
    return [{name: value for name, value in message.items() if name != "job_id"}
            for message in of_job(messages, job) if isinstance(message, dict) and
            message["type"] not in ("answer", "end")]


def faults(message):
    return [error["pointer"] for error in message["error"].get("errors", [])]


@pytest.fixture(scope="module")
def finished(server):
    job = server.wait(submit(server, SMALL_JOB)["id"])
    return job, server.events(job["id"])


@pytest.fixture
def client(server):
    with SharedStream(server) as client:
        yield client


# --- handshake


@pytest.mark.parametrize("protocol", [None, "modelsynth.v2"])
def test_without_the_subprotocol_the_handshake_is_refused(server, protocol):
    with pytest.raises(HandshakeRefused) as refused:
        SharedStream(server, protocol=protocol)
    assert refused.value.status == 400


def test_the_subprotocol_is_echoed(client):
    assert client.headers["sec-websocket-protocol"] == "modelsynth.v1"


def test_a_query_or_no_upgrade_is_refused(server):
    with pytest.raises(HandshakeRefused) as refused:
        WebSocketClient(server.port, "/v1/stream?after=1")
    assert refused.value.status == 400
    assert server.get("/v1/stream").status == 426
    assert server.request("POST", "/v1/stream").status == 405


# --- subscriptions


def test_a_subscription_gives_the_events_of_the_log_and_says_when_it_ends(client, finished):
    job, events = finished
    messages = [client.answer(type="subscribe", job=job["id"])] + client.until(is_end)
    assert messages[0] == {"type": "answer", "id": 1, "request": "subscribe", "job_id": job["id"],
                           "after": 0, "head": len(events)}
    assert events_of(messages, job) == events
    assert messages[-1] == {"type": "end", "job_id": job["id"], "reason": "ended",
                            "seq": len(events)}
    client.send(PING, b"still open")
    assert client.receive().opcode == PONG


def test_reading_after_k_gives_exactly_the_tail_for_every_k(client, finished):
    job, events = finished
    for after in range(len(events) + 1):
        answer = client.answer(type="subscribe", job=job["id"], after=after)
        assert answer["after"] == after
        assert events_of(client.until(is_end), job) == events[after:], after


def test_several_jobs_share_the_connection_each_in_the_order_of_its_log(server, client):
    jobs = [submit(server, SMALL_JOB, seed=seed) for seed in range(5)]
    numbers = [client.ask(type="subscribe", job=job["id"]) for job in jobs]
    messages = client.until_ends(len(jobs))
    assert [message["id"] for message in messages if
            isinstance(message, dict) and message["type"] == "answer"] == numbers
    for job in jobs:
        mine = of_job(messages, job)
        assert mine[0]["type"] == "answer" and is_end(mine[-1])
        assert events_of(messages, job) == server.events(job["id"])


def test_a_busy_job_does_not_starve_another(server, client):
    """With thousands of events of one job to be sent, another one gets its turns in between."""
    long = server.wait(submit(server, STEADY_JOB)["id"])
    short = server.wait(submit(server, SMALL_JOB)["id"])
    client.ask(type="subscribe", job=long["id"])
    client.until_answer(client.ask(type="subscribe", job=short["id"]))
    messages = client.until(is_end)
    assert messages[-1]["job_id"] == short["id"]
    assert 0 < len(events_of(messages, long)) < 3 * len(events_of(messages, short))


def test_nothing_comes_after_unsubscribing_was_answered(server, client):
    job, other = submit(server, ENDLESS_JOB), submit(server, ENDLESS_JOB)
    for each in (job, other):
        client.ask(type="subscribe", job=each["id"], partial="labels")
    client.until(lambda message: isinstance(message, NamedStateFrame) and
                 message.job_id == job["id"])
    messages = client.until_answer(client.ask(type="unsubscribe", job=job["id"]))
    events = events_of(messages, job)
    if events:
        assert messages[-1]["seq"] == events[-1]["seq"]
    later = []
    while len(events_of(later, other)) < 100:
        later.append(client.next())
    assert of_job(later, job) == []
    # The place that the answer told is where to go on.
    again = client.ask(type="subscribe", job=job["id"], after=messages[-1]["seq"])
    later = client.until(lambda message: isinstance(message, dict) and "seq" in message and
                         message["job_id"] == job["id"] and message["type"] != "answer")
    assert later[-1]["seq"] == messages[-1]["seq"] + 1
    assert again in [message.get("id") for message in later if isinstance(message, dict)]
    for each in (job, other):
        server.request("DELETE", f"/v1/jobs/{each['id']}")


def test_frames_say_which_job_they_belong_to_and_give_its_model(server, client):
    jobs = [submit(server, SMALL_JOB, seed=seed) for seed in (11, 12)]
    sse_only = submit(server, SMALL_JOB, seed=13)
    for job in jobs:
        client.ask(type="subscribe", job=job["id"], partial="labels")
    client.ask(type="subscribe", job=sse_only["id"])
    messages = client.until_ends(3)
    for job in jobs:
        grid, previous = LabelGrid(SMALL_JOB["size"]), None
        for message in of_job(messages, job):
            if isinstance(message, NamedStateFrame):
                assert message.is_whole or message.seq == previous["seq"]
                grid.apply(message)
            else:
                previous = message
        labels = server.get(f"/v1/jobs/{job['id']}/labels.json").json()["cells"]
        assert grid.cells == labels
    assert not [message for message in of_job(messages, sse_only)
                if isinstance(message, NamedStateFrame)]


def test_a_deleted_job_ends_its_subscription_alone(server, client):
    job, other = submit(server, ENDLESS_JOB), submit(server, ENDLESS_JOB)
    for each in (job, other):
        client.ask(type="subscribe", job=each["id"])
    client.until(lambda message: message["type"] == "block" and message["job_id"] == job["id"])
    assert server.request("DELETE", f"/v1/jobs/{job['id']}").status == 204
    messages = client.until(is_end)
    assert messages[-1]["job_id"] == job["id"] and messages[-1]["reason"] == "deleted"
    client.until(lambda message: message["type"] == "block" and message["job_id"] == other["id"])
    server.request("DELETE", f"/v1/jobs/{other['id']}")


def test_cancelling_is_answered_and_seen(server, client):
    job = submit(server, ENDLESS_JOB)
    client.ask(type="subscribe", job=job["id"])
    client.until(lambda message: message["type"] == "block")
    number = client.ask(type="cancel", job=job["id"])
    messages = client.until(is_end)
    answer = next(message for message in messages if message.get("id") == number)
    assert answer["request"] == "cancel" and answer["state"] in ("running", "cancelled")
    assert events_of(messages, job)[-1]["type"] == "cancelled"
    again = client.answer(type="cancel", job=job["id"])
    assert again["state"] == "cancelled"


def test_cancelling_does_not_wait_for_a_client_that_does_not_read(server):
    job = submit(server, ENDLESS_JOB)
    with SharedStream(server, receive_buffer=4096) as client:
        client.ask(type="subscribe", job=job["id"], partial="labels")
        wait_until(lambda: server.get(f"/v1/jobs/{job['id']}").json()["progress"]["blocks_done"]
                   > 100)
        client.ask(type="cancel", job=job["id"])
        assert server.wait(job["id"])["state"] == "cancelled"


# --- refusals


def test_what_is_wrong_is_told_and_nothing_else_happens(client, finished):
    job, events = finished
    good = {"type": "subscribe", "job": job["id"]}
    for fields, places in [
            ({"type": "subscribe"}, ["/job"]), ({"job": job["id"]}, ["/type"]),
            ({**good, "type": "watch"}, ["/type"]), ({**good, "job": 7}, ["/job"]),
            ({**good, "job": ""}, ["/job"]), ({**good, "job": "j" * 129}, ["/job"]),
            ({**good, "after": "1"}, ["/after"]), ({**good, "after": -1}, ["/after"]),
            ({**good, "after": 1.5}, ["/after"]), ({**good, "partial": "all"}, ["/partial"]),
            ({**good, "a~b/c": 1}, ["/a~0b~1c"]),
            ({**good, "type": "unsubscribe", "after": 1}, ["/after"]),
            ({**good, "type": "cancel", "partial": "none"}, ["/partial"])]:
        assert not FROM_CLIENT.is_valid({"id": 1, **fields})
        message = client.answer(**fields)
        assert message["type"] == "refusal" and message["error"]["status"] == 422, fields
        assert faults(message) == places, fields
    # What only the server can know.
    too_far = {**good, "after": len(events) + 1}
    for fields, place in [(too_far, "/after"), ({**good, "type": "unsubscribe"}, "/job")]:
        message = client.answer(**fields)
        assert (message["error"]["status"], faults(message)) == (422, [place])
    for kind in ("subscribe", "cancel"):
        message = client.answer(type=kind, job="nobody")
        assert message["error"]["type"] == "/problems/not-found"
    assert client.answer(**good)["type"] == "answer"
    assert events_of(client.until(is_end), job) == events


@pytest.mark.parametrize("good", ["a", "i" * 64, "ä\"\\", 0, 2**53 - 1])
def test_the_answer_carries_the_clients_id(client, good):
    assert FROM_CLIENT.is_valid({"id": good, "type": "cancel", "job": "nobody"})
    client.send(TEXT, json.dumps({"id": good, "type": "cancel", "job": "nobody"}).encode())
    message = client.next()
    assert message["id"] == good and message["error"]["status"] == 404


@pytest.mark.parametrize("bad", ["", "i" * 65, -1, 2**53, 1.5, None, True, ["a"], {}])
def test_an_id_that_is_none_is_refused_with_null(client, bad):
    assert not FROM_CLIENT.is_valid({"id": bad, "type": "cancel", "job": "nobody"})
    client.send(TEXT, json.dumps({"id": bad, "type": "cancel", "job": "nobody"}).encode())
    message = client.next()
    assert message["id"] is None and faults(message) == ["/id"]


@pytest.mark.parametrize("text", [
    b"", b"{", b"hello", b'{"id": 1,}', b"[1, 2", b"\0", b"{} {}"])
def test_what_is_no_json_is_refused_with_the_place(client, text):
    client.send(TEXT, text)
    message = client.next()
    assert message["type"] == "refusal" and message["id"] is None
    assert message["error"]["type"] == "/problems/malformed-json"
    assert "byte" in message["error"]["detail"]
    client.send(PING, b"still open")
    assert client.receive().opcode == PONG


@pytest.mark.parametrize("text", [b'{"id": 1, "id": 2}', b"[" * 2000 + b"]" * 2000],
                         ids=["a key twice", "too deep"])
def test_what_is_no_plain_json_is_refused(client, text):
    client.send(TEXT, text)
    message = client.next()
    assert (message["id"], message["error"]["status"]) == (None, 400)


def test_labels_of_a_model_without_cells_are_refused(server, client):
    job = server.submit((8, 8, 8), example="houses", solver="continuous")
    message = client.answer(type="subscribe", job=job["id"], partial="labels")
    assert message["error"]["status"] == 422 and faults(message) == ["/partial"]
    server.request("DELETE", f"/v1/jobs/{job['id']}")


def test_subscribing_twice_is_refused(server, client):
    job = submit(server, ENDLESS_JOB)
    client.ask(type="subscribe", job=job["id"])
    message = client.until_answer(client.ask(type="subscribe", job=job["id"]))[-1]
    assert message["type"] == "refusal" and faults(message) == ["/job"]
    server.request("DELETE", f"/v1/jobs/{job['id']}")


def test_one_subscription_too_many_is_refused_with_the_limit(make_server):
    server = make_server(workers=1)
    submit(server, ENDLESS_JOB)  # the others wait
    jobs = [submit(server, SMALL_JOB) for _ in range(SUBSCRIPTIONS_MAX + 1)]
    with SharedStream(server) as client:
        for job in jobs[:-1]:
            answer = client.until_answer(client.ask(type="subscribe", job=job["id"]))[-1]
            assert answer["type"] == "answer"
        more = {"type": "subscribe", "job": jobs[-1]["id"]}
        message = client.until_answer(client.ask(**more))[-1]
        assert message["error"]["type"] == "/problems/too-large"
        assert "stream_subscriptions_max" in message["error"]["detail"]
        client.until_answer(client.ask(type="unsubscribe", job=jobs[3]["id"]))
        assert client.until_answer(client.ask(**more))[-1]["type"] == "answer"


# --- the connection


@pytest.mark.parametrize(("send", "code"), [
    (lambda client: client.send(BINARY, b"{}"), 1003),
    (lambda client: client.send(TEXT, b"\xff"), 1007),
    (lambda client: client.send(TEXT, b"x" * 4097), 1009),
    (lambda client: client.send(TEXT, b"{}", masked=False), 1002)],
    ids=["binary", "no UTF-8", "4097 bytes", "unmasked"])
def test_what_breaks_the_rules_closes_the_connection(client, send, code):
    send(client)
    assert client.close_code() == code
    assert client.ended()


def test_a_message_of_4_kib_is_read(client):
    client.send(TEXT, b'{"id": 1}' + b" " * 4087)
    assert client.next()["type"] == "refusal"


def test_requests_that_are_not_waited_for_are_all_answered_in_order(client, finished):
    numbers = [client.ask(type="unsubscribe", job=finished[0]["id"]) for _ in range(500)]
    assert [client.next()["id"] for _ in numbers] == numbers


def test_requests_without_end_are_no_more_read_than_answered(server):
    """A client that sends and does not read is held up by its own answers."""
    with SharedStream(server, receive_buffer=4096, timeout=1) as client:
        text = json.dumps({"id": "x" * 64, "type": "watch", "job": "j" * 100}).encode()
        with pytest.raises(TimeoutError):
            for _ in range(200_000):
                client.send(TEXT, text)
    assert server.get("/healthz").status == 200


def test_sigterm_closes_with_1001(make_server):
    server = make_server(workers=1)
    job = submit(server, ENDLESS_JOB)
    with SharedStream(server) as client:
        client.ask(type="subscribe", job=job["id"])
        client.until(lambda message: message["type"] == "block")
        server.process.terminate()
        while (frame := client.message()).opcode != CLOSE:
            assert json.loads(frame.payload)["type"] in ("block", "answer")
        assert frame.close_code == 1001
        client.answer_close(frame)
        client.abort()
        assert server.process.wait(timeout=30) == 0


def test_a_client_that_leaves_ends_no_job(server):
    job = submit(server, SWEEP_JOB)
    with SharedStream(server) as client:
        client.ask(type="subscribe", job=job["id"], partial="labels")
        client.until(lambda message: isinstance(message, NamedStateFrame))
    assert server.wait(job["id"])["state"] == "succeeded"

"""The client's reader of events against a server that breaks off, repeats itself and lies."""

import http.server
import json
import threading

import pytest

from test_cli import cli, fail


def event(seq, kind, **fields):
    data = json.dumps({"seq": seq, "type": kind, "time": "2026-01-01T00:00:00Z", **fields})
    return f"id: {seq}\nevent: {kind}\ndata: {data}\n\n".encode()


EVENTS = [event(1, "queued", position=0), event(2, "started", blocks_total=2)]
EVENTS += [
    event(seq, "block", index=seq - 3, outcome="accepted", blocks_done=seq - 2, blocks_total=2)
    for seq in (3, 4)
]
EVENTS += [event(5, "succeeded", result={"stats": {"blocks_accepted": 2, "blocks_reverted": 0}})]
WHOLE = b"".join(EVENTS)


class Script:
    """What the fake server answers, one entry for each reading of the events."""

    def __init__(self, answers, state="running"):
        self.answers = list(answers)
        self.state = state
        self.asked = []  # (Last-Event-ID, query) of each reading
        self.asked_job = 0


@pytest.fixture
def serve():
    servers = []

    def start(script):
        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                path, _, query = self.path.partition("?")
                if not path.endswith("/events"):
                    script.asked_job += 1
                    self.answer(200, json.dumps({"id": "j", "state": script.state}).encode())
                    return
                script.asked.append((self.headers.get("Last-Event-ID"), query))
                status, body, is_whole = script.answers.pop(0)
                self.answer(status, body, is_whole)

            def answer(self, status, body, is_whole=True):
                self.send_response(status)
                self.send_header("Content-Type", "text/event-stream")
                self.send_header("Content-Length", str(len(body) + (0 if is_whole else 1000)))
                self.send_header("Connection", "close")
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        servers.append(server)
        return f"http://127.0.0.1:{server.server_address[1]}"

    yield start
    for server in servers:
        server.shutdown()
        server.server_close()


def follow(script, serve, *arguments):
    done = cli("follow", "j", "--json", *arguments, server=serve(script))
    return done.returncode, [json.loads(line)["seq"] for line in done.stdout.splitlines()]


def test_a_broken_stream_is_taken_up_where_it_broke(serve):
    cut = len(EVENTS[0]) + len(EVENTS[1]) + 20  # within the third event
    script = Script([(200, WHOLE[:cut], False), (200, b"".join(EVENTS[2:]), True)])
    assert follow(script, serve) == (0, [1, 2, 3, 4, 5])
    assert script.asked == [(None, "after=0"), ("2", "after=2")]


def test_events_that_come_twice_are_shown_once(serve):
    script = Script([(200, b"".join(EVENTS[:3]), True), (200, WHOLE, True)])
    assert follow(script, serve) == (0, [1, 2, 3, 4, 5])


def test_a_gap_is_read_again(serve):
    script = Script([(200, EVENTS[0] + EVENTS[2], True), (200, b"".join(EVENTS[1:]), True)])
    assert follow(script, serve) == (0, [1, 2, 3, 4, 5])
    assert script.asked[1] == ("1", "after=1")


def test_a_snapshot_stands_for_the_events_it_includes(serve):
    snapshot = event(4, "snapshot", job={"progress": {"blocks_done": 2, "blocks_total": 2}})
    assert follow(Script([(200, EVENTS[0] + snapshot + EVENTS[4], True)]), serve) == (0, [1, 4, 5])


def test_an_unwell_server_is_asked_again(serve):
    script = Script([(503, b"", True), (200, b"garbage\n\n", True), (200, WHOLE, True)])
    assert follow(script, serve) == (0, [1, 2, 3, 4, 5])


def test_a_problem_is_not_asked_for_again(serve):
    script = Script([(404, b'{"type":"/problems/not-found","title":"no","status":404}', True)])
    assert follow(script, serve) == (1, [])
    assert len(script.asked) == 1


def test_a_stream_without_news_of_an_ended_job_tells_its_outcome(serve):
    for state, code in (("succeeded", 0), ("failed", 1), ("cancelled", 1)):
        script = Script([(200, b"", True)] * 2, state)
        assert follow(script, serve, "--after", 5) == (code, [])
        assert script.asked == [(None, "after=5")] * 2


def test_events_of_a_job_that_ended_meanwhile_are_not_lost(serve):
    script = Script([(200, b"", True), (200, WHOLE, True)], "succeeded")
    assert follow(script, serve) == (0, [1, 2, 3, 4, 5])
    assert script.asked_job == 1


def test_the_tries_are_bounded(serve):
    script = Script([(200, EVENTS[0], False)] + [(503, b"", True)] * 20)
    assert "503" in fail(1, "follow", "j", server=serve(script), timeout=60)
    assert 5 <= len(script.asked) <= 12


def test_a_job_can_fail_and_say_why(serve):
    error = {"type": "/problems/contradiction", "title": "No", "status": 422, "detail": "a\x1b[2Jb"}
    script = Script([(200, EVENTS[0] + event(2, "failed", error=error), True)])
    errors = cli("follow", "j", server=serve(script))
    assert errors.returncode == 1
    assert errors.stderr.splitlines()[-1] == b"modelsynth: No: a [2Jb"

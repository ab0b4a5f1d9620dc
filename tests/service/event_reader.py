"""Reads a job's Server-Sent Events one at a time off a raw socket, so that a test can act between
two of them and knows how the stream ended."""

import json
import os
import socket
import time

# Seconds that anything may take; a sanitizer makes some of it ten times slower.
PATIENCE = 300 if "MODELSYNTH_SANITIZED" in os.environ else 60


class StreamBroken(Exception):
    """The stream ended in the middle: no last chunk."""


class Event(dict):
    """The data of an event; `text` is as it came."""

    def __init__(self, text):
        super().__init__(json.loads(text))
        self.text = text


class EventReader:
    """One GET of a job's events, or with a `submission` the POST of a job that is answered with
    them. The fields `id` and `event` are checked against the data. `receive_buffer` makes it a slow
    reader's."""

    def __init__(self, port, job_id, query="", headers=None, version="1.1", timeout=PATIENCE,
                 receive_buffer=None, submission=None):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(timeout)
        self.socket.connect(("127.0.0.1", port))
        self.until = time.monotonic() + timeout
        self.raw = b""
        self.text = b""
        self.ended = False
        fields = {"Host": "127.0.0.1", **(headers or {})}
        line, body = f"GET /v1/jobs/{job_id}/events{query}", b""
        if submission is not None:
            line, body = "POST /v1/jobs", json.dumps(submission).encode()
            fields = {"Accept": "text/event-stream", "Content-Type": "application/json",
                      "Content-Length": len(body), **fields}
        head = "".join(f"{name}: {value}\r\n" for name, value in fields.items())
        self.socket.sendall(f"{line} HTTP/{version}\r\n{head}\r\n".encode() + body)
        lines = self._line(b"\r\n\r\n").decode("latin-1").split("\r\n")
        self.status = int(lines[0].split(" ")[1])
        self.headers = {}
        for line in lines[1:]:
            name, value = line.split(":", 1)
            self.headers[name.strip().lower()] = value.strip()
        self.chunked = self.headers.get("transfer-encoding") == "chunked"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.socket.close()

    def _fill(self):
        left = self.until - time.monotonic()
        if left <= 0:
            raise TimeoutError("no event came in time")
        self.socket.settimeout(left)
        try:
            more = self.socket.recv(1 << 16)
        except ConnectionError:
            more = b""
        self.raw += more
        return len(more) > 0

    def _line(self, end=b"\r\n"):
        while end not in self.raw:
            if not self._fill():
                raise StreamBroken("the stream ended in the middle of a line")
        line, self.raw = self.raw.split(end, 1)
        return line

    def _more_text(self):
        """Takes in the next chunk; sets `ended` after the last."""
        if not self.chunked:
            self.ended = not self._fill()
            self.text, self.raw = self.text + self.raw, b""
            return
        size = int(self._line(), 16)
        while len(self.raw) < size + 2:
            if not self._fill():
                raise StreamBroken("the stream ended in the middle of a chunk")
        assert self.raw[size:size + 2] == b"\r\n"
        self.text += self.raw[:size]
        self.raw = self.raw[size + 2:]
        self.ended = size == 0

    def next(self):
        """The next event, or None at the end of the stream."""
        while True:
            while b"\n\n" not in self.text:
                if self.ended:
                    assert self.text == b"", "the stream ended in the middle of an event"
                    return None
                self._more_text()
            block, self.text = self.text.split(b"\n\n", 1)
            lines = [line for line in block.decode().split("\n") if not line.startswith(":")]
            names = [line.split(": ", 1)[0] for line in lines]
            if "data" not in names:
                continue
            assert names == ["id", "event", "data"], names
            identifier, kind, text = (line.split(": ", 1)[1] for line in lines)
            event = Event(text)
            assert identifier == str(event["seq"])
            assert kind == event["type"]
            return event

    def until_event(self, wanted):
        """Events up to the first one that `wanted` holds for."""
        found = []
        while not found or not wanted(found[-1]):
            event = self.next()
            assert event is not None, f"the stream ended after {found[-1:]}"
            found.append(event)
        return found

    def rest(self):
        """All events up to the end of the stream, which must be a proper one."""
        return list(iter(self.next, None))

    def rest_before_crash(self):
        """All events that can be had of a stream whose server was killed."""
        found = []
        try:
            while (event := self.next()) is not None:
                found.append(event)
        except StreamBroken:
            pass
        return found


def texts(events):
    return [event.text for event in events]

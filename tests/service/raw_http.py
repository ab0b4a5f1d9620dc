"""HTTP by hand: sends any bytes, reads answers strictly."""

import re
import socket


class WireAnswer:
    def __init__(self, version, status, headers, body):
        self.version = version
        self.status = status
        self.headers = headers
        self.body = body

    def __repr__(self):
        return f"{self.status} {self.body[:300]}"


class Wire:
    """A connection that sends what it is told and reads answers strictly."""

    def __init__(self, server, timeout=10):
        self.socket = socket.create_connection(("127.0.0.1", server.port), timeout=timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.buffer = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        """Sends what can be sent; a server that closes meanwhile is no fault."""
        try:
            self.socket.sendall(data)
        except (BrokenPipeError, ConnectionResetError):
            pass
        return self

    def _more(self):
        try:
            data = self.socket.recv(65536)
        except ConnectionResetError:
            data = b""
        self.buffer += data
        return bool(data)

    def _until(self, mark):
        while mark not in self.buffer:
            if not self._more():
                return None
        head, self.buffer = self.buffer.split(mark, 1)
        return head

    def _take(self, size):
        while len(self.buffer) < size:
            assert self._more(), f"closed after {self.buffer[:200]!r}, {size} bytes were promised"
        data, self.buffer = self.buffer[:size], self.buffer[size:]
        return data

    def answer(self, head_only=False):
        """The next answer, or None when the server closes instead."""
        head = self._until(b"\r\n\r\n")
        if head is None:
            assert self.buffer == b"", f"half an answer: {self.buffer[:200]!r}"
            return None
        lines = head.decode("ascii").split("\r\n")
        match = re.fullmatch(r"HTTP/(1\.[01]) ([1-5]\d\d) ?(.*)", lines[0])
        assert match, lines[0]
        headers = {}
        for line in lines[1:]:
            name, value = line.split(":", 1)
            assert re.fullmatch(r"[A-Za-z0-9-]+", name), line
            assert name.lower() not in headers, f"{name} twice"
            headers[name.lower()] = value.strip()
        status = int(match[2])
        body = b""
        if status >= 200 and status not in (204, 304) and not head_only:
            assert "transfer-encoding" not in headers
            body = self._take(int(headers["content-length"]))
        return WireAnswer(match[1], status, headers, body)

    def answers(self):
        """All answers until the server closes."""
        found = []
        while (answer := self.answer()) is not None:
            found.append(answer)
        return found

    def is_closed(self):
        """Whether the server ends the connection without another word."""
        return self.answer() is None

    def finish(self):
        try:
            self.socket.shutdown(socket.SHUT_WR)
        except OSError:
            pass
        return self

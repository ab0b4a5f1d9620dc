"""A small WebSocket client for tests: one frame at a time, and able to send what it must not.

Nothing is hidden: pings are answered only when asked to, bad frames go out as they are, and a
test says itself when it reads.
"""

import base64
import json
import os
import socket
import struct
import time

CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10


class HandshakeRefused(Exception):
    """The answer to the handshake was not 101."""

    def __init__(self, status, headers, body):
        super().__init__(f"{status}: {body[:200]!r}")
        self.status = status
        self.headers = headers
        self.body = body


class ConnectionLost(Exception):
    """The stream ended without a close frame."""


class Frame:
    """One frame off the wire."""

    def __init__(self, opcode, payload, fin=True):
        self.opcode = opcode
        self.payload = payload
        self.fin = fin

    @property
    def close_code(self):
        return struct.unpack(">H", self.payload[:2])[0] if len(self.payload) >= 2 else None


class WebSocketClient:
    """A connection that shook hands. `receive_buffer` makes it a slow reader's; `tls` is the
    SSLContext of one that is encrypted."""

    def __init__(self, port, path, protocol="modelsynth.v1", headers=None, timeout=30,
                 receive_buffer=None, tls=None):
        self.timeout = timeout
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.settimeout(timeout)
        self.buffer = b""
        try:
            self.socket.connect(("127.0.0.1", port))
            if tls:
                self.socket = tls.wrap_socket(self.socket, server_hostname="127.0.0.1")
            self._shake_hands(path, protocol, headers or {})
        except BaseException:
            self.socket.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.abort()

    def _shake_hands(self, path, protocol, headers):
        fields = {"Host": "127.0.0.1", "Upgrade": "websocket", "Connection": "Upgrade",
                  "Sec-WebSocket-Version": "13",
                  "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode()}
        if protocol is not None:
            fields["Sec-WebSocket-Protocol"] = protocol
        fields.update(headers)
        head = "".join(f"{name}: {value}\r\n" for name, value in fields.items()
                       if value is not None)
        self.socket.sendall(f"GET {path} HTTP/1.1\r\n{head}\r\n".encode())
        while b"\r\n\r\n" not in self.buffer:
            self._fill(time.monotonic() + self.timeout)
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        lines = head.decode("latin-1").split("\r\n")
        self.status = int(lines[0].split(" ")[1])
        self.headers = {}
        for line in lines[1:]:
            name, value = line.split(":", 1)
            self.headers[name.strip().lower()] = value.strip()
        if self.status != 101:
            body = self._read(int(self.headers.get("content-length", 0)),
                              time.monotonic() + self.timeout)
            raise HandshakeRefused(self.status, self.headers, body)

    def _fill(self, until):
        left = until - time.monotonic()
        if left <= 0:
            raise TimeoutError("nothing came in time")
        self.socket.settimeout(left)
        try:
            more = self.socket.recv(1 << 16)
        except ConnectionError as error:
            raise ConnectionLost(str(error)) from error
        if not more:
            raise ConnectionLost("the server closed the stream")
        self.buffer += more

    def _read(self, count, until):
        while len(self.buffer) < count:
            self._fill(until)
        data, self.buffer = self.buffer[:count], self.buffer[count:]
        return data

    # --- receiving

    def receive(self, timeout=None):
        """The next frame."""
        until = time.monotonic() + (timeout or self.timeout)
        first, second = self._read(2, until)
        assert first & 0x70 == 0, "the server set a reserved bit"
        assert second & 0x80 == 0, "the server masked a frame"
        length = second & 0x7F
        if length == 126:
            length = struct.unpack(">H", self._read(2, until))[0]
        elif length == 127:
            length = struct.unpack(">Q", self._read(8, until))[0]
        return Frame(first & 0x0F, self._read(length, until), bool(first & 0x80))

    def message(self, timeout=None):
        """The next message or control frame, as a frame; fragments are joined, pings answered."""
        parts = []
        while True:
            frame = self.receive(timeout)
            if frame.opcode == PING:
                self.send(PONG, frame.payload)
            elif frame.opcode >= 8:
                return frame
            else:
                parts.append(frame)
                if frame.fin:
                    return Frame(parts[0].opcode, b"".join(part.payload for part in parts))

    def messages(self, timeout=60):
        """All messages up to the close frame, which is the last and is answered: texts as dicts,
        binary ones as bytes."""
        until = time.monotonic() + timeout
        found = []
        while True:
            frame = self.message(max(0.1, until - time.monotonic()))
            if frame.opcode == TEXT:
                found.append(json.loads(frame.payload))
            elif frame.opcode == BINARY:
                found.append(frame.payload)
            elif frame.opcode == CLOSE:
                found.append(frame)
                self.answer_close(frame)
                return found

    def close_code(self, timeout=30):
        """Reads until the server ends the connection; the code of its close frame, or None when
        it ended the stream without one."""
        until = time.monotonic() + timeout
        try:
            while True:
                frame = self.receive(max(0.1, until - time.monotonic()))
                if frame.opcode == CLOSE:
                    self.answer_close(frame)
                    return frame.close_code
        except ConnectionLost:
            return None

    def answer_close(self, frame):
        try:
            self.send(CLOSE, frame.payload[:2])
        except OSError:
            pass

    def ended(self, timeout=15):
        """Whether the server ends the TCP stream in time."""
        until = time.monotonic() + timeout
        try:
            while True:
                self._fill(until)
        except ConnectionLost:
            return True
        except TimeoutError:
            return False

    # --- sending

    def send_raw(self, data):
        self.socket.settimeout(self.timeout)
        self.socket.sendall(data)

    def send(self, opcode, payload=b"", fin=True, reserved=0, masked=True, length=None):
        """One frame; `length` claims another length than the payload has."""
        size = len(payload) if length is None else length
        head = bytes([(0x80 if fin else 0) | reserved << 4 | opcode])
        mask_bit = 0x80 if masked else 0
        if size < 126:
            head += bytes([mask_bit | size])
        elif size < 1 << 16:
            head += bytes([mask_bit | 126]) + struct.pack(">H", size)
        else:
            head += bytes([mask_bit | 127]) + struct.pack(">Q", size)
        if masked:
            key = os.urandom(4)
            head += key
            payload = bytes(byte ^ key[i % 4] for i, byte in enumerate(payload))
        self.send_raw(head + payload)

    def close(self, code=1000, reason=b""):
        """A whole closing handshake; the code the server answers with."""
        self.send(CLOSE, struct.pack(">H", code) + reason)
        answer = self.close_code()
        self.abort()
        return answer

    def abort(self):
        """Ends the connection at once, with a reset when it is still open."""
        try:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        except OSError:
            pass
        self.socket.close()


# --- binary frames, as proto/frame.h lays them out

NO_LABEL = 65535
LABELS, LABELS_WHOLE, GLB, GLB_WHOLE = 1, 2, 3, 4


class StateFrame:
    """A binary frame of the subprotocol modelsynth.v1."""

    def __init__(self, data):
        magic, version, self.kind, zero, self.seq = struct.unpack_from("<4sBBHQ", data)
        box = struct.unpack_from("<6i", data, 16)
        (size,) = struct.unpack_from("<I", data, 40)
        assert magic == b"MSYF" and version == 1 and zero == 0
        assert self.kind in (LABELS, LABELS_WHOLE, GLB, GLB_WHOLE)
        assert len(data) == 44 + size, "the frame's length does not agree with its size"
        self.min, self.max = list(box[:3]), list(box[3:])
        self.payload = data[44:]

    @property
    def is_whole(self):
        return self.kind in (LABELS_WHOLE, GLB_WHOLE)

    def labels(self):
        return list(struct.unpack(f"<{len(self.payload) // 2}H", self.payload))


class NamedStateFrame(StateFrame):
    """A binary frame of the WebSocket for many jobs: layout version 2, with the job's id."""

    def __init__(self, data):
        assert data[4] == 2
        (length,) = struct.unpack_from("<H", data, 6)
        end = 44 + (length + 3) // 4 * 4
        self.job_id = data[44:44 + length].decode("ascii")
        assert data[44 + length:end] == b"\0" * (end - 44 - length)
        super().__init__(data[:4] + b"\1" + data[5:6] + b"\0\0" + data[8:44] + data[end:])


class LabelGrid:
    """The model as the frames tell it."""

    def __init__(self, size):
        self.size = list(size)
        self.cells = [NO_LABEL] * (size[0] * size[1] * size[2])

    def apply(self, frame):
        labels = frame.labels()
        if frame.is_whole:
            assert frame.min == [0, 0, 0] and frame.max == self.size
            assert len(labels) == len(self.cells)
            self.cells = labels
            return
        (x0, y0, z0), (x1, y1, z1) = frame.min, frame.max
        width = x1 - x0
        assert len(labels) == width * (y1 - y0) * (z1 - z0)
        given = 0
        for y in range(y0, y1):
            for z in range(z0, z1):
                at = x0 + self.size[0] * (z + self.size[2] * y)
                self.cells[at:at + width] = labels[given:given + width]
                given += width

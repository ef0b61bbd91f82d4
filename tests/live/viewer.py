"""A viewer of the Foxglove WebSocket protocol, as small as the tests need it."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from dataclasses import dataclass, field

from websockets.sync.client import ClientConnection, connect

SUBPROTOCOL = "foxglove.sdk.v1"
MESSAGE = 1
TIME = 2


@dataclass
class Viewer:
    """One connection: what was advertised, said and shown so far."""

    socket: ClientConnection
    info: dict = field(default_factory=dict)
    channels: dict[int, dict] = field(default_factory=dict)
    parameters: dict[str, object] = field(default_factory=dict)
    statuses: list[dict] = field(default_factory=list)
    messages: list[tuple[str, int, bytes]] = field(default_factory=list)
    times: list[int] = field(default_factory=list)

    @classmethod
    def open(cls, url: str) -> Viewer:
        """Connects."""
        # For as long as the test; the run ends the connection.
        return cls(connect(url, subprotocols=[SUBPROTOCOL], max_size=None).__enter__())

    def send(self, **message: object) -> None:
        """Sends a message of the protocol."""
        self.socket.send(json.dumps(message))

    def subscribe(self) -> None:
        """Subscribes to everything advertised, under the channels' own numbers."""
        pairs = [{"id": number, "channelId": number} for number in self.channels]
        self.send(op="subscribe", subscriptions=pairs)

    def take(self, timeout: float) -> bool:
        """Takes one message; false where none came in time."""
        try:
            data = self.socket.recv(timeout)
        except TimeoutError:
            return False
        if isinstance(data, bytes):
            self._binary(data)
        else:
            self._text(json.loads(data))
        return True

    def until(self, done: Callable[[Viewer], object], timeout: float = 20.0) -> None:
        """Takes messages until `done` holds."""
        while not done(self):
            assert self.take(timeout), f"nothing came for {timeout} s"

    def _binary(self, data: bytes) -> None:
        if data[0] == MESSAGE:
            number, stamp = struct.unpack_from("<IQ", data, 1)
            self.messages.append((self.channels[number]["topic"], stamp, data[13:]))
        elif data[0] == TIME:
            self.times.append(struct.unpack_from("<Q", data, 1)[0])

    def _text(self, message: dict) -> None:
        match message["op"]:
            case "serverInfo":
                self.info = message
            case "advertise":
                self.channels.update({channel["id"]: channel for channel in message["channels"]})
            case "parameterValues":
                self.parameters.update({p["name"]: p.get("value") for p in message["parameters"]})
            case "status":
                self.statuses.append(message)

"""Frames of websockets: of viser's connection, of the channel of pages, and of neither."""

from __future__ import annotations

import base64
import os
import socket
from random import Random
from typing import Any

import msgspec
import viser
import websockets.exceptions

from tests.attack import commands
from tests.attack.attack import Attack, Case, Outcome, Violation, mutated
from tests.attack.target import ANSWER_S, Target
from tests.attack.visitor import Visitor
from webviz.api.roles import Role
from webviz.server.access import rules
from webviz.server.access.rules import MESSAGES, SCENE
from webviz.server.channel.messages import CommandRequest

VISER = "viser.msgpack"
CHANNEL = "channel.json"
FRAMES = "frames.bin"
CAMERA = {
    "wxyz": [1, 0, 0, 0],
    "position": [1.0, 1.0, 1.0],
    "fov": 1.0,
    "near": 0.1,
    "far": 100.0,
    "image_height": 240,
    "image_width": 320,
    "look_at": [0, 0, 0],
    "up_direction": [0, 0, 1],
}
VALUES: tuple[Any, ...] = (
    None, True, 0, -1, 2**53, 2**64, 1e308, -1e308, "", "a", "x" * 40_000, "\x00", "\ud7ff\u202e",
    "../../etc/passwd", "<img src=x onerror=alert(1)>", [], {}, [[[[]]]], {"": {"": {}}},
    [0] * 1000,
)  # fmt: skip
WORDS = (
    "name", "display", "path", "value", "values", "type", "frame", "color", "hz", "view", "key",
    "text", "steps", "tool", "paused", "browser", "store", "displays", "group", "index", "kind",
)  # fmt: skip
FROM_PAGE = sorted(MESSAGES)
REQUIRED = {class_.__name__: role for class_, role in rules.commands().items()}

SILENT = ("DragHandle", "UseTool")
"""Commands of which only refusals and what tools say are answered."""
COMMANDS = sorted(REQUIRED.keys() - {"Dismiss"})
"""Messages of these that are drawn; an owner would end the other attackers."""


def kind_of(role: Role | None) -> str:
    """The kind of attacks by a role."""
    return f"ws {role.label if role else 'no token'}"


class Sockets(Attack):
    """Sends frames of every kind, as the pages of one role.

    Args:
        target: the viewer.
        role: of the pages; None without a token.
    """

    least = 20

    def __init__(self, target: Target, role: Role | None) -> None:
        self.kind = kind_of(role)
        self._target = target
        self._role = role
        self._visitor: Visitor | None = None

    def draw(self, random: Random) -> Case:
        match random.choice((VISER, CHANNEL, CHANNEL, FRAMES)):
            case "viser.msgpack":
                return Case(VISER, _viser(random))
            case "channel.json":
                return Case(CHANNEL, self._channel(random))
            case _:
                return Case(FRAMES, _frames(random))

    def strike(self, case: Case) -> Outcome:
        try:
            if case.name == FRAMES:
                return self._throw(case.data)
            if self._visitor is None:
                if self._role is None:
                    Visitor(self._target.port)
                    raise Violation("a page without a token was let in")
                self._visitor = self._target.visitor(self._role)
            if case.name == VISER:
                self._visitor.viser.send(case.data)
                return Outcome.SURVIVED
            return self._say(case.data.decode(errors="replace"))
        except (websockets.exceptions.WebSocketException, EOFError, ConnectionError):
            self.close()
            return Outcome.REFUSED
        except TimeoutError as error:
            self.close()
            raise Violation(f"no answer within {ANSWER_S:g} s") from error

    def close(self) -> None:
        if self._visitor is not None:
            self._visitor.close()
        self._visitor = None

    def _say(self, text: str) -> Outcome:
        assert self._visitor is not None
        self._visitor.say(text)
        try:
            request = msgspec.json.decode(text, type=CommandRequest)
            is_request = msgspec.json.decode(text, type=_Kind).type == "CommandRequest"
        except (msgspec.MsgspecError, RecursionError):
            return Outcome.SURVIVED
        if not is_request:
            return Outcome.SURVIVED
        required = REQUIRED.get(request.command)
        is_allowed = required is not None and self._role is not None and self._role >= required
        if is_allowed and request.command in SILENT:
            return Outcome.SURVIVED
        level, answer = self._visitor.answer(request.number, ANSWER_S)
        if level != "error" and not is_allowed:
            raise Violation(f"{request.command} was done for one who may not")
        if len(answer) > 1000:
            raise Violation(f"an answer of {len(answer)} characters")
        return Outcome.REFUSED if level == "error" else Outcome.DONE

    def _channel(self, random: Random) -> bytes:
        fields: dict[str, Any] = {}
        for _ in range(random.randrange(4)):
            fields[random.choice(WORDS)] = random.choice(VALUES)
        if random.random() < 0.3:
            message = {"type": random.choice(FROM_PAGE), **fields}
        else:
            command = random.choice(COMMANDS)
            arguments = {**commands.arguments(random, command)}
            if random.random() < 0.25:
                arguments |= fields
            number = random.randrange(2**40)
            message = {
                "type": "CommandRequest",
                "number": number,
                "command": command,
                "arguments": arguments,
            }
        text = msgspec.json.encode(message)
        return mutated(random, text) if random.random() < 0.15 else text

    def _throw(self, data: bytes) -> Outcome:
        with socket.create_connection(("127.0.0.1", self._target.port), timeout=ANSWER_S) as client:
            key = base64.b64encode(os.urandom(16)).decode()
            lines = [
                "GET / HTTP/1.1",
                "Host: localhost",
                "Upgrade: websocket",
                "Connection: Upgrade",
                f"Sec-WebSocket-Key: {key}",
                "Sec-WebSocket-Version: 13",
                f"Sec-WebSocket-Protocol: viser-v{viser.__version__}",
                *(f"{name}: {value}" for name, value in self._target.headers(self._role).items()),
            ]
            client.sendall("\r\n".join([*lines, "", ""]).encode() + data)
            client.shutdown(socket.SHUT_WR)
            while client.recv(1 << 16):
                pass
        return Outcome.REFUSED


class _Kind(msgspec.Struct):
    type: str


def _viser(random: Random) -> bytes:
    message: dict[str, Any] = {
        "type": random.choice((*SCENE, "ViewerCameraMessage", "ShareUrlRequest")),
        **CAMERA,
    }
    for _ in range(random.randrange(4)):
        message[random.choice((*CAMERA, "type", *WORDS))] = random.choice(
            (*VALUES[:5], *VALUES[6:], float("nan"), float("inf"))
        )
    try:
        data = msgspec.msgpack.encode(message)
    except OverflowError:
        data = b"\x81\xa4type\xcf" + b"\xff" * 8
    return mutated(random, data) if random.random() < 0.5 else data


def _frames(random: Random) -> bytes:
    """Frames with any opcode, reserved bits, fragments and lengths; most of them masked."""
    frames = b""
    for _ in range(random.randint(1, 20)):
        first = random.choice((0x00, 0x01, 0x02, 0x08, 0x09, 0x0A, 0x80, 0x81, 0x82, 0x88, 0x89))
        if random.random() < 0.2:
            first = random.randrange(256)
        size = random.choice((0, 1, 2, 125, 126, 200))
        payload = random.randbytes(size)
        claimed = random.choice((size, size, size, size, 126, 2**16, 2**31, 2**63 - 1, 2**64 - 1))
        mask = random.choice((0x80, 0x80, 0x80, 0x80, 0))
        frames += bytes([first])
        if claimed < 126:
            frames += bytes([mask | claimed])
        elif claimed < 2**16:
            frames += bytes([mask | 126]) + claimed.to_bytes(2, "big")
        else:
            frames += bytes([mask | 127]) + claimed.to_bytes(8, "big")
        frames += (bytes(4) if mask else b"") + payload
    return frames

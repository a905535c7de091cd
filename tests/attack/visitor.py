"""A program that talks to a viewer in another process as a page does."""

from __future__ import annotations

import contextlib
import queue
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import msgspec
import websockets.exceptions
from guest import Connections, Served


class Visitor(Connections):
    """Joins a viewer, and receives all that it draws.

    Args:
        port: of the viewer.
        headers: of its requests.
    """

    def __init__(self, port: int, **headers: str) -> None:
        super().__init__(Served(port), **headers)
        self._number = 0
        self._answers: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        for receive in (self._receive_scene, self._receive_answers):
            threading.Thread(target=receive, daemon=True).start()

    def _receive_scene(self) -> None:
        with contextlib.suppress(websockets.exceptions.ConnectionClosed):
            self.viser.drain(None)

    def _receive_answers(self) -> None:
        with contextlib.suppress(websockets.exceptions.ConnectionClosed):
            for text in self.websocket:
                message = msgspec.json.decode(text)
                if message["type"] == "CommandResult":
                    self._answers.put(message)
        self._answers.put(None)

    def say_endlessly(self, text: str, seconds: float) -> None:
        """Send a text again and again as one message that never ends, for some seconds at most.

        Raises:
            ConnectionClosed: the viewer refuses more of it, or the time is over.
        """

        def parts() -> Iterator[str]:
            while True:
                yield text

        # The viewer may as well read no more, so that sending waits.
        end = threading.Timer(seconds, lambda: self.websocket.socket.shutdown(socket.SHUT_RDWR))
        end.start()
        try:
            self.websocket.send(parts())
        finally:
            end.cancel()

    def do(self, command: str, seconds: float, **arguments: Any) -> tuple[str, str]:
        """The level and the text of the answer to a command.

        Raises:
            TimeoutError: there is none in time.
        """
        self._number += 1
        number = self._number
        self.send("CommandRequest", number=number, command=command, arguments=arguments)
        return self.answer(number, seconds)

    def answer(self, number: int, seconds: float) -> tuple[str, str]:
        """The level and the text of the answer to the command of a number.

        Raises:
            TimeoutError: there is none in time.
            ConnectionResetError: the viewer has ended the connection.
        """
        deadline = time.monotonic() + seconds
        while True:
            try:
                message = self._answers.get(timeout=max(0.0, deadline - time.monotonic()))
            except queue.Empty:
                raise TimeoutError from None
            if message is None:
                raise ConnectionResetError("the viewer has ended the connection")
            if message["number"] == number:
                return message["level"], message["text"]

    def close(self) -> None:
        """End the connections."""
        self.websocket.close()
        self.viser.close()

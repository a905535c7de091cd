"""Acknowledgements of browsers for what was sent to them."""

from __future__ import annotations

import threading
import time
import uuid

from viser import _messages as wire

from webviz.scene.deferred import DeferredMessages
from webviz.server.channel.messages import SyncReply, SyncRequest
from webviz.server.http.viser_server import Server


class AcknowledgementRequest(wire.RunJavascriptMessage, include_in_scene_serialization=True):
    """Makes a page answer once it has handled all messages queued before."""

    makes_whole = True
    """True if thinned clouds are sent whole before it."""

    def redundancy_key(self) -> str:
        """One per token, so that none replaces another."""
        return self.source

    def as_serializable_dict(self, binary_buffers: list[memoryview] | None = None) -> dict:
        """Return the message as viser packs it, under the name of viser's class."""
        return {"type": "RunJavascriptMessage", "source": self.source}


class Probe(AcknowledgementRequest, include_in_scene_serialization=True):
    """Makes a page say when it has painted all messages queued before."""

    makes_whole = False

    def redundancy_key(self) -> str:
        """One: a newer probe replaces those that were not sent."""
        return "webviz probe"


class Acknowledgements:
    """The answers of pages to markers.

    Args:
        server: of the pages.
        late: messages that are still being made.
    """

    def __init__(self, server: Server, late: DeferredMessages) -> None:
        self._server = server
        self._deferred = late
        self._answered: dict[str, set[int]] = {}
        self._changed = threading.Condition()
        server.channel.on(SyncReply, self._receive)

    def wait(self, timeout: float, browser: int | None = None) -> int:
        """Wait until one connected browser, or all of them, have applied everything queued so far.

        There are three queues: the shared one, that of each browser, and the channel. Applied means
        handled in order; the next frame shows it. Must not be called on viser's event loop.

        Returns:
            Number of browsers that answered; those that are still loading are not waited for.

        Raises:
            TimeoutError: a browser that is still connected did not answer within `timeout` seconds,
                or there was still something to send.
        """
        socket = self._server._websock_server
        tokens = [uuid.uuid4().hex for _ in range(3)]
        shared, own = (
            AcknowledgementRequest(self._server.modules.answer(token)) for token in tokens[:2]
        )
        answered = {token: set[int]() for token in tokens}
        self._answered |= answered
        clients = self._server.get_clients()
        if browser is not None:
            clients = {id_: client for id_, client in clients.items() if id_ == browser}
        deadline = time.monotonic() + timeout
        try:
            if not self._deferred.wait(timeout):
                raise TimeoutError(f"Pictures were not encoded within {timeout:g} s.")
            socket.queue_message(shared)
            self._server.flush()
            for client in clients.values():
                connection = client._websock_connection
                # It may be gone by now, which viser would warn of.
                with connection.get_message_buffer().sanctioned_dead_writes():
                    connection.queue_message(own)
                client.flush()
                self._server.channel.send(SyncRequest(tokens[2]), client.client_id)
            with self._changed:
                while (clients.keys() & self._server.get_clients().keys()) - set.intersection(
                    *answered.values()
                ):
                    if time.monotonic() > deadline:
                        raise TimeoutError(f"A browser did not answer within {timeout:g} s.")
                    self._changed.wait(0.05)
            return len(set.intersection(*answered.values()))
        finally:
            for token in tokens:
                del self._answered[token]
            socket.get_message_buffer().remove_from_buffer(lambda message: message is shared)

    def _receive(self, browser: int, answer: SyncReply) -> None:
        with self._changed:
            if answer.token in self._answered:
                self._answered[answer.token].add(browser)
                self._changed.notify_all()

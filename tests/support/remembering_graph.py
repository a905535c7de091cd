"""A graph that remembers what is published, instead of publishing it."""

from __future__ import annotations

from collections.abc import Collection
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from webviz.data.messages import decode
from webviz.engine.sources import NotConnected, Outlet


@dataclass
class RememberingGraph:
    """Remembers what is published; each topic has as many subscriptions as a test says."""

    subscriptions: int = 1
    published: list[tuple[Outlet, Any]] = field(default_factory=list)
    advertised: Collection[Outlet] = ()
    responses: dict[str, bytes] = field(default_factory=dict)
    """By service, encoded."""
    requests: list[tuple[str, str, bytes]] = field(default_factory=list)
    """Service, type and encoded request."""

    def advertise(self, outlets: Collection[Outlet]) -> Future[None]:
        self.advertised = outlets
        return done(None)

    def publish(self, outlet: Outlet, cdr: bytes) -> Future[int]:
        self.published.append((outlet, decode(outlet.type, cdr)))
        return done(self.subscriptions)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        self.requests.append((service, type, request))
        if service in self.responses:
            return done(self.responses[service])
        missing: Future[bytes] = Future()
        missing.set_exception(NotConnected(f"No node offers {service}. Start one."))
        return missing


def done(result: Any) -> Future[Any]:
    future: Future[Any] = Future()
    future.set_result(result)
    return future

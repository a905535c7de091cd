"""A graph that remembers what is published, instead of publishing it."""

from __future__ import annotations

from collections.abc import Collection
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from webviz.data.messages import decode
from webviz.engine.sources import Outlet


@dataclass
class RememberingGraph:
    """Remembers what is published; each topic has as many subscriptions as a test says."""

    subscriptions: int = 1
    published: list[tuple[Outlet, Any]] = field(default_factory=list)
    advertised: Collection[Outlet] = ()

    def advertise(self, outlets: Collection[Outlet]) -> Future[None]:
        self.advertised = outlets
        return done(None)

    def publish(self, outlet: Outlet, cdr: bytes) -> Future[int]:
        self.published.append((outlet, decode(outlet.type, cdr)))
        return done(self.subscriptions)


def done(result: Any) -> Future[Any]:
    future: Future[Any] = Future()
    future.set_result(result)
    return future

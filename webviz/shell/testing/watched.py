"""A viewer that tests can read between turns of its frame loop."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from webviz.engine.loop import FrameLoop
from webviz.engine.state import State
from webviz.files.config import Config
from webviz.shell.testing.recording import RecordingScene
from webviz.sources import Source, Subscription


class WatchedViewer(FrameLoop):
    """A viewer whose displays raise their errors.

    Args:
        config: to show.
        source: of messages.
        scene: to draw in; its lock is held during each turn.
        options: for `FrameLoop`.
    """

    def __init__(
        self, config: Config, source: Source, scene: RecordingScene, **options: object
    ) -> None:
        super().__init__(config, source, scene, strict=True, **options)  # pyright: ignore[reportArgumentType]
        self.turned = threading.Condition()
        """Notified after every turn."""
        self.turns = 0
        self._lock = scene.lock

    def _advance(self) -> None:
        with self._lock:
            super()._advance()
        with self.turned:
            self.turns += 1
            self.turned.notify_all()

    def _keep_up(self, commanded: bool = False) -> None:
        with self._lock:
            super()._keep_up(commanded)

    def snapshot(self) -> State:
        """Return the state after the last turn."""
        with self._lock:
            return self.state()

    def subscriptions(self) -> Mapping[str, Subscription]:
        """All subscriptions by topic."""
        with self._lock:
            return self._parts.subscriptions()

    def is_waiting(self, id: str) -> bool:
        """Return whether the newest message of a display waits for its transform."""
        with self._lock:
            return any(
                runner.is_waiting() for runner in self._displays.list.active() if runner.id == id
            )

    def is_busy(self) -> bool:
        """Return whether a display is loading."""
        with self._lock:
            return super().is_busy()

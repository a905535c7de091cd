"""ROS time as the frame loop sees it: unknown, paused, or gone back."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping

from webviz.api.status import Level, Status
from webviz.data.transforms.reasons import in_words
from webviz.sources import Offer

log = logging.getLogger("webviz")

JUMP_NS = 100_000_000
"""Smaller steps back are corrections by NTP; bags and simulations go back further."""
STILL_S = 2.0
EVENT_S = 15.0
"""Duration for which a jump back of time is shown."""
LOG_S = 60.0
"""Pause in seconds between two lines of the log, since a clock may jump at each message."""


class RosTime:
    """Checks the time of each turn.

    Args:
        clock: monotonic time in seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._now_ns = 0
        self._moved_at = clock()
        self._event = ""
        self._event_at = 0.0
        self._logged_s = -LOG_S
        self._omitted = 0

    def step(self, now_ns: int) -> bool:
        """Take the time of a turn, 0 while it is unknown; whether it went back."""
        back_ns = self._now_ns - now_ns
        if back_ns != 0:
            self._moved_at = self._clock()
        self._now_ns = now_ns
        if back_ns <= JUMP_NS:
            return False
        self.note(f"Time went back by {in_words(back_ns)}: everything was reset.")
        return True

    def restart(self, now_ns: int) -> None:
        """Go on from another time, deliberately."""
        self._now_ns, self._moved_at, self._event = now_ns, self._clock(), ""

    def note(self, event: str) -> None:
        """Show a sentence for a while, and log it unless one was just logged."""
        self._event, self._event_at = event, self._clock()
        now_s = time.monotonic()
        if now_s - self._logged_s < LOG_S:
            self._omitted += 1
            return
        more = f" ({self._omitted} similar lines omitted)" if self._omitted else ""
        log.warning("%s%s", event, more)
        self._logged_s, self._omitted = now_s, 0

    def status(self, offers: Mapping[str, Offer]) -> Status | None:
        """Return whether time is missing, paused or went back; None if all is well."""
        publishers = offers["/clock"].publishers if "/clock" in offers else ()
        nodes = ", ".join(publisher.label for publisher in publishers)
        if not self._now_ns:
            missing = f"nothing has arrived from {nodes}" if nodes else "it has no publisher"
            return Status(
                Level.WARN,
                f"Waiting for /clock: use_sim_time is set, but {missing}. Start the simulator, or "
                "play the bag with --clock.",
            )
        clock = self._clock()
        if clock - self._moved_at > STILL_S:
            at = f"Simulated time has stopped at {self._now_ns / 1e9:.1f} s"
            if nodes:
                return Status(Level.OK, f"{at}: {nodes} is paused.")
            return Status(Level.WARN, f"{at}: /clock no longer has a publisher.")
        if self._event and clock - self._event_at < EVENT_S:
            return Status(Level.OK, self._event)
        return None

"""The session with a Zenoh network, and the thread that opens and watches it."""

from __future__ import annotations

import logging
import random
import threading
import time
from typing import Any, Protocol

from webviz.data.words import Problem
from webviz.sources.graph import NotConnected
from webviz.sources.jobs import Jobs
from webviz.sources.zenoh.address import ZenohAddress, session_config
from webviz.sources.zenoh.engine import directly, engine
from webviz.sources.zenoh.refusals import explain_refusal, gone
from webviz.sources.zenoh.tokens import ADMIN

log = logging.getLogger("webviz")

FIRST_RETRY_S = 0.5
LAST_RETRY_S = 10.0
PROBE_S = 0.5
STALLED_S = 2.0
"""Time in seconds without an answer of the router, after which nothing is sent: it would arrive
late."""
BROKEN_S = 15.0
"""Time in seconds without one, after which the session is opened anew; the engine gives a link up
after ten."""
CLOSE_S = 3.0
TURN_S = 0.1
NEVER = Problem("The Zenoh router is not connected yet.", "Wait a moment.")
ENDED = "The viewer has ended."


class LinkUser(Protocol):
    """The part of the source that the link calls, in its thread."""

    def joined(self, session: Any) -> None:
        """Use a new session."""
        ...

    def turn(self) -> None:
        """Do what is due, some times a second."""
        ...

    def on_disconnect(self, problem: str) -> None:
        """Fail what is pending, as the session is over."""
        ...


class ZenohLink:
    """Opens a session, again and again, and watches whether its router answers.

    The engine itself reconnects to a router that was restarted, and declares everything again.

    Args:
        address: of the routers or robots.
        user: of the session.
    """

    def __init__(self, address: ZenohAddress, user: LinkUser) -> None:
        self._address = address
        self._user = user
        self._session: Any = None
        self._problem: Problem | None = NEVER
        self._round_trip_s: float | None = None
        self._probe: tuple[Any, float] | None = None
        """A probe that is under way, and when it was sent."""
        self._answered_s = 0.0
        self._gone_s = 0.0
        self._next_probe_s = 0.0
        self._wait_s = FIRST_RETRY_S
        self._next_open_s = 0.0
        self._opening: threading.Thread | None = None
        self._opened: list[Any] = []
        """A session or a problem, from the thread that opens."""
        self._wake = threading.Event()
        self._is_stopped = False
        self._jobs = Jobs(self._wake.set, ENDED)
        self.do = self._jobs.put
        """Calls a function in the thread of the link, with a future for its result."""
        self._thread = threading.Thread(target=self._run, name="webviz-zenoh", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    @property
    def problem(self) -> Problem | None:
        """Return the reason why nothing comes, None if the session works."""
        return self._problem

    @property
    def round_trip_s(self) -> float | None:
        """Return the time of the last answer of the router in seconds; None before one."""
        return self._round_trip_s

    @property
    def silent_s(self) -> float:
        """Seconds for which an answer of the router is overdue."""
        probe = self._probe
        return time.monotonic() - probe[1] if probe else 0.0

    @property
    def session(self) -> Any:
        """The open session; raises NotConnected."""
        if self._session is None or self._problem is not None:
            raise NotConnected(str(self._problem or NEVER))
        return self._session

    def require_fresh(self) -> None:
        """Raise NotConnected if what is sent now would arrive late."""
        if self.silent_s > STALLED_S:
            raise NotConnected(
                f"The Zenoh router has not answered for {self.silent_s:.1f} s, so nothing is sent "
                "that would arrive late."
            )

    def stop(self) -> None:
        """Begin to close the session."""
        self._is_stopped = True
        self._wake.set()

    def close(self) -> None:
        """Close the session and end the thread, unless the engine hangs."""
        self.stop()
        self._thread.join(CLOSE_S)

    def wake(self) -> None:
        """Have the user's `turn` called soon."""
        self._wake.set()

    # The thread

    def _run(self) -> None:
        while not self._is_stopped:
            self._wake.wait(TURN_S)
            self._wake.clear()
            if self._session is None:
                self._open()
            else:
                self._watch()
            self._jobs.run()
            self._user.turn()
        self._user.on_disconnect(ENDED)
        self._jobs.end()
        if self._session is not None:
            self._session.close()

    def _open(self) -> None:
        """Have a thread open the session, which may take many seconds, or take what it opened."""
        if self._opened:
            self._take(self._opened.pop())
            self._opening = None
        elif self._opening is None and time.monotonic() >= self._next_open_s:
            self._opening = threading.Thread(target=self._try, name="webviz-open", daemon=True)
            self._opening.start()

    def _try(self) -> None:
        """Open the session once."""
        try:
            session = engine().open(session_config(self._address))
        except Exception as error:  # the engine raises its own kind, and what Rust panics with
            self._opened.append(explain_refusal(self._address, str(error)))
        else:
            if self._is_stopped:
                session.close()
            self._opened.append(session)
        self._wake.set()

    def _take(self, opened: Any) -> None:
        if isinstance(opened, Problem):
            if opened != self._problem:
                log.warning("%s: %s", self._address.name, opened)
            self._problem = opened
            # Not all viewers of a robot at the same moment.
            self._next_open_s = time.monotonic() + self._wait_s * random.uniform(0.8, 1.2)
            self._wait_s = min(LAST_RETRY_S, self._wait_s * 2)
            return
        self._session = opened
        self._wait_s = FIRST_RETRY_S
        self._probe = None
        self._set_problem(None)
        self._user.joined(opened)

    def _watch(self) -> None:
        """Ask whether the router is there and answers."""
        now_s = time.monotonic()
        info = self._session.info
        if not info.routers_zid() and not info.peers_zid():
            if not self._gone_s:
                self._gone_s = now_s
                self._user.on_disconnect(str(gone(self._address, now_s)))
            self._probe = None
            self._set_problem(gone(self._address, self._gone_s))
            return
        self._gone_s = 0.0
        if self.silent_s > BROKEN_S:
            self._give_up()
            return
        self._set_problem(None)
        if self._probe is None and now_s >= self._next_probe_s:
            self._ask()

    def _ask(self) -> None:
        """Ask the router for a key that no node has; its answer is the round trip."""
        began_s = time.monotonic()
        mark = object()
        self._probe = mark, began_s

        def answered() -> None:
            if self._probe is not None and self._probe[0] is mark:
                self._round_trip_s = time.monotonic() - began_s
                self._next_probe_s = time.monotonic() + PROBE_S
                self._probe = None

        key = f"{ADMIN}/{self._address.domain}/webviz_probe"
        self._session.liveliness().get(
            key, directly(lambda _: None, answered), timeout=BROKEN_S * 2
        )

    def _give_up(self) -> None:
        """Leave a session whose router hangs, and open another."""
        silent_s, session = self.silent_s, self._session
        self._session = self._probe = None
        text = f"The Zenoh router at {self._address.name} has not answered for {silent_s:.0f} s."
        self._set_problem(Problem(text, "Restart it, or check the network."))
        self._user.on_disconnect(text)
        # It may wait for the link that hangs.
        threading.Thread(target=session.close, name="webviz-close", daemon=True).start()

    def _set_problem(self, problem: Problem | None) -> None:
        before, self._problem = self._problem, problem
        if (before is None) != (problem is None) and before is not NEVER:
            log.warning("%s: %s", self._address.name, problem or "connected.")

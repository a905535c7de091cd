"""One's own past: a page looks back on its own, while all others stay live."""

from __future__ import annotations

import time
from collections.abc import Callable

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.engine.commands import FileCommand, Sender, ignore
from webviz.engine.feature import command, store
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.requests import Job
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.sources.recording.memory import MEMORY_OFF
from webviz.sources.recording.moment import MomentHistory

ABSENT_S = 30.0
"""Time in seconds after which the viewer of a page ends that has gone, or never came."""
NOT_HERE = "This viewer shows no page a past of its own. Look back for everybody."
NO_PAGE = "Only a page can look back on its own."
FROZEN_ALREADY = "Looking back for one page needs live topics. Return to live first."


class OwnPastStore(PageStore, frozen=True):
    """The choice of a page that looks back.

    Args:
        is_own: whether this is the viewer of one page that looks back on its own.
        can_open: whether pages can look back on their own.
    """

    is_own: bool
    can_open: bool


class OwnPastFeature(PageFeature):
    """Shows a page the past on its own, in a viewer that ends with it."""

    name = "Own past"
    module = "own_past.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._seen_s = time.monotonic()

    def attach(self, dispatcher: Dispatcher) -> None:
        """Know whose page is which."""
        self._channel = dispatcher.channel

    def keep_up(self, commanded: bool) -> None:
        """End such a viewer when its page has been gone for a while."""
        if (leave := self.context.host.leave) is None:
            return
        now_s = time.monotonic()
        if self.context.is_watched():
            self._seen_s = now_s
        elif now_s - self._seen_s > ABSENT_S:
            leave()

    @store()
    def own_past(self, argument: str) -> OwnPastStore:
        """Return whether this is such a viewer, and whether there can be any."""
        host = self.context.host
        return OwnPastStore(host.leave is not None, host.look_back is not None)

    @command(Role.OPERATOR, FileCommand, is_noted=True)
    def look_back_alone(
        self, at_s: float, sender: Sender, opened: Callable[[str], object] = ignore
    ) -> Job[str]:
        """Show one page the past of live topics on its own; the answer has its address.

        Args:
            at_s: the moment, as that of `Seek`.
            opened: called by the frame loop with the address, relative to that of the viewer.
        """
        look_back, player = self.context.host.look_back, self.context.player
        memory = player.memory
        if look_back is None:
            raise Error(NOT_HERE)
        if sender.browser is None:
            raise Error(NO_PAGE)
        if memory is None or player.is_opened:
            raise Error(FROZEN_ALREADY)
        if not memory.recent.is_on or memory.recent.oldest_s is None:
            raise Error(MEMORY_OFF)
        grant = self._channel.grant_of(sender.browser)
        if grant is None:
            raise Error(NO_PAGE)
        views, files = self.context.get(ViewsPart), self.context.get(ConfigPart)
        config = views.as_seen(files.config(), sender)
        history = MomentHistory(memory)
        at_ns = self.context.get(TimePart).at_ns(at_s)
        cookie = grant.cookie

        def then(address: str) -> str:
            opened(address)
            return "Looks back on its own."

        return Job(lambda: look_back(config, history, at_ns, cookie), then)

"""The links to bridges, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.bridge import Bridge
from webviz.api.robots import robots_of
from webviz.api.status import Level, Status
from webviz.data.words import joined
from webviz.engine.feature import Feature, store
from webviz.engine.forms import brief
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.store import PageStore
from webviz.sources import Fleet


class BridgesStore(PageStore, frozen=True):
    """The links to bridges.

    Args:
        all: address or robot of each, why it is not live, "" if it is, and what is wrong with its
            link, such as topics that are thinned; "" if nothing is.
    """

    all: Sequence[tuple[str, str, str]]


class BridgesFeature(Feature):
    """Shows the bridges of the source, and has it connect to the robots of the config."""

    name = "Connection"
    module = "bridges.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        live = context.player.live
        self._fleet = live if isinstance(live, Fleet) else None
        self._followed: object = None

    def keep_up(self, commanded: bool) -> None:
        """Connect to the robots of a config that was opened or edited."""
        robots = self.context.get(SettingsPart).settings.robots
        if self._fleet is not None and robots is not self._followed:
            self._followed = robots
            self._fleet.follow(robots_of(robots))

    def links(self) -> tuple[Bridge, ...]:
        """Return the bridges as they are now."""
        return tuple(self.context.player.bridges)

    def state(self) -> Mapping[str, Any]:
        """Return the bridges."""
        return {"bridges": self.links()}

    @store()
    def bridges(self, argument: str) -> BridgesStore | None:
        """Return the bridges, None without one."""
        all_ = [
            (
                brief(bridge.title),
                "" if bridge.is_up else brief(bridge.problem),
                brief(next(iter(bridge.remarks), "")),
            )
            for bridge in self.links()
        ]
        return BridgesStore(all_) if all_ else None

    def statuses(self) -> Mapping[str, Status]:
        """Return one status for each bridge."""
        bridges = self.context.player.bridges
        return {_key(bridge, bridges): status_of(bridge) for bridge in bridges}


def status_of(bridge: Bridge) -> Status:
    """Return the status of a bridge."""
    if not bridge.is_up:
        level = Level.ERROR if bridge.problem else Level.WARN
        return Status(
            level, joined(f"{bridge.name} is not connected. {bridge.problem}", bridge.remedy)
        )
    if bridge.remarks:
        return Status(Level.WARN, joined(*bridge.remarks))
    trip = f", round trip {bridge.round_trip_s * 1e3:.0f} ms" if bridge.round_trip_s else ""
    text = f"Connected to {bridge.name} ({bridge.protocol}{trip})"
    return Status(Level.OK, joined(text, *_clock(bridge), *bridge.limits))


def _clock(bridge: Bridge) -> Sequence[str]:
    """Return the difference of the clocks as a sentence, none if there is none."""
    if not bridge.clock_s:
        return ()
    way = "ahead of" if bridge.clock_s > 0 else "behind"
    return (
        f"Its clock is {abs(bridge.clock_s):.2f} s {way} that of this machine; stamps are "
        "corrected.",
    )


def _key(bridge: Bridge, bridges: Sequence[Bridge]) -> str:
    return "Connection" if len(bridges) == 1 else f"Connection to {bridge.title}"

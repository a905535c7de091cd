"""The links to bridges, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.bridge import Bridge
from webviz.api.status import Level, Status
from webviz.data.words import joined
from webviz.engine.parts.part import Part


class BridgesPart(Part):
    """Shows the bridges of the source."""

    name = "Connection"

    def state(self) -> Mapping[str, Any]:
        """Return the bridges as they are now."""
        return {"bridges": tuple(self.core.source.bridges)}

    def statuses(self) -> Mapping[str, Status]:
        """Return one status for each bridge."""
        bridges = self.core.source.bridges
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
    return Status(Level.OK, joined(text, *bridge.limits))


def _key(bridge: Bridge, bridges: Sequence[Bridge]) -> str:
    return "Connection" if len(bridges) == 1 else f"Connection to {bridge.name}"

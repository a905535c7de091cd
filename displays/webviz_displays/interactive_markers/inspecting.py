"""Details of a selected interactive marker."""

from __future__ import annotations

import math
import re

from webviz import Details
from webviz_displays.interactive_markers.tracked import Tracked

_KEY = re.compile(r"(?:c(\d+)|\w+)/(m\d+)")


def part_of(key: str) -> tuple[str, int | None] | None:
    """Return the key of the marker that a node belongs to, and the index of its control, if any."""
    found = _KEY.match(key)
    return (found[2], None if found[1] is None else int(found[1])) if found else None


def details(marker: Tracked, index: int | None) -> Details:
    """Return a marker, and one of its controls."""
    made, place = marker.made, marker.source
    values: dict[str, object] = {"Marker": made.name}
    if made.description:
        values["Description"] = made.description
    if index is not None and index < len(made.parts):
        part = made.parts[index]
        values["Control"] = part.control.name or "(no name)"
        values["Interaction"] = part.control.mode.replace("_", " ")
        if part.control.help:
            values["Help"] = part.control.help
        if turned := marker.turned.get(part.control.name):
            values["Turned by"] = f"{math.degrees(turned):.1f}°"
    values[f"Pose in {place.frame}"] = place.pose
    values["Scale"] = made.scale
    return Details(f"Interactive marker {made.name}", values)

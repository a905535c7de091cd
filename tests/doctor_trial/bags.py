"""Faults of the other files, in bags of them."""

from __future__ import annotations

from dataclasses import replace

from tests.doctor_trial import clocks, data, frames

LIVE_ONLY = {"TF024", "TIME001", "TIME013", "TIME014", "DATA015"}
OF_BAGS = (
    "stops",
    "loop",
    "two parents",
    "misspelt",
    "slash",
    "NaN",
    "degrees",
    "turned",
    "upside down",
    "zero",
    "twist",
    "jumps",
    "unknown",
    "millimetres",
    "localisation does not",
    "joint states of",
    "joint states without",
    "empty",
)
"""Words of the names of faults that a bag shows as well."""

ALL = [
    replace(each, name=f"{each.name} (bag)", remedy="", is_recorded=True)
    for each in (*frames.ALL, *clocks.ALL, *data.ALL)
    if each.id not in LIVE_ONLY and not each.options and any(word in each.name for word in OF_BAGS)
]

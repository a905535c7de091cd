"""Fixes of satellite receivers, as they arrive."""

from __future__ import annotations

import math
from typing import Any

from webviz import Input
from webviz.data.geo import Geodetic, is_valid

FIX = Input("sensor_msgs/msg/NavSatFix")
NO_FIX = -1
"""`status.status` of a receiver that knows no position."""


def place_of(message: Any) -> Geodetic:
    """Return the place of a sensor_msgs/NavSatFix; an altitude that is not known is 0."""
    altitude = message.altitude if math.isfinite(message.altitude) else 0.0
    return Geodetic(message.latitude, message.longitude, altitude)


def fault_of(message: Any) -> str:
    """Return a sentence why a sensor_msgs/NavSatFix names no place, "" if it does."""
    if message.status.status <= NO_FIX:
        return "The receiver has no fix. Check its antenna and the view of the sky."
    latitude, longitude = message.latitude, message.longitude
    if not is_valid(latitude, longitude):
        return (
            f"Latitude {latitude:g} and longitude {longitude:g} are not a place in degrees. "
            "Fix the publisher."
        )
    return ""

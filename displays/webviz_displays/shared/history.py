"""Number of messages a display shows at once."""

from __future__ import annotations

from typing import Annotated

from webviz import Prop

HistoryLength = Annotated[
    int, Prop(ge=1, le=10_000, help="How many of the newest messages to show.")
]
"""A property; the framework holds no more."""

"""Displays that are switched together."""

from __future__ import annotations

from webviz.api.display import Display


class Group(Display):
    """A group of displays; switched off, none of them is drawn.

    In a config file it has the type `Group` and its displays under `displays`.
    """

    rviz = "rviz_common/Group"

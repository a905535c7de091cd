"""Groups of displays."""

from __future__ import annotations

from webviz.api.display import Display

PATH = " > "
"""Joins the names of groups and displays where one text names a display in groups."""


class DisplayGroup(Display):
    """A group of displays; switched off, none of them is drawn.

    In a config file, its type is `Group` and its displays are listed under `displays`.
    """

    title = "Group"
    rviz = "rviz_common/Group"
    icon = "folder"

"""The commands of a viewer: sent by the panel, ROS or Python, carried out by the frame loop."""

from webviz.engine.commands.command import (
    MAX_PRIORITY,
    PROGRAM,
    Command,
    Sender,
    mistaken,
    wrong_text,
)
from webviz.engine.commands.files import (
    FileCommand,
    Restore,
)
from webviz.engine.commands.panel import (
    Refresh,
)
from webviz.engine.commands.selection import Pick, Picks
from webviz.engine.commands.tools import (
    CallService,
    Publish,
)

__all__ = [
    "MAX_PRIORITY",
    "PROGRAM",
    "CallService",
    "Command",
    "FileCommand",
    "Pick",
    "Picks",
    "Publish",
    "Refresh",
    "Restore",
    "Sender",
    "mistaken",
    "wrong_text",
]

"""The commands of a viewer: sent by the panel, ROS or Python, carried out by the frame loop."""

from webviz.engine.commands.command import (
    MAX_PRIORITY,
    PROGRAM,
    Command,
    Sender,
    mistaken,
    wrong_text,
)
from webviz.engine.commands.displays import (
    DragHandle,
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
    CancelGoal,
    DismissGoal,
    Publish,
    SendGoal,
    SetToolProperty,
    UseTool,
)
from webviz.engine.commands.topics import (
    InspectTopic,
    InspectTopics,
    InspectTransforms,
    LookUpTransform,
)
from webviz.engine.commands.viewer import (
    ReloadPlugin,
)

__all__ = [
    "MAX_PRIORITY",
    "PROGRAM",
    "CallService",
    "CancelGoal",
    "Command",
    "DismissGoal",
    "DragHandle",
    "FileCommand",
    "InspectTopic",
    "InspectTopics",
    "InspectTransforms",
    "LookUpTransform",
    "Pick",
    "Picks",
    "Publish",
    "Refresh",
    "ReloadPlugin",
    "Restore",
    "SendGoal",
    "Sender",
    "SetToolProperty",
    "UseTool",
    "mistaken",
    "wrong_text",
]

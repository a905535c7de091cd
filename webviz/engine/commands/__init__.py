"""The commands of a viewer: sent by the panel, ROS or Python, carried out by the frame loop."""

from webviz.engine.commands.command import PROGRAM, Command, Sender
from webviz.engine.commands.displays import (
    AddDisplay,
    DuplicateDisplay,
    MoveDisplay,
    RemoveDisplay,
    ResetDisplay,
    SetProperty,
    TraceDisplay,
)
from webviz.engine.commands.files import Export, FileCommand, Load, Open, Save, WriteDisplays
from webviz.engine.commands.goals import CancelGoal, DismissGoal
from webviz.engine.commands.handles import GripHandle
from webviz.engine.commands.history import Redo, Undo
from webviz.engine.commands.panel import (
    AddPanel,
    OpenPanels,
    Refresh,
    RemovePanel,
    SetPanelProperty,
)
from webviz.engine.commands.plugins import ReloadPlugin
from webviz.engine.commands.ports import CallService, Publish
from webviz.engine.commands.selection import Identify, InspectSelections, Pick, Picks, Select
from webviz.engine.commands.settings import SetBackground, SetFixedFrame, SetFrameRate
from webviz.engine.commands.time import Pause, Reset
from webviz.engine.commands.tools import SetToolProperty, UseTool
from webviz.engine.commands.topics import InspectTopic, InspectTopics
from webviz.engine.commands.transforms import InspectTransforms
from webviz.engine.commands.views import (
    ChangeView,
    FocusDisplay,
    FocusFrame,
    RemoveView,
    RenameView,
    ResetView,
    SaveImage,
    SaveView,
    ShowView,
    StartWithView,
    ViewCommand,
)

__all__ = [
    "PROGRAM",
    "AddDisplay",
    "AddPanel",
    "CallService",
    "CancelGoal",
    "ChangeView",
    "Command",
    "DismissGoal",
    "DuplicateDisplay",
    "Export",
    "FileCommand",
    "FocusDisplay",
    "FocusFrame",
    "GripHandle",
    "Identify",
    "InspectSelections",
    "InspectTopic",
    "InspectTopics",
    "InspectTransforms",
    "Load",
    "MoveDisplay",
    "Open",
    "OpenPanels",
    "Pause",
    "Pick",
    "Picks",
    "Publish",
    "Redo",
    "Refresh",
    "ReloadPlugin",
    "RemoveDisplay",
    "RemovePanel",
    "RemoveView",
    "RenameView",
    "Reset",
    "ResetDisplay",
    "ResetView",
    "Save",
    "SaveImage",
    "SaveView",
    "Select",
    "Sender",
    "SetBackground",
    "SetFixedFrame",
    "SetFrameRate",
    "SetPanelProperty",
    "SetProperty",
    "SetToolProperty",
    "ShowView",
    "StartWithView",
    "TraceDisplay",
    "Undo",
    "UseTool",
    "ViewCommand",
    "WriteDisplays",
]

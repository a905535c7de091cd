"""The role that each message of a browser requires. What is not listed is refused to everybody."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine import commands
from webviz.server.access import requests
from webviz.server.access.roles import Role

COMMANDS: Mapping[type[Any], Role] = {
    # A page's own camera, selection and pictures, and texts of what everybody sees.
    commands.ChangeView: Role.WATCHER,
    commands.Export: Role.WATCHER,
    commands.FocusDisplay: Role.WATCHER,
    commands.FocusFrame: Role.WATCHER,
    commands.Identify: Role.WATCHER,
    commands.LookUpTransform: Role.WATCHER,
    commands.ResetView: Role.WATCHER,
    commands.SaveImage: Role.WATCHER,
    commands.Select: Role.WATCHER,
    commands.ShowView: Role.WATCHER,
    commands.WriteDisplays: Role.WATCHER,
    # What everybody sees, and what the robot does.
    commands.AddDisplay: Role.OPERATOR,
    commands.AddPanel: Role.OPERATOR,
    commands.CancelGoal: Role.OPERATOR,
    commands.DismissGoal: Role.OPERATOR,
    commands.DuplicateDisplay: Role.OPERATOR,
    commands.DragHandle: Role.OPERATOR,
    commands.EndTrial: Role.OPERATOR,
    commands.FindFrame: Role.OPERATOR,
    commands.MoveDisplay: Role.OPERATOR,
    commands.Pause: Role.OPERATOR,
    commands.Play: Role.OPERATOR,
    commands.Redo: Role.OPERATOR,
    commands.RemoveBookmark: Role.OPERATOR,
    commands.RemoveDisplay: Role.OPERATOR,
    commands.RemoveLayout: Role.OPERATOR,
    commands.RemovePanel: Role.OPERATOR,
    commands.RemoveView: Role.OPERATOR,
    commands.RenameView: Role.OPERATOR,
    commands.Reset: Role.OPERATOR,
    commands.ResetDisplay: Role.OPERATOR,
    commands.ReturnToLive: Role.OPERATOR,
    commands.SaveBookmark: Role.OPERATOR,
    commands.SaveLayout: Role.OPERATOR,
    commands.SaveView: Role.OPERATOR,
    commands.Seek: Role.OPERATOR,
    commands.SelectSpan: Role.OPERATOR,
    commands.SetBackground: Role.OPERATOR,
    commands.SetFixedFrame: Role.OPERATOR,
    commands.SetFrameRate: Role.OPERATOR,
    commands.SetLayout: Role.OPERATOR,
    commands.SetLoop: Role.OPERATOR,
    commands.SetPanelProperty: Role.OPERATOR,
    commands.SetProperty: Role.OPERATOR,
    commands.SetRate: Role.OPERATOR,
    commands.SetToolProperty: Role.OPERATOR,
    commands.StartWithView: Role.OPERATOR,
    commands.StepMessage: Role.OPERATOR,
    commands.TryFrame: Role.OPERATOR,
    commands.Undo: Role.OPERATOR,
    commands.UseTool: Role.OPERATOR,
    requests.UseWidget: Role.OPERATOR,
    # Files of the machine that runs the viewer, and the config as a whole.
    commands.ListMoment: Role.OWNER,
    commands.ListReport: Role.OWNER,
    commands.Load: Role.OWNER,
    commands.Open: Role.OWNER,
    commands.OpenRecording: Role.OWNER,
    commands.Save: Role.OWNER,
    commands.SaveMemory: Role.OWNER,
    commands.SaveReport: Role.OWNER,
    commands.ShareMoment: Role.OWNER,
    commands.StartRecording: Role.OWNER,
    commands.StopRecording: Role.OWNER,
    commands.StopSharing: Role.OWNER,
    # Who may come.
    requests.Dismiss: Role.OWNER,
    requests.Invite: Role.OWNER,
    requests.Revoke: Role.OWNER,
}
"""Of the commands that pages may send; see `webviz.page.dispatcher`."""

MESSAGES: Mapping[str, Role | None] = {
    "Answer": Role.WATCHER,
    "Do": None,
    "Drive": Role.OPERATOR,
    "FramesShown": Role.WATCHER,
    "HasPainted": Role.OPERATOR,
    "Hello": Role.WATCHER,
    "PointCapacity": Role.OPERATOR,
    "Ping": Role.WATCHER,
    "ReadPixel": Role.WATCHER,
    "ShowPictures": Role.WATCHER,
    "Unwatch": Role.WATCHER,
    "ViewReport": Role.WATCHER,
    "Vitals": Role.OPERATOR,
    "Watch": Role.WATCHER,
}
"""Of the messages of `webviz.server.channel.messages`; None if it is that of the command within."""

STORES: Mapping[str, Role] = {
    "addresses": Role.OWNER,
    "black_box": Role.OWNER,
    "journal": Role.OWNER,
    "links": Role.OWNER,
    "sharing": Role.OWNER,
}
"""Of the stores that not everybody may watch; see `webviz.page.content`."""

SCENE: Mapping[str, Role] = {
    "SceneNodeClickMessage": Role.OPERATOR,
    "SceneNodeDragMessage": Role.OPERATOR,
    "ScenePointerMessage": Role.OPERATOR,
    "TransformControlsDragEndMessage": Role.OPERATOR,
    "TransformControlsDragStartMessage": Role.OPERATOR,
    "TransformControlsUpdateMessage": Role.OPERATOR,
    "ViewerCameraMessage": Role.WATCHER,
}
"""Of the messages that viser's page sends of its own accord. Deliberately missing are those of
viser's widgets, of which pages show none, and ShareUrlRequest, which opens a public tunnel."""

UNKNOWN = "Not done: this page is out of date. Reload the page."
REMEDY = "Ask the owner of this viewer for another link."

_COMMANDS = {class_.__name__: role for class_, role in COMMANDS.items()}


def refusal(role: Role, kind: str, command: str = "", store: str = "") -> str:
    """Why a message is refused: a sentence, "" if it is not.

    Args:
        role: of the sender.
        kind: of the message, one of `MESSAGES` or `SCENE`.
        command: name of the command within, if it is a `Do`.
        store: that is to be watched, if it is a `Watch`.
    """
    required = SCENE.get(kind) or MESSAGES.get(kind)
    if kind == "Do":
        required = _COMMANDS.get(command)
    if required is None:
        return UNKNOWN
    if store:
        required = max(required, STORES.get(store.partition(":")[0], Role.WATCHER))
    if role >= required:
        return ""
    return f"Not allowed: this needs {required.phrase}, and you are {role.phrase}. {REMEDY}"


def table() -> dict[str, str]:
    """For pages: the label of the role that each command and message of theirs needs."""
    messages = {kind: role.label for kind, role in MESSAGES.items() if role is not None}
    return messages | {name: role.label for name, role in _COMMANDS.items()}

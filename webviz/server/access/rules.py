"""The role that each message of a browser requires. What is not listed is refused to everybody."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

from webviz.api.roles import Role
from webviz.engine import feature

MESSAGES: Mapping[str, Role | None] = {
    "SyncReply": Role.WATCHER,
    "CommandRequest": None,
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
"""Roles of the messages of `webviz.server.channel.messages`; None if it is that of the command
within."""

SCENE: Mapping[str, Role] = {
    "SceneNodeClickMessage": Role.OPERATOR,
    "SceneNodeDragMessage": Role.OPERATOR,
    "ScenePointerMessage": Role.OPERATOR,
    "TransformControlsDragEndMessage": Role.OPERATOR,
    "TransformControlsDragStartMessage": Role.OPERATOR,
    "TransformControlsUpdateMessage": Role.OPERATOR,
    "ViewerCameraMessage": Role.WATCHER,
}
"""Roles of the messages that viser's page sends of its own accord. Deliberately missing are those
of viser's widgets, of which pages show none, and ShareUrlRequest, which opens a public tunnel."""

UNKNOWN = "Failed: this page is out of date. Reload the page."
REMEDY = "Ask the owner of this viewer for another link."


@functools.cache
def commands() -> Mapping[type[Any], Role]:
    """Return the commands that pages may send, with the roles; see `webviz.page.dispatcher`."""
    own = feature.commands().values()
    return {each.type: each.role for each in own if each.role is not None}


def role_to_watch(store: str) -> Role:
    """Return the role that a store requires, by its name before the colon."""
    own = feature.stores().get(store)
    return Role.WATCHER if own is None else own.role


@functools.cache
def _by_name() -> Mapping[str, Role]:
    return {class_.__name__: role for class_, role in commands().items()}


def refusal(role: Role, kind: str, command: str = "", store: str = "") -> str:
    """Return why a message is refused: a sentence, "" if it is not.

    Args:
        role: of the sender.
        kind: of the message, one of `MESSAGES` or `SCENE`.
        command: name of the command within, if it is a `CommandRequest`.
        store: that is to be watched, if it is a `Watch`.
    """
    required = SCENE.get(kind) or MESSAGES.get(kind)
    if kind == "CommandRequest":
        required = _by_name().get(command)
    if required is None:
        return UNKNOWN
    if store:
        required = max(required, role_to_watch(store.partition(":")[0]))
    if role >= required:
        return ""
    return f"Not allowed: this needs {required.phrase}, and you are {role.phrase}. {REMEDY}"


def table() -> dict[str, str]:
    """Return the label of the role that each command and message of a page needs."""
    messages = {kind: role.label for kind, role in MESSAGES.items() if role is not None}
    return messages | {name: role.label for name, role in _by_name().items()}

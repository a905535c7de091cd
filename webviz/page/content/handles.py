"""Handles that pages can drag in the scene."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar

import msgspec

from webviz.api.handles import Control, Facing, Handle, MenuEntry, Mode, Wxyz
from webviz.engine.pipeline.dragging import reference_group
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.forms import brief

MAX_HELP = 300
MAX_TITLE = 200


class HandleControl(msgspec.Struct, frozen=True):
    """A control of a handle, see `webviz.api.handles.Control`."""

    mode: Mode
    facing: Facing
    wxyz: Wxyz
    always: bool
    help: str
    turned: float


class HandleMenuEntry(msgspec.Struct, frozen=True):
    """An entry of a menu, see `webviz.api.handles.MenuEntry`."""

    id: int
    title: str
    checked: bool | None
    refusal: str
    entries: Sequence[HandleMenuEntry]


class SceneHandle(msgspec.Struct, frozen=True):
    """A handle as pages draw it, see `webviz.api.handles.Handle`.

    Args:
        frame: group of the scene that its pose is relative to, "" for the fixed frame.
        holder: the browser that holds it, None for none.
    """

    name: str
    frame: str
    controls: Sequence[HandleControl]
    menu: Sequence[HandleMenuEntry]
    aids: bool
    refusal: str
    holder: int | None


class HandlesStore(PageStore, frozen=True):
    """The handles, by the id of their display and their key with a slash between."""

    spread: ClassVar = {"handles": ""}

    handles: Mapping[str, SceneHandle]


def handles(state: State, _: str) -> HandlesStore:
    """Return the handles of all displays."""
    return HandlesStore(
        {
            f"{display}/{key}": _handle(display, handle, holder)
            for (display, key), (handle, holder) in state.handles.items()
        }
    )


def _handle(display: str, handle: Handle, holder: int | None) -> SceneHandle:
    return SceneHandle(
        name=brief(handle.name, MAX_TITLE),
        frame=reference_group(display, handle.frame) if handle.frame else "",
        controls=[_control(control) for control in handle.controls],
        menu=_menu(handle.menu),
        aids=handle.aids,
        refusal=handle.refusal,
        holder=holder,
    )


def _control(control: Control) -> HandleControl:
    return HandleControl(
        mode=control.mode,
        facing=control.facing,
        wxyz=control.wxyz,
        always=control.is_always_visible,
        help=brief(control.help, MAX_HELP),
        turned=control.turned,
    )


def _menu(entries: Iterable[MenuEntry]) -> list[HandleMenuEntry]:
    return [
        HandleMenuEntry(
            id=entry.id,
            title=brief(entry.title, MAX_TITLE),
            checked=entry.is_checked,
            refusal=entry.refusal,
            entries=_menu(entry.entries),
        )
        for entry in entries
    ]

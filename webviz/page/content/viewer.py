"""Settings of the viewer as a whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec

from webviz.api.nodes import Rgb
from webviz.api.views import type_of
from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.files.config import Settings
from webviz.page.content.forms import Form, form, values_of
from webviz.page.content.properties import StatusLine, lines

NO_CONTROL = (
    *("version", "view", "views", "memory", "watch", "watch_limits", "bookmarks", "rviz"),
    *("layout", "layouts", "publish"),
)
"""Settings that have another place on the page, or none."""

OF_EVERY_NODE = frozenset({"/rosout", "/parameter_events"})
OWN_NODE = "/webviz"
"""Unless it is remapped, which is rare before anything is published."""


class SettingsStore(PageStore, frozen=True):
    """Settings of the viewer, and its statuses.

    Args:
        declared, values: of the properties of the settings.
        fixed_frame, background, frame_rate: among the values, too.
        views: names of the saved ones.
        statuses, more: see `webviz.page.content.properties.StatusesStore`.
    """

    spread: ClassVar = {"values": "value."}

    declared: Form
    values: Mapping[str, Any]
    fixed_frame: str
    background: Rgb | None
    frame_rate: float
    views: Sequence[str]
    statuses: Sequence[StatusLine]
    more: int


class FramesStore(PageStore, frozen=True):
    """All frame ids."""

    frames: Sequence[str]


class FileStore(PageStore, frozen=True):
    """The config file, see `webviz.engine.state.ConfigFile`."""

    path: str
    is_changed: bool
    folder: str
    others: Sequence[str]


class GraphStore(PageStore, frozen=True):
    """The ROS graph.

    Args:
        is_empty: whether nothing is published, except by webviz and on topics of every node.
    """

    is_empty: bool


class ViewTypeStore(PageStore, frozen=True):
    """The view of a browser: its type and the frame that it follows; unset before it has one."""

    type: str | msgspec.UnsetType = msgspec.UNSET
    target_frame: str | msgspec.UnsetType = msgspec.UNSET


def settings(state: State, _: str) -> SettingsStore:
    """Return settings of the viewer as a whole."""
    settings = state.settings
    told = lines(state.statuses)
    return SettingsStore(
        declared=form(Settings, NO_CONTROL),
        values=values_of(settings, NO_CONTROL),
        fixed_frame=settings.fixed_frame,
        background=settings.background,
        frame_rate=settings.frame_rate,
        views=list(settings.views),
        statuses=told.statuses,
        more=told.more,
    )


def frames(state: State, _: str) -> FramesStore:
    """All frame ids."""
    return FramesStore(state.frames)


def file(state: State, _: str) -> FileStore:
    """Return the config file."""
    file = state.file
    return FileStore(file.path, file.is_changed, file.folder, file.others)


def graph(state: State, _: str) -> GraphStore:
    """Return the ROS graph."""
    published = (offer for topic, offer in state.offers.items() if topic not in OF_EVERY_NODE)
    nodes = {publisher.node for offer in published for publisher in offer.publishers}
    return GraphStore(is_empty=not nodes - {OWN_NODE})


def view_type(state: State, browser: str) -> ViewTypeStore:
    """Return the type of view of the browser with this id."""
    view = next((view for id_, view in state.views.items() if str(id_) == browser), None)
    return ViewTypeStore() if view is None else ViewTypeStore(type_of(view), view.target_frame)

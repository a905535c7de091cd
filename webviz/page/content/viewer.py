"""Settings of the viewer as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from webviz.api.views import type_of
from webviz.engine.state import State
from webviz.files.config import Settings
from webviz.page.content.forms import form, values_of
from webviz.page.content.properties import lines

NO_CONTROL = (
    *("version", "view", "views", "memory", "watch", "watch_limits", "bookmarks", "rviz"),
    "publish",
)
"""Settings that have another place on the page, or none."""

OF_EVERY_NODE = frozenset({"/rosout", "/parameter_events"})
OWN_NODE = "/webviz"
"""Unless it is remapped, which is rare before anything is published."""


def settings(state: State, _: str) -> Mapping[str, Any]:
    """Fixed frame, background, frame rate, saved views, and statuses.

    "declared" is what the page needs to know of the first three, which are among the values too.
    """
    settings = state.settings
    return {
        "declared": form(Settings, NO_CONTROL),
        **values_of(settings, NO_CONTROL),
        "fixed_frame": settings.fixed_frame,
        "background": settings.background,
        "frame_rate": settings.frame_rate,
        "views": list(settings.views),
        **lines(state.statuses),
    }


def frames(state: State, _: str) -> Mapping[str, Any]:
    """All frame ids."""
    return {"frames": state.frames}


def file(state: State, _: str) -> Mapping[str, Any]:
    """The config file."""
    return asdict(state.file)


def graph(state: State, _: str) -> Mapping[str, Any]:
    """Return whether nothing is published, except by webviz and on topics of every node."""
    published = (offer for topic, offer in state.offers.items() if topic not in OF_EVERY_NODE)
    nodes = {publisher.node for offer in published for publisher in offer.publishers}
    return {"is_empty": not nodes - {OWN_NODE}}


def view_type(state: State, browser: str) -> Mapping[str, Any]:
    """Of the browser with this id: the type of its view and what that follows; nothing before."""
    view = next((view for id_, view in state.views.items() if str(id_) == browser), None)
    return {} if view is None else {"type": type_of(view), "target_frame": view.target_frame}

"""Contents of the page's stores, made from the state of the viewer.

One function a store: from a state, and what stands behind the colon of the store's name, to values
by key. It runs some times a second while a page watches, so it has to be quick; what has not
changed is not sent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.edges.page.content.clock import clock
from webviz.edges.page.content.displays import displays, rate
from webviz.edges.page.content.goals import goals, routes
from webviz.edges.page.content.handles import handles
from webviz.edges.page.content.history import history
from webviz.edges.page.content.panes import panes
from webviz.edges.page.content.playback import bookmarks, density, events, playback, recorded
from webviz.edges.page.content.properties import properties, statuses, topics_of
from webviz.edges.page.content.recording import recording
from webviz.edges.page.content.scene import legend, watchers
from webviz.edges.page.content.selection import picking, selected, selection
from webviz.edges.page.content.tools import driving, tool
from webviz.edges.page.content.topics import message, topics, traffic
from webviz.edges.page.content.transforms import between, transforms
from webviz.edges.page.content.types import types
from webviz.edges.page.content.viewer import file, frames, graph, settings, view_type
from webviz.edges.page.content.views import view, views
from webviz.engine.state import State

MAKERS: Mapping[str, Callable[[State, str], Mapping[str, Any]]] = {
    "between": between,
    "bookmarks": bookmarks,
    "clock": clock,
    "density": density,
    "displays": displays,
    "driving": driving,
    "events": events,
    "file": file,
    "frames": frames,
    "goals": goals,
    "graph": graph,
    "handles": handles,
    "history": history,
    "legend": legend,
    "message": message,
    "panes": panes,
    "picking": picking,
    "playback": playback,
    "properties": properties,
    "rate": rate,
    "recorded": recorded,
    "recording": recording,
    "routes": routes,
    "selected": selected,
    "selection": selection,
    "settings": settings,
    "tool": tool,
    "topics": topics,
    "traffic": traffic,
    "statuses": statuses,
    "topics_of": topics_of,
    "view": view,
    "views": views,
    "transforms": transforms,
    "types": types,
    "view_type": view_type,
    "watchers": watchers,
}

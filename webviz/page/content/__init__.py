"""Contents of the page's stores, made from the state of the viewer.

One function a store: from a state, and what stands behind the colon of the store's name, to the
store, None for an empty one. It runs some times a second while a page watches, so it has to be
quick; what has not changed is not sent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from webviz.engine.state import State
from webviz.engine.store import PageStore
from webviz.page.content.clock import clock
from webviz.page.content.displays import displays, rate
from webviz.page.content.doctor import findings
from webviz.page.content.history import history
from webviz.page.content.panes import panes
from webviz.page.content.playback import bookmarks, density, events, playback, recorded
from webviz.page.content.properties import properties, statuses, topics_of
from webviz.page.content.scene import attributions, legend, watchers
from webviz.page.content.selection import picking, selected, selection
from webviz.page.content.topics import topics, traffic
from webviz.page.content.types import types
from webviz.page.content.viewer import file, frames, graph, settings, view_type
from webviz.page.content.views import view, views

MAKERS: Mapping[str, Callable[[State, str], PageStore | None]] = {
    "attributions": attributions,
    "bookmarks": bookmarks,
    "clock": clock,
    "density": density,
    "displays": displays,
    "events": events,
    "file": file,
    "findings": findings,
    "frames": frames,
    "graph": graph,
    "history": history,
    "legend": legend,
    "panes": panes,
    "picking": picking,
    "playback": playback,
    "properties": properties,
    "rate": rate,
    "recorded": recorded,
    "selected": selected,
    "selection": selection,
    "settings": settings,
    "topics": topics,
    "traffic": traffic,
    "statuses": statuses,
    "topics_of": topics_of,
    "view": view,
    "views": views,
    "types": types,
    "view_type": view_type,
    "watchers": watchers,
}

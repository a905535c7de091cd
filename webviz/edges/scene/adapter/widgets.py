"""The widgets of the panel, and viser's types of messages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import viser
from viser import _messages as wire


def message_type(kind: str) -> type[Any]:
    """viser's dataclass of a kind of messages."""
    return getattr(wire, kind)


def has_form(server: viser.ViserServer, handle_uuid: str, shared: bool = False) -> bool:
    """Whether a form of that id exists in the shared GUI or, unless `shared`, in any browser's."""
    guis = [server.gui] if shared else _guis(server)
    found = (gui._container_handle_from_uuid.get(handle_uuid) for gui in guis)
    return any(isinstance(handle, viser.GuiFormHandle) for handle in found)


def gui_input(server: viser.ViserServer, handle_uuid: str) -> Any:
    """The input widget of that id in the shared GUI or any browser's, or None."""
    for gui in _guis(server):
        handle = gui._gui_input_handle_from_uuid.get(handle_uuid)
        if handle is not None and not handle._impl.removed:
            return handle
    return None


def gui_value(handle: Any) -> Any:
    """The current value of an input widget."""
    return handle._impl.value


def gui_props(handle: Any) -> Any:
    """The properties of an input widget: min, max, options, disabled."""
    return handle._impl.props


def _guis(server: viser.ViserServer) -> Iterator[viser.GuiApi]:
    yield server.gui
    yield from (client.gui for client in server.get_clients().values())

"""Pictures beside the scene."""

from __future__ import annotations

from webviz.api.nodes import Pane
from webviz.scene.adapter import Adapter
from webviz.scene.names import display_of


class PaneDrawn:
    """A picture in the pane of its display; nothing of it is in the scene of viser."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._display = display_of(name)
        self._node: Pane | None = None
        self._is_visible = True

    def draw(self, node: Pane) -> None:
        """Show another picture."""
        self._node = node
        if self._is_visible:
            self._link.pictures.show(self._display, node)

    def set_visible(self, visible: bool) -> None:
        """Hides or shows the picture."""
        if visible == self._is_visible:
            return
        self._is_visible = visible
        if not visible:
            self.remove()
        elif self._node is not None:
            self.draw(self._node)

    def remove(self) -> None:
        """Forgets the picture."""
        self._link.pictures.remove(self._display)

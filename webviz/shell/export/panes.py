"""Pictures of panes as pages receive them."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.api.nodes import Pane
from webviz.api.pictures import Video
from webviz.server.images.encoding import factor_for, file_of
from webviz.server.images.frames import Sent, frame

WIDTH = 720
"""Pixels of a pane on the screen: of larger pictures, every second or third pixel is left out."""


class PaneTape:
    """Makes pictures of those panes that have changed."""

    def __init__(self) -> None:
        self._shown: dict[str, Pane] = {}
        self._sent: dict[str, Sent] = {}
        self._number = 0

    def take(self, panes: Mapping[str, Pane]) -> Mapping[str, tuple[bytes, bool] | None]:
        """Return new pictures, and whether each can be shown without those before.

        None if one is gone.
        """
        made: dict[str, tuple[bytes, bool] | None] = {}
        for gone in self._shown.keys() - panes.keys():
            del self._shown[gone]
            self._sent.pop(gone, None)
            made[gone] = None
        for display, pane in panes.items():
            if self._shown.get(display) is pane:
                continue
            self._shown[display] = pane
            self._number += 1
            picture, sent, file, is_whole = pane.picture, Sent(), None, True
            if isinstance(picture, Video):
                sent = self._sent.get(display, sent)
                is_whole = sent.packet < picture.packets[0].number
            else:
                file = file_of(picture, factor_for(picture, WIDTH))
            data, self._sent[display] = frame(display, self._number, pane, file, sent)
            if data:
                made[display] = data, is_whole
        return made

"""Pictures of panes as pages receive them."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.api.nodes import Pane
from webviz.api.pictures import Video
from webviz.server.images.encoding import factor_for, file_of
from webviz.server.images.frames import Sent, frame

WIDTH = 720
"""Pixels of a pane on the screen: of larger pictures, every second or third pixel is left out."""


MAX_MARKED = 30
"""Times that only the marks of a picture change, before it is written once more: a file goes
through all of them to show the last."""


class PaneTape:
    """Makes pictures of those panes that have changed."""

    def __init__(self) -> None:
        self._shown: dict[str, Pane] = {}
        self._sent: dict[str, Sent] = {}
        self._marked: dict[str, int] = {}
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
            picture, sent, file = pane.picture, self._sent.get(display, Sent()), None
            marked = self._marked.get(display, 0) + 1
            if isinstance(picture, Video):
                is_whole = sent.packet < picture.packets[0].number
            elif sent.has(picture) and marked <= MAX_MARKED:
                is_whole = False
            else:
                is_whole, sent = True, Sent()
                file = file_of(picture, factor_for(picture, WIDTH))
            self._marked[display] = 0 if is_whole else marked
            data, self._sent[display] = frame(display, self._number, pane, file, sent, False)
            if data:
                made[display] = data, is_whole
        return made

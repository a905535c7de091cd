"""Texts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from viser import LabelHandle

from webviz.api.nodes import Labels
from webviz.edges.scene.adapter import Adapter

# RViz's characters, in Liberation Sans, are 1.19 font sizes high with all that surrounds them
# (measured). A browser's font is Arial or another of that size.
_LINE = 1.19


class _Label(NamedTuple):
    """A text, where it is, and viser's properties for how it looks."""

    text: str
    position: tuple[float, float, float]
    look: dict[str, Any]


class LabelsDrawn:
    """One viser label for each text, under one frame; labels are reused in order."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._labels: list[LabelHandle] = []
        self._sent: list[_Label] = []

    def draw(self, node: Labels) -> None:
        """Sends texts, places and heights that changed; places that are not finite are left out."""
        look = {
            "font_scene_height": node.height / _LINE,
            "anchor": "top-center" if node.below else "center-center",
        }
        wanted = [
            _Label(_encodable(text), (x, y, z), look)
            for text, (x, y, z) in zip(node.texts, node.positions.tolist(), strict=True)
            if np.isfinite((x, y, z)).all()
        ]
        for label in self._labels[len(wanted) :]:
            label.remove()
        self._link.count_removals(max(0, len(self._labels) - len(wanted)))
        del self._labels[len(wanted) :], self._sent[len(wanted) :]
        for index, new in enumerate(wanted):
            if index == len(self._labels):
                self._add(index, new)
            else:
                self._change(index, self._sent[index], new)
        self._sent = wanted

    def remove(self) -> None:
        """Takes the labels off the scene."""
        self._link.count_removals(len(self._labels))
        self._frame.remove()

    def _add(self, index: int, new: _Label) -> None:
        name = f"{self._name}/{index}"
        label = self._link.server.scene.add_label(
            name, new.text, font_size_mode="scene", depth_test=True, **new.look
        )
        self._labels.append(label)
        self._link.set_position(name, new.position)

    def _change(self, index: int, old: _Label, new: _Label) -> None:
        name = f"{self._name}/{index}"
        if old.text != new.text:
            self._link.update(name, {"text": new.text})
        if old.position != new.position:
            self._link.set_position(name, new.position)
        if old.look != new.look:
            self._link.update(name, new.look)


def _encodable(text: str) -> str:
    """Half a surrogate pair, from text that was no UTF-8, would end every browser's connection."""
    return text.encode(errors="replace").decode()

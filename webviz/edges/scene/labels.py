"""Texts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from viser import LabelHandle

from webviz.api.nodes import Labels
from webviz.edges.scene.adapter import Adapter

# Line height of RViz's Liberation Sans in font sizes (measured). Browsers use Arial or a font of
# the same size.
_LINE = 1.19


class _Label(NamedTuple):
    """A text, its position, and viser's properties for its look."""

    text: str
    position: tuple[float, float, float]
    look: dict[str, Any]


class LabelsDrawn:
    """One viser label per text, under one frame; labels are reused in order."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._labels: list[LabelHandle] = []
        self._sent: list[_Label] = []

    def draw(self, node: Labels) -> None:
        """Sends changed labels; those whose position is not finite are dropped."""
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
        """Removes the labels from the scene."""
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
    """Replaces lone surrogates, from invalid UTF-8, which would end every browser's connection."""
    return text.encode(errors="replace").decode()

"""Texts."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from viser import LabelHandle

from webviz.api.nodes import U8, Labels
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
        anchor = "top-center" if node.below else "center-center"
        colors = np.broadcast_to(np.asarray(node.colors, np.uint8), (len(node.texts), 3))
        heights = _tinted(node.height / _LINE, colors)
        labels = zip(node.texts, node.positions.tolist(), heights, strict=True)
        wanted = [
            _Label(_encodable(text), (x, y, z), {"font_scene_height": height, "anchor": anchor})
            for text, (x, y, z), height in labels
            if math.isfinite(x + y + z)
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


def _tinted(height: float, colors: U8) -> list[float]:
    """A height for each colour (N, 3), whose last bits are that colour.

    viser's labels have no colour. Their height reaches the shader as a float32, which labels.js
    makes use of: five bits for each channel, which changes the height by less than 0.2 %.
    """
    red, green, blue = colors.astype(np.uint32).T >> 3
    (bits,) = np.array([height], np.float32).view(np.uint32)
    tinted = (bits & np.uint32(0xFFFF8000)) | red << 10 | green << 5 | blue
    return tinted.astype(np.uint32).view(np.float32).astype(np.float64).tolist()


def _encodable(text: str) -> str:
    """Replaces lone surrogates, from invalid UTF-8, which would end every browser's connection."""
    return text.encode(errors="replace").decode()

"""Texts."""

from __future__ import annotations

import numpy as np
from viser import LabelHandle

from webviz.nodes import Labels
from webviz.scene.adapter import Adapter

# Browsers use a system font; capitals of the usual ones are about 0.72 of the font size (Arial
# 0.716, Roboto 0.711, DejaVu Sans 0.729).
_CAPITAL = 0.72


class LabelsDrawn:
    """One viser label for each text, under one frame; labels are reused in order."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._labels: list[LabelHandle] = []
        self._sent: list[tuple[str, tuple[float, float, float], float]] = []

    def draw(self, node: Labels) -> None:
        """Sends texts, places and heights that changed; places that are not finite are left out."""
        height = node.height / _CAPITAL
        wanted = [
            (_encodable(text), (x, y, z), height)
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

    def _add(self, index: int, new: tuple[str, tuple[float, float, float], float]) -> None:
        text, position, height = new
        name = f"{self._name}/{index}"
        label = self._link.server.scene.add_label(
            name,
            text,
            font_size_mode="scene",
            font_scene_height=height,
            depth_test=True,
            anchor="center-center",
        )
        self._labels.append(label)
        self._link.set_position(name, position)

    def _change(
        self,
        index: int,
        old: tuple[str, tuple[float, float, float], float],
        new: tuple[str, tuple[float, float, float], float],
    ) -> None:
        name = f"{self._name}/{index}"
        if old[0] != new[0]:
            self._link.update(name, {"text": new[0]})
        if old[1] != new[1]:
            self._link.set_position(name, new[1])
        if old[2] != new[2]:
            self._link.update(name, {"font_scene_height": new[2]})


def _encodable(text: str) -> str:
    """Half a surrogate pair, from text that was no UTF-8, would end every browser's connection."""
    return text.encode(errors="replace").decode()

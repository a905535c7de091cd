"""Texts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from viser import LabelHandle

from webviz.api.nodes import U8, Labels, Rgb
from webviz.scene.adapter import Adapter
from webviz.scene.label_budget import MAX_LABELS
from webviz.scene.schemes import TEXT_CODE

# Line height of RViz's Liberation Sans in font sizes (measured). Browsers use Arial or a font of
# the same size.
_LINE = 1.19


class _Label(NamedTuple):
    """A text, its position, and viser's properties for its look."""

    text: str
    position: tuple[float, float, float]
    look: dict[str, Any]


class LabelsVisual:
    """One viser label per text, under one frame; labels are reused in order.

    Many are added over several flushes, and no more than `LabelBudget` allows.
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._labels: list[LabelHandle] = []
        self._shapes: list[_Label] = []
        self._texts: list[tuple[str, list[float], float]] = []
        """Texts, their positions, and heights; most of very many are never sent."""
        self._anchor = ""

    def draw(self, node: Labels) -> None:
        """Send changed labels; those whose position is not finite are dropped."""
        anchor = "top-center" if node.below else "center-center"
        texts = node.texts[:MAX_LABELS]
        heights = _marked(node.height / _LINE, node.opacity, _steps(node.colors, len(texts)))
        positions = node.positions[:MAX_LABELS]
        labels = list(zip(texts, positions.tolist(), heights, strict=True))
        finite = np.flatnonzero(np.isfinite(positions).all(axis=1))
        self._texts = [labels[index] for index in finite.tolist()]
        self._anchor = anchor
        budget = self._link.label_budget
        for index, old in enumerate(self._shapes[: len(self._texts)]):
            new = self._label(index)
            if not budget.change(old.text, new.text):
                self._remove_from(index)
                break
            self._change(index, old, new)
            self._shapes[index] = new
        self._remove_from(len(self._texts))
        self._add_more()

    def remove(self) -> None:
        """Remove the labels from the scene."""
        self._link.count_removals(len(self._labels))
        self.forget()
        self._frame.remove()

    def forget(self) -> None:
        """Give back the room of labels that go with their group."""
        budget = self._link.label_budget
        budget.leave(self._name)
        for label in self._shapes:
            budget.free(label.text)

    def _add_more(self) -> None:
        budget = self._link.label_budget
        budget.leave(self._name)
        for index in range(len(self._labels), len(self._texts)):
            new = self._label(index)
            if not budget.take(new.text):
                budget.wait(self._name, self._add_more)
                return
            self._add(index, new)
            self._shapes.append(new)

    def _label(self, index: int) -> _Label:
        text, (x, y, z), height = self._texts[index]
        look = {"font_scene_height": height, "anchor": self._anchor}
        return _Label(_encodable(text), (x, y, z), look)

    def _remove_from(self, index: int) -> None:
        for label, shape in zip(self._labels[index:], self._shapes[index:], strict=True):
            label.remove()
            self._link.label_budget.free(shape.text)
        self._link.count_removals(len(self._labels[index:]))
        del self._labels[index:], self._shapes[index:]

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


def _steps(colors: U8 | Rgb | None, count: int) -> U8:
    """Colours of so many texts in 32 steps per channel, uint8 (count, 3)."""
    if colors is None:
        return np.broadcast_to(np.array(TEXT_CODE, np.uint8), (count, 3))
    high_bits = np.asarray(colors, np.uint8) >> 3
    steps = high_bits[:count] if high_bits.ndim > 1 else np.broadcast_to(high_bits, (count, 3))
    is_code = (steps == TEXT_CODE).all(axis=1, keepdims=True)
    return np.where(is_code, np.uint8(31), steps)


def _marked(height: float, opacity: float, steps: U8) -> list[float]:
    """Return a height for each colour (N, 3) of 32 steps per channel, with it in the last bits.

    viser's labels have no colour and no opacity. Their height reaches the shader as a float32,
    which labels.js makes use of: two bits for what is missing to full opacity, in quarters, and
    five for each channel. The nearest height with these bits differs by 0.8 % at most.
    """
    red, green, blue = steps.astype(np.uint32).T
    missing = np.uint32(min(round(4 * (1.0 - opacity)), 3))
    (bits,) = np.array([height], np.float32).view(np.uint32)
    mark = missing << 15 | red << 10 | green << 5 | blue
    marked = (bits - mark + np.uint32(1 << 16)) & np.uint32(0xFFFE0000) | mark
    return marked.astype(np.uint32).view(np.float32).astype(np.float64).tolist()


def _encodable(text: str) -> str:
    """Replace lone surrogates, from invalid UTF-8, which would end every browser's connection."""
    return text.encode(errors="replace").decode()

"""Pictures: what panes beside the scene and surfaces in it show of images, as plain data.

Displays make them of messages, at hardly any cost; those of one message are equal. Pixels are
computed beside the frame loop, and only for pages that show them, at the size at which they do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images import RawImage, Tone
from webviz.data.messages.paths import FieldPath
from webviz.data.messages.tree import Tree, to_tree


@dataclass(frozen=True, eq=False)
class Pixels:
    """An image whose pixels are known.

    Args:
        image: as it was published.
        tone: how measurements become colours.
    """

    image: RawImage
    tone: Tone

    def __eq__(self, other: object) -> bool:
        """Return whether the data is the same object; its values are not compared."""
        if not isinstance(other, Pixels):
            return NotImplemented
        mine, theirs = self.image, other.image
        return mine.data is theirs.data and self.tone == other.tone

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.image.width, self.image.height


@dataclass(frozen=True, eq=False)
class Encoded:
    """An image that browsers decode.

    Args:
        mime: such as "image/jpeg".
        data: uint8 (N,).
        width, height: in pixels.
        swaps_red_and_blue: whether red and blue are in each other's place.
    """

    mime: str
    data: NDArray[np.uint8]
    width: int
    height: int
    swaps_red_and_blue: bool = False

    def __eq__(self, other: object) -> bool:
        """Return whether the data is the same object; its values are not compared."""
        if not isinstance(other, Encoded):
            return NotImplemented
        how = self.swaps_red_and_blue == other.swaps_red_and_blue
        return self.data is other.data and how

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.width, self.height


@dataclass(frozen=True, eq=False)
class Packet:
    """A part of a video.

    Args:
        number: consecutive in a video.
        data: uint8 (N,).
    """

    number: int
    data: NDArray[np.uint8]


@dataclass(frozen=True)
class Video:
    """The newest picture of a video, which browsers decode.

    Args:
        codec: "h264", "h265", "vp9" or "av1".
        packets: all since the last key frame, which is the first.
    """

    codec: str
    packets: tuple[Packet, ...]


@dataclass(frozen=True, eq=False)
class Readout:
    """The newest message of a topic as text, which is made beside the frame loop.

    Args:
        topic, type: of the message.
        message: as `webviz.data.messages.decode` returns it.
        paths: of the fields that are shown, those that exist; () for all.
        received_s: ROS time at which it came.
        digits: significant digits of numbers.
        max_items: elements of an array that are shown.
    """

    topic: str
    type: str
    message: Any
    paths: tuple[FieldPath, ...] = ()
    received_s: float = 0.0
    digits: int = 6
    max_items: int = 20

    def __eq__(self, other: object) -> bool:
        """Return whether the message is the same object; its values are not compared."""
        if not isinstance(other, Readout):
            return NotImplemented
        return self.message is other.message and self._how == other._how

    __hash__ = None  # pyright: ignore[reportAssignmentType]

    @property
    def _how(self) -> tuple[object, ...]:
        texts = [path.text for path in self.paths]
        return self.topic, self.type, texts, self.received_s, self.digits, self.max_items

    def tree(self) -> Tree:
        """Return the text; see `webviz.data.messages.to_tree`."""

        def text(value: Any) -> Tree:
            return to_tree(value, digits=self.digits, max_items=self.max_items, is_readable=True)

        if not self.paths:
            return text(self.message)
        return {"fields": {path.text: text(path(self.message)) for path in self.paths}}


Picture = Pixels | Encoded | Video | Readout


class Mark(msgspec.Struct, frozen=True, omit_defaults=True):
    """A figure over a picture; the upper left corner of the full picture is at 0, 0.

    Args:
        kind: how the points are joined: not at all, by an open or a closed line, in pairs, or by a
            circle around the first through the second; a text begins at its only point.
        points: x and y of each in pixels of the full picture.
        color: of points, lines and text, such as "#ff000080".
        colors: of each point or line in place of `color`, as far as they go.
        fill: colour inside of a closed line or circle and behind a text, "" for none.
        width: of lines and points, height of a text, in the same pixels.
        text: beside the first point, "" for none.
        about: shown while the mouse is there, "" for nothing.
    """

    kind: Literal["points", "strip", "loop", "pairs", "circle", "text"]
    points: tuple[float, ...]
    color: str
    colors: tuple[str, ...] = ()
    fill: str = ""
    width: float = 1.0
    text: str = ""
    about: str = ""


@dataclass(frozen=True, eq=False)
class Warp:
    """Distortion of an image to a camera without distortion; equal only to itself.

    Args:
        grid: float32 (R, C, 2), see `webviz.data.images.Lens.grid`.
    """

    grid: NDArray[np.float32]


@dataclass(frozen=True)
class OverlayCamera:
    """Overlay camera: a page draws the scene through it over and under a picture.

    Args:
        position, wxyz: of the optical frame's centre of projection in the fixed frame, metres and a
            unit quaternion; x to the right, y down, z ahead.
        size: width and height in pixels of what the camera sees at a zoom of 1.
        focal: focal lengths in these pixels.
        principal: principal point in these pixels; the centre of the first one is at 0, 0.
        part: left, top, right and bottom of the picture, as shares of the size.
        far: distance of the far end of what is drawn of the scene, metres.
        zoom: by how much more all is magnified than to fill the pane.
        overlay: opacity of the picture over the scene.
        is_background: whether the picture is opaque behind the scene, too.
        warp: how the picture is bent before; it then takes the whole size.
    """

    position: tuple[float, float, float]
    wxyz: tuple[float, float, float, float]
    size: tuple[int, int]
    focal: tuple[float, float]
    principal: tuple[float, float]
    part: tuple[float, float, float, float]
    far: float
    zoom: float
    overlay: float
    is_background: bool
    warp: Warp | None

"""Pictures: what panes beside the scene and surfaces in it show of images, as plain data.

Displays make them of messages, at hardly any cost; those of one message are equal. Pixels are
computed beside the frame loop, and only for pages that show them, at the size at which they do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz.data.images import RawImage, Tone


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
        """Of the same data, which is not compared."""
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
        """Of the same data, which is not compared."""
        return isinstance(other, Encoded) and self.data is other.data

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


Picture = Pixels | Encoded | Video

"""Images by any transport: what a message holds, and what has to be decompressed first."""

from __future__ import annotations

from collections.abc import Callable

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Sample
from webviz.api.pictures import Encoded
from webviz.data.images import ImageError, RawImage, decode_depth, inspect_compressed, read_png16
from webviz.data.memory import DECODING, OverBudgetError

RAW, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


class Decompression(msgspec.Struct, frozen=True):
    """An image that has to be decompressed."""

    start: Callable[[], RawImage]

    def run(self) -> RawImage:
        """Decompress it; its memory is counted while it lives.

        Raises:
            ImageError: it is broken, or takes more memory than there is.
        """
        image = self.start()
        try:
            DECODING.hold(image, image.data.nbytes)
        except OverBudgetError as error:
            raise ImageError(f"The image {error}. Remove other displays.") from None
        return image


def read(sample: Sample) -> RawImage | Encoded | Decompression:
    """Return the image of a sensor_msgs/Image or a sensor_msgs/CompressedImage.

    Raises:
        ImageError: it cannot be shown.
    """
    message = sample.message
    if sample.type != COMPRESSED:
        return RawImage.of(message)
    data = np.asarray(message.data, np.uint8)
    if "compressedDepth" in message.format:
        return Decompression(lambda: _depth(message.format, data))
    info = inspect_compressed(message.format, data)
    if info.is_16_bit:
        encoding = info.encoding if info.encoding in ("16UC1", "mono16") else "mono16"
        return Decompression(lambda: RawImage.from_values(encoding, read_png16(data)))
    return Encoded(info.mime, data, info.width, info.height, info.swaps_red_and_blue)


def _depth(format_: str, data: NDArray[np.uint8]) -> RawImage:
    return RawImage.from_values(*decode_depth(format_, data))

"""The transport compressedDepth: PNG or RVL, of millimetres or of inverse depths."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.data.images.compressed import decoding, read_png16
from webviz.data.images.errors import ImageError
from webviz.data.images.rvl import decode_rvl

HEADER = struct.Struct("<iff")
"""ConfigHeader of compressed_depth_image_transport: format, and the parameters A and B."""

_DEPTH_BYTES = 7
"""Bytes per pixel: the values, their depths, and which of them are missing."""


def decode_depth(format_: str, data: NDArray[np.uint8]) -> tuple[str, NDArray[Any]]:
    """Return the depths of a compressed depth image.

    Args:
        format_: such as "32FC1; compressedDepth png" or "16UC1; compressedDepth rvl".
        data: uint8 (N,).

    Returns:
        The encoding, and (H, W): "16UC1" with uint16 in mm, or "32FC1" with float32 in m, where NaN
        is no measurement.

    Raises:
        ImageError: it is none.
    """
    encoding, _, rest = format_.partition(";")
    encoding = encoding.strip()
    if encoding not in ("16UC1", "mono16", "32FC1"):
        raise ImageError(
            f"Unsupported depth format {format_[:40]!a}: expected 16UC1 or 32FC1 in front of "
            "'; compressedDepth'."
        )
    if len(data) <= HEADER.size:
        raise ImageError(f"The depth image has {len(data)} bytes: the publisher sends no data.")
    _, a, b = HEADER.unpack(data[: HEADER.size].tobytes())
    payload = data[HEADER.size :]
    raw = decode_rvl(payload) if "rvl" in rest else read_png16(payload)
    if encoding != "32FC1":
        return "16UC1", raw
    rows, columns = raw.shape
    with decoding(columns, rows, _DEPTH_BYTES):
        depths = raw.astype(np.float32)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            depths -= np.float32(b)
            np.divide(np.float32(a), depths, out=depths)
        depths[raw == 0] = np.nan
    return "32FC1", depths

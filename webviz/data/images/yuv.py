"""YUV to RGB by the full-range matrix of BT.601, as in JPEG files (ITU-T T.871, section 7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

U8 = NDArray[np.uint8]


def packed_to_rgb(pixels: U8, is_color_first: bool) -> U8:
    """Pixels that share their colours in pairs, such as UYVY.

    Args:
        pixels: (H, W, 2), brightness and half of a colour.
        is_color_first: UYVY, else YUYV.

    Returns:
        RGB (H, W, 3).
    """
    luma, chroma = (1, 0) if is_color_first else (0, 1)
    width = pixels.shape[1]
    # Of an odd width the last pixel has no V: it takes that of its neighbour.
    u = np.repeat(pixels[:, 0::2, chroma], 2, axis=1)[:, :width]
    odd = pixels[:, 1::2, chroma]
    v = np.repeat(odd if width > 1 else pixels[:, :1, chroma], 2, axis=1)
    v = np.pad(v, ((0, 0), (0, max(0, width - v.shape[1]))), "edge")[:, :width]
    return _rgb(pixels[..., luma], u, v)


def planes_to_rgb(luma: U8, chroma: U8, step: int, is_nv21: bool) -> U8:
    """Return a plane of brightness, and one of colours.

    Args:
        luma: (H, W).
        chroma: uint8 (N,): pairs of V, U for 2 x 2 pixels (NV21), or of U, V for each (NV24).
        step: bytes from one row of `luma` to the next.
        is_nv21: NV21, else NV24.

    Returns:
        RGB (H, W, 3).
    """
    height, width = luma.shape
    rows, columns, pitch = height, width, 2 * step
    if is_nv21:
        rows, columns, pitch = (height + 1) // 2, (width + 1) // 2, step
    # The last pair of an odd width may be cut off by the step.
    whole = np.zeros((rows, max(pitch, 2 * columns)), np.uint8)
    whole[:, :pitch] = chroma[: rows * pitch].reshape(rows, pitch)
    pairs = whole[:, : 2 * columns].reshape(rows, columns, 2)
    if is_nv21:
        pairs = np.repeat(np.repeat(pairs, 2, axis=0), 2, axis=1)[:height, :width]
    u, v = (1, 0) if is_nv21 else (0, 1)
    return _rgb(luma, pairs[..., u], pairs[..., v])


def _rgb(y: U8, u: U8, v: U8) -> U8:
    blue, red = u.astype(np.float32) - 128.0, v.astype(np.float32) - 128.0
    bright = y.astype(np.float32)
    rgb = np.empty((*y.shape, 3), np.float32)
    rgb[..., 0] = bright + 1.402 * red
    rgb[..., 1] = bright - 0.344136 * blue - 0.714136 * red
    rgb[..., 2] = bright + 1.772 * blue
    rgb += 0.5
    return np.clip(rgb, 0.0, 255.0, out=rgb).astype(np.uint8)

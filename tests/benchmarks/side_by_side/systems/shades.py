"""Colours as plain numpy code makes them."""

from __future__ import annotations

import numpy as np


def rainbow(values: np.ndarray) -> np.ndarray:
    """Colours from red to magenta: uint8 (N, 3)."""
    span = values.max() - values.min() or 1
    hues = (values - values.min()) / span * 5
    channels = np.abs((hues[:, None] + (0, 4, 2)) % 6 - 3) - 1
    return (np.clip(channels, 0, 1) * 255).astype(np.uint8)


def picture(grid: np.ndarray) -> np.ndarray:
    """White free, black occupied, grey unknown; rows from above: uint8 (H, W, 3)."""
    grey = np.where(grid < 0, 128, 255 - grid.astype(float) * 2.55).astype(np.uint8)
    return np.repeat(np.flipud(grey)[:, :, None], 3, axis=2)

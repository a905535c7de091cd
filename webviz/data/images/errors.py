"""Reasons why an image cannot be shown."""

from __future__ import annotations


class ImageError(ValueError):
    """An image cannot be read; one sentence with the cause, and the remedy if there is one."""

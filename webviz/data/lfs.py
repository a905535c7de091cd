"""Pointers that Git LFS leaves in place of files that were not fetched."""

from __future__ import annotations


def is_lfs(head: bytes) -> bool:
    """Return whether the first bytes of a file are those of a pointer of Git LFS."""
    return head.startswith(b"version https://git-lfs.github.com/spec/")

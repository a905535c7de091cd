"""Certificates of an untrusted authority."""

from __future__ import annotations

from datetime import datetime
from functools import cache
from pathlib import Path

import trustme

NAMES = ("localhost", "127.0.0.1", "robot.example", "robots.example")


@cache
def authority() -> trustme.CA:
    """Signs all of them: to make one takes half a second."""
    return trustme.CA()


def certificate(folder: Path, name: str = "robot", ends: datetime | None = None) -> Path:
    """Write NAME.pem and NAME.key; returns the former."""
    leaf = authority().issue_cert(*NAMES, not_after=ends)
    path = folder / f"{name}.pem"
    path.write_bytes(b"".join(blob.bytes() for blob in leaf.cert_chain_pems))
    leaf.private_key_pem.write_to_path(path.with_suffix(".key"))
    return path

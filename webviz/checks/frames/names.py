"""Names of frames by convention (REP 105), also with the prefix of a robot."""

from __future__ import annotations


def is_named(frame: str, *names: str) -> bool:
    """Return whether a frame has one of these names, perhaps with a prefix such as `robot1/`."""
    return any(frame == name or frame.endswith((f"/{name}", f"_{name}")) for name in names)

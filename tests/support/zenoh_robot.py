"""Robots on Zenoh for tests: a second implementation of the wire, written from its specification.

It shares no code with `webviz/sources/zenoh/`; keys of data come from pamoja-ros2, and attachments
from the engine's own serialiser.
"""

from __future__ import annotations

import pamoja.ros2 as pamoja
import zenoh.ext

from webviz.data.messages import type_hash


def robot_token(
    domain: int,
    session: str,
    kind: str,
    namespace: str,
    node: str,
    topic: str,
    type: str,
    hash: str,
    qos: str,
    ids: tuple[int, int] = (0, 1),
) -> str:
    """Return the liveliness token of an endpoint."""
    mangled = pamoja.percent_mangle
    dds = pamoja.dds_type_name(type)
    return (
        f"@ros2_lv/{domain}/{session}/{ids[0]}/{ids[1]}/{kind}/%/{mangled(namespace or '/')}/{node}"
        f"/{mangled(topic)}/{dds}/{hash}/{qos}"
    )


def robot_attachment(sequence: int, stamp_ns: int, gid: bytes) -> bytes:
    """Return the attachment of a message, of a request or of a response."""
    fields = zenoh.ext.Int64(sequence), zenoh.ext.Int64(stamp_ns), gid
    return zenoh.ext.z_serialize(fields).to_bytes()


__all__ = ["robot_attachment", "robot_token", "type_hash"]

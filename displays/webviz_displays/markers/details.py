"""Details of a selected marker."""

from __future__ import annotations

import re

import numpy as np

from webviz import Details, Hit, Pose
from webviz_displays.markers.actions import name_of
from webviz_displays.markers.faults import type_name
from webviz_displays.markers.store import Store
from webviz_displays.markers.table import FOREVER

SECOND = 1_000_000_000
_COLORFUL = re.compile(r"triangles (\d+) in ")
"""Begins the key of a node that one marker has for itself."""


def serial_of(hit: Hit) -> int | None:
    """Return the serial number of the marker that was selected, None if it cannot be told."""
    if hit.id is not None:
        return int(hit.id)
    match = _COLORFUL.match(hit.key)
    return int(match[1]) if match else None


def marker_details(store: Store, serial: int, now_ns: int) -> Details | None:
    """Return a marker by its serial number, None if it is not known any more."""
    table = store.table
    rows = np.flatnonzero(table.serials == serial)
    if not len(rows) or (key := table.keys[row := int(rows[0])]) is None:
        deletion = store.remarks.deletions.get(serial)
        return deletion and Details(
            f"Marker {name_of(deletion.key)}", {deletion.how: deletion.age(now_ns)}
        )
    record, content = table.wanted[row], table.wanted_contents[row]
    values: dict[str, object] = {
        "Namespace": key[0],
        "Id": key[1],
        "Type": type_name(int(record["type"])),
        "Frame": table.frames[row],
        "Age": f"{(now_ns - int(record['received_ns'])) / SECOND:.1f} s",
    }
    if (expires_ns := int(record["expires_ns"])) != FOREVER:
        values["Expires in"] = f"{(expires_ns - now_ns) / SECOND:.1f} s"
    if content.text:
        values["Text"] = content.text
    if content.mesh_resource:
        values["Mesh"] = content.mesh_resource
    if len(content.points):
        values["Points"] = len(content.points)
    pose = Pose(tuple(record["position"].tolist()), tuple(record["wxyz"].tolist()))
    return Details(
        f"Marker {name_of(key)}",
        values
        | {
            f"Pose in {table.frames[row] or 'the fixed frame'}": pose,
            "Scale": tuple(record["scale"].tolist()),
            "Color": ", ".join(f"{value:.3g}" for value in record["color"].tolist()),
            "Locked to its frame": bool(record["locked"]),
        },
    )

"""Scenes in Foxglove's schema as markers of ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST = 0, 1, 2, 3, 4, 5
TEXT, MESH, TRIANGLES = 9, 10, 11
DELETE_ALL = 3
LINE_LOOP, LIST_OF_LINES = 1, 2
"""Types of a LinePrimitive; the other one is a strip."""
PIXEL = 0.005
"""Metres of a pixel, for lines and texts whose size does not depend on the distance."""
WHITE = {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0}


def markers_of(update: Any) -> dict[str, Any]:
    """Return a visualization_msgs/msg/MarkerArray.

    An entity is a namespace, which is emptied first: it replaces the one of its id.
    """
    markers: list[dict[str, Any]] = []
    for deletion in update.deletions:
        name = "" if deletion.type == 1 else deletion.id
        markers.append({"action": DELETE_ALL, "ns": name})
    for entity in update.entities:
        markers.append({"action": DELETE_ALL, "ns": entity.id, "header": header(entity)})
        common = {
            "header": header(entity),
            "ns": entity.id,
            "lifetime": time_of(entity.lifetime),
            "frame_locked": entity.frame_locked,
        }
        for number, shape in enumerate(_shapes(entity)):
            markers.append({**common, "id": number, **shape})
    return {"markers": markers}


def header(message: Any) -> dict[str, Any]:
    """Return the header of a message with timestamp and frame_id."""
    return {"stamp": time_of(message.timestamp), "frame_id": message.frame_id}


def time_of(time: Any) -> dict[str, int]:
    """Return a time or duration of ROS."""
    return {"sec": min(max(time.seconds, -(2**31)), 2**31 - 1), "nanosec": max(0, time.nanos)}


def pose_of(pose: Any) -> dict[str, Any]:
    """Return a geometry_msgs/msg/Pose; a rotation that is not set is none."""
    q, p = pose.orientation, pose.position
    rotation = {"x": q.x, "y": q.y, "z": q.z, "w": q.w}
    return {
        "position": {"x": p.x, "y": p.y, "z": p.z},
        "orientation": rotation if any(rotation.values()) else {"w": 1.0},
    }


def _shapes(entity: Any) -> Iterator[dict[str, Any]]:
    for each in entity.arrows:
        length = each.shaft_length + each.head_length
        ends = [{}, {"x": length}]
        scale = {"x": each.shaft_diameter, "y": each.head_diameter, "z": each.head_length}
        yield {**_shape(ARROW, each), "scale": scale, "points": ends}
    for kind, solids in ((CUBE, entity.cubes), (SPHERE, entity.spheres)):
        for each in solids:
            yield {**_shape(kind, each), "scale": _xyz(each.size)}
    for each in entity.cylinders:  # cones have no marker of their own
        yield {**_shape(CYLINDER, each), "scale": _xyz(each.size)}
    for each in entity.lines:
        yield _line(each)
    for each in entity.triangles:
        order = _order(each)
        colors = _picked(each.colors, order, len(each.points))
        yield {
            **_shape(TRIANGLES, each),
            "scale": {"x": 1.0, "y": 1.0, "z": 1.0},
            "points": [_xyz(each.points[i]) for i in order],
            "colors": [_color(color) for color in colors],
        }
    for each in entity.texts:
        size = each.font_size * (PIXEL if each.scale_invariant else 1.0)
        yield {**_shape(TEXT, each), "scale": {"z": size}, "text": each.text}
    for each in entity.models:
        yield {
            **_shape(MESH, each),
            "scale": _xyz(each.scale),
            "color": _color(each.color) if each.override_color else WHITE,
            "mesh_use_embedded_materials": not each.override_color,
            "mesh_resource": each.url,
            "mesh_file": {"filename": _name(each.media_type), "data": each.data}
            if each.data
            else {},
        }


def _line(line: Any) -> dict[str, Any]:
    order = _order(line)
    if line.type == LINE_LOOP and order:
        order = [*order, order[0]]
    width = line.thickness * (PIXEL if line.scale_invariant else 1.0)
    colors = _picked(line.colors, order, len(line.points))
    return {
        **_shape(LINE_LIST if line.type == LIST_OF_LINES else LINE_STRIP, line),
        "scale": {"x": width},
        "points": [_xyz(line.points[i]) for i in order],
        "colors": [_color(color) for color in colors],
    }


def _order(shape: Any) -> list[int]:
    """Return the indices of the points, in the order in which they are used."""
    count = len(shape.points)
    return [i for i in shape.indices if i < count] if shape.indices else list(range(count))


def _picked(colors: Sequence[Any], order: Sequence[int], count: int) -> list[Any]:
    """Return the colours of points; none unless each point has one."""
    return [colors[i] for i in order] if len(colors) == count else []


def _shape(kind: int, shape: Any) -> dict[str, Any]:
    return {"type": kind, "pose": pose_of(shape.pose), "color": _color(shape.color)}


def _xyz(vector: Any) -> dict[str, float]:
    return {"x": vector.x, "y": vector.y, "z": vector.z}


def _color(color: Any) -> dict[str, float]:
    return {"r": color.r, "g": color.g, "b": color.b, "a": color.a}


def _name(media_type: str) -> str:
    """Return the name of a file of a media type, such as model/gltf-binary."""
    ending = {"model/gltf-binary": "glb", "model/stl": "stl", "model/vnd.collada+xml": "dae"}
    return f"model.{ending.get(media_type, media_type.rpartition('/')[2] or 'glb')}"

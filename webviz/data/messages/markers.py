"""Markers as typed classes: one, and many as arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, overload

import numpy as np
from msgspec import Struct, field
from numpy.typing import NDArray

from webviz.data.messages.geometry import (
    F64,
    NANOSECONDS,
    Duration,
    Header,
    Point,
    Pose,
    Quaternion,
    Time,
    Vector3,
    zeros,
)

F32 = NDArray[np.float32]
I32 = NDArray[np.int32]


class ColorRGBA(Struct, frozen=True):
    """std_msgs/msg/ColorRGBA, 0 to 1."""

    r: float = 0.0
    g: float = 0.0
    b: float = 0.0
    a: float = 0.0


class CompressedImage(Struct, frozen=True, eq=False):
    """sensor_msgs/msg/CompressedImage."""

    header: Header = Header()
    format: str = ""
    data: NDArray[np.uint8] = zeros(np.uint8)


class MeshFile(Struct, frozen=True, eq=False):
    """visualization_msgs/msg/MeshFile."""

    filename: str = ""
    data: NDArray[np.uint8] = zeros(np.uint8)


NO_TEXTURE = CompressedImage()
NO_FILE = MeshFile()


class Marker(Struct, frozen=True, eq=False):
    """visualization_msgs/msg/Marker."""

    ARROW: ClassVar[int] = 0
    CUBE: ClassVar[int] = 1
    SPHERE: ClassVar[int] = 2
    CYLINDER: ClassVar[int] = 3
    LINE_STRIP: ClassVar[int] = 4
    LINE_LIST: ClassVar[int] = 5
    CUBE_LIST: ClassVar[int] = 6
    SPHERE_LIST: ClassVar[int] = 7
    POINTS: ClassVar[int] = 8
    TEXT_VIEW_FACING: ClassVar[int] = 9
    MESH_RESOURCE: ClassVar[int] = 10
    TRIANGLE_LIST: ClassVar[int] = 11
    ARROW_STRIP: ClassVar[int] = 12

    ADD: ClassVar[int] = 0
    MODIFY: ClassVar[int] = 0
    DELETE: ClassVar[int] = 2
    DELETEALL: ClassVar[int] = 3

    header: Header = Header()
    ns: str = ""
    id: int = 0
    type: int = 0
    action: int = 0
    pose: Pose = Pose()
    scale: Vector3 = Vector3()
    color: ColorRGBA = ColorRGBA()
    lifetime: Duration = Duration()
    frame_locked: bool = False
    points: F64 = zeros(np.float64, 0, 3)
    colors: F32 = zeros(np.float32, 0, 4)
    texture_resource: str = ""
    texture: CompressedImage = NO_TEXTURE
    uv_coordinates: F32 = zeros(np.float32, 0, 2)
    text: str = ""
    mesh_resource: str = ""
    mesh_file: MeshFile = NO_FILE
    mesh_use_embedded_materials: bool = False


class Content(Struct, frozen=True, eq=False):
    """The fields of a marker whose size varies.

    Attributes:
        points: (N, 3) float64, metres.
        colors: (N, 4) float32, RGBA, 0 to 1.
        uv_coordinates: (N, 2) float32.
    """

    points: F64 = zeros(np.float64, 0, 3)
    colors: F32 = zeros(np.float32, 0, 4)
    texture_resource: str = ""
    texture: CompressedImage = NO_TEXTURE
    uv_coordinates: F32 = zeros(np.float32, 0, 2)
    text: str = ""
    mesh_resource: str = ""
    mesh_file: MeshFile = NO_FILE


NOTHING = Content()
"""Content of markers that are only a shape; compare with `is`."""


@dataclass(frozen=True, eq=False)
class MarkerSequence(Sequence[Marker]):
    """A `visualization_msgs/Marker[]`: N markers as arrays, which can also be indexed and iterated.

    Attributes:
        frame_ids: N names of frames.
        stamps_ns: (N,) int64, nanoseconds.
        namespaces: N texts.
        ids, types, actions: (N,) int32.
        positions: (N, 3) float64, metres.
        orientations: (N, 4) float64, xyzw, as sent (not normalised).
        scales: (N, 3) float64.
        colors: (N, 4) float32, RGBA, 0 to 1.
        lifetimes_ns: (N,) int64, nanoseconds.
        frame_locked, own_materials: (N,) bool; the second is `mesh_use_embedded_materials`.
        contents: the other fields, `NOTHING` if all of them are empty.
    """

    frame_ids: list[str]
    stamps_ns: NDArray[np.int64]
    namespaces: list[str]
    ids: I32
    types: I32
    actions: I32
    positions: F64
    orientations: F64
    scales: F64
    colors: F32
    lifetimes_ns: NDArray[np.int64]
    frame_locked: NDArray[np.bool_]
    own_materials: NDArray[np.bool_]
    contents: list[Content]

    @staticmethod
    def of(markers: Iterable[Marker]) -> MarkerSequence:
        """Single markers as a sequence."""
        each = list(markers)
        poses = [m.pose for m in each]

        def array(rows: list[Any], dtype: Any, *shape: int) -> Any:
            return np.array(rows, dtype).reshape(len(each), *shape)

        return MarkerSequence(
            [m.header.frame_id for m in each],
            array([m.header.stamp_ns for m in each], np.int64),
            [m.ns for m in each],
            array([m.id for m in each], np.int32),
            array([m.type for m in each], np.int32),
            array([m.action for m in each], np.int32),
            array([(p.position.x, p.position.y, p.position.z) for p in poses], np.float64, 3),
            array([(q.x, q.y, q.z, q.w) for q in (p.orientation for p in poses)], np.float64, 4),
            array([(m.scale.x, m.scale.y, m.scale.z) for m in each], np.float64, 3),
            array([(m.color.r, m.color.g, m.color.b, m.color.a) for m in each], np.float32, 4),
            array([m.lifetime.ns for m in each], np.int64),
            array([m.frame_locked for m in each], np.bool_),
            array([m.mesh_use_embedded_materials for m in each], np.bool_),
            [content_of(m) for m in each],
        )

    def __len__(self) -> int:
        return len(self.ids)

    @overload
    def __getitem__(self, index: int) -> Marker: ...
    @overload
    def __getitem__(self, index: slice) -> list[Marker]: ...
    def __getitem__(self, index: int | slice) -> Marker | list[Marker]:
        if isinstance(index, slice):
            return [self[each] for each in range(*index.indices(len(self)))]
        content = self.contents[index]
        return Marker(
            Header(Time(*divmod(int(self.stamps_ns[index]), NANOSECONDS)), self.frame_ids[index]),
            self.namespaces[index],
            int(self.ids[index]),
            int(self.types[index]),
            int(self.actions[index]),
            Pose(
                Point(*self.positions[index].tolist()),
                Quaternion(*self.orientations[index].tolist()),
            ),
            Vector3(*self.scales[index].tolist()),
            ColorRGBA(*self.colors[index].tolist()),
            Duration(*divmod(int(self.lifetimes_ns[index]), NANOSECONDS)),
            bool(self.frame_locked[index]),
            content.points,
            content.colors,
            content.texture_resource,
            content.texture,
            content.uv_coordinates,
            content.text,
            content.mesh_resource,
            content.mesh_file,
            bool(self.own_materials[index]),
        )


class MarkerArray(Struct, frozen=True, eq=False):
    """visualization_msgs/msg/MarkerArray."""

    markers: MarkerSequence = field(default_factory=lambda: MarkerSequence.of(()))


def content_of(marker: Marker) -> Content:
    """Return the fields of a marker whose size varies."""
    if (
        not len(marker.points)
        and not len(marker.colors)
        and not len(marker.uv_coordinates)
        and not len(marker.mesh_file.data)
        and not len(marker.texture.data)
        and not (marker.text or marker.mesh_resource or marker.texture_resource)
        and not (marker.mesh_file.filename or marker.texture.format)
        and marker.texture.header == Header()
    ):
        return NOTHING
    return Content(*(getattr(marker, name) for name in Content.__struct_fields__))

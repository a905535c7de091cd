"""Binary glTF 2.0: written from plain arrays, recoloured without touching the geometry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.api.nodes import F32, U8, Rgb
from webviz.data.gltf import Buffer, pack, pack_with, unpack

OPAQUE = 0.9998
"""Alphas from this value on are drawn opaque, as in RViz."""


@dataclass(frozen=True)
class Surface:
    """Appearance of a part.

    Args:
        rgba: 0 to 1, sRGB; multiplies texture and vertex colours.
        texture: PNG or JPEG bytes.
        is_clear: whether texture or vertex colours have an alpha of their own, which is blended;
            such a part shows both of its sides.
    """

    rgba: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: bytes | None = None
    is_clear: bool = False


@dataclass(frozen=True)
class MeshPart:
    """Triangles of one surface.

    Args:
        vertices: float32 (N, 3), metres.
        faces: uint32 (M, 3), counter-clockwise seen from outside.
        surface: None if the mesh file does not define one.
        normals: float32 (N, 3), unit length.
        uvs: float32 (N, 2), v upwards from the lower edge of the picture.
        colors: uint8 (N, 4), sRGB.
    """

    vertices: F32
    faces: NDArray[np.uint32]
    surface: Surface | None = None
    normals: F32 | None = None
    uvs: F32 | None = None
    colors: U8 | None = None


@dataclass(frozen=True)
class MeshContent:
    """The content of a mesh file, in metres.

    Args:
        parts: at least one, none of them empty.
        warnings: sentences, such as textures that were not found.
    """

    parts: tuple[MeshPart, ...]
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class PictureFile:
    """A picture as PNG or JPEG.

    Args:
        data: the file.
    """

    data: bytes


def write_glb(parts: Sequence[MeshPart]) -> bytes:
    """One mesh of several parts as a binary glTF; a part without a surface is white."""
    writer = _Writer()
    primitives = [writer.primitive(part) for part in parts]
    return writer.buffer.packed(primitives, materials=writer.materials, **writer.more)


def glb_with(data: bytes, alpha: float | None = None, color: Rgb | None = None) -> bytes:
    """Return a binary glTF with another opacity or colour; the geometry is unchanged.

    Args:
        data: binary glTF.
        alpha: 0 to 1, multiplies each material's own.
        color: replaces colours, textures and vertex colours of all parts.

    Raises:
        ValueError: `data` is not a binary glTF.
    """
    document, rest = unpack(data)
    for material in document.setdefault("materials", [{}]):
        pbr = material.setdefault("pbrMetallicRoughness", {})
        r, g, b, a = pbr.get("baseColorFactor", (1.0, 1.0, 1.0, 1.0))
        if color is not None:
            r, g, b = srgb_to_linear(np.array(color) / 255.0).tolist()
            pbr.pop("baseColorTexture", None)
            for key in ("emissiveFactor", "emissiveTexture", "normalTexture"):
                material.pop(key, None)
        if alpha is not None:
            a *= alpha
        pbr["baseColorFactor"] = (r, g, b, a)
        if a < OPAQUE:
            material |= {"alphaMode": "BLEND", "doubleSided": False}
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            primitive.setdefault("material", 0)
            if color is not None:
                primitive["attributes"].pop("COLOR_0", None)
    return pack(document, rest)


def glb_parts(data: bytes) -> tuple[bytes, ...]:
    """Return the parts of a binary glTF, each as one of its own, with one mesh of one material.

    Args:
        data: as written by `write_glb` or `glb_with`.

    Raises:
        ValueError: `data` is not a binary glTF.
    """
    document, rest = unpack(data)
    primitives = [part for mesh in document.get("meshes", []) for part in mesh["primitives"]]
    if len(primitives) <= 1:
        return (data,)
    return tuple(_part(document, rest[8:], primitive) for primitive in primitives)


def _part(document: dict[str, Any], binary: bytes, primitive: dict[str, Any]) -> bytes:
    """One primitive with the data that it uses, and all materials and textures."""
    used = [*primitive["attributes"].values(), primitive["indices"]]
    accessors = [dict(document["accessors"][index]) for index in used]
    images = [dict(image) for image in document.get("images", [])]
    views, chunks = [], []
    for holder in (*accessors, *images):
        view = document["bufferViews"][holder["bufferView"]]
        begin, size = view.get("byteOffset", 0), view["byteLength"]
        holder["bufferView"] = len(views)
        views.append({**view, "byteOffset": sum(map(len, chunks))})
        chunks.append(binary[begin : begin + size] + bytes(-size % 4))
    names = list(primitive["attributes"])
    one = {
        **primitive,
        "attributes": {name: number for number, name in enumerate(names)},
        "indices": len(names),
    }
    parts = {"accessors": accessors, "bufferViews": views, "meshes": [{"primitives": [one]}]}
    parts |= {"images": images} if images else {}
    return pack_with({**document, **parts}, b"".join(chunks))


def srgb_to_linear(srgb: NDArray[np.floating]) -> NDArray[np.floating]:
    """Linear light 0 to 1 from sRGB 0 to 1 (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def linear_to_srgb(linear: NDArray[np.floating]) -> NDArray[np.floating]:
    """sRGB 0 to 1 from linear light 0 to 1 (IEC 61966-2-1)."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


class _Writer:
    """Collects the parts of one file."""

    def __init__(self) -> None:
        self.buffer = Buffer()
        self.materials: list[dict[str, Any]] = []
        self.more: dict[str, list[dict[str, Any]]] = {}
        """Images and textures, if there are any."""
        self._surfaces: dict[Surface, int] = {}
        self._textures: dict[bytes, int] = {}

    def primitive(self, part: MeshPart) -> dict[str, Any]:
        attributes = {"POSITION": self.buffer.add(part.vertices, bounds=True)}
        if part.normals is not None:
            attributes["NORMAL"] = self.buffer.add(part.normals)
        if part.uvs is not None:
            # glTF counts v from the upper edge.
            u, v = part.uvs.T
            attributes["TEXCOORD_0"] = self.buffer.add(np.stack((u, 1.0 - v), axis=1))
        if part.colors is not None:
            linear = part.colors / 255.0
            linear[:, :3] = srgb_to_linear(linear[:, :3])
            attributes["COLOR_0"] = self.buffer.add(linear.astype(np.float32))
        return {
            "attributes": attributes,
            "indices": self.buffer.add(part.faces),
            "material": self._material(part.surface or Surface()),
        }

    def _material(self, surface: Surface) -> int:
        if surface not in self._surfaces:
            r, g, b = srgb_to_linear(np.array(surface.rgba[:3])).tolist()
            pbr: dict[str, Any] = {
                "baseColorFactor": (r, g, b, surface.rgba[3]),
                "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            }
            if surface.texture is not None:
                pbr["baseColorTexture"] = {"index": self._texture(surface.texture)}
            is_opaque = surface.rgba[3] >= OPAQUE
            # Transparent shapes show their front only, as in RViz, not their inside.
            is_double_sided = is_opaque or surface.is_clear
            material: dict[str, Any] = {"pbrMetallicRoughness": pbr, "doubleSided": is_double_sided}
            if not is_opaque or surface.is_clear:
                material["alphaMode"] = "BLEND"
            self._surfaces[surface] = len(self._surfaces)
            self.materials.append(material)
        return self._surfaces[surface]

    def _texture(self, image: bytes) -> int:
        if image not in self._textures:
            mime = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
            index = len(self._textures)
            self._textures[image] = index
            view = self.buffer.add_bytes(image)
            self.more.setdefault("images", []).append({"bufferView": view, "mimeType": mime})
            self.more.setdefault("textures", []).append({"source": index})
        return self._textures[image]

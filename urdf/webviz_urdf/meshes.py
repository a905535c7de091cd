"""Mesh files as parts: arrays in metres, with the file's own materials."""

from __future__ import annotations

import io
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from collada import Collada
from collada.common import DaeError
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]
from PIL import Image
from trimesh.visual.material import PBRMaterial, SimpleMaterial

from webviz.api.nodes import U8
from webviz_urdf.files import read_file
from webviz_urdf.glb import MeshContent, MeshPart, Surface, linear_to_srgb
from webviz_urdf.resolve import Resolver
from webviz_urdf.textures import TextureFolder, encode

HEADER, TRIANGLE = 84, 50
"""Bytes of the header with its count, and of each triangle."""
TEXT_BYTES = 1000
"""Bytes in which an ASCII file has its first facet, and no zeros."""
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""Marks of an encoding that has NULs itself."""


def whole_stl(data: bytes) -> bytes:
    """Return an STL file whose count of triangles fits its size.

    Bytes behind the triangles are dropped, and a count of zero is that of the bytes, since some
    exporters write it before they know it.

    Raises:
        ValueError: a binary file was cut off.
    """
    if len(data) < HEADER or _is_text(data):
        return data
    (count,) = struct.unpack_from("<I", data, HEADER - 4)
    room = (len(data) - HEADER) // TRIANGLE
    if count > room:
        raise ValueError(f"it is cut off after {room} of {count} triangles")
    count = count or room
    return data[: HEADER - 4] + struct.pack("<I", count) + data[HEADER : HEADER + TRIANGLE * count]


def _is_text(data: bytes) -> bool:
    start = data[:TEXT_BYTES]
    return b"\0" not in start and b"facet" in start.lower()


def only_xml(data: bytes) -> bytes:
    """Return a COLLADA file without white space before its declaration and text after a NUL.

    Exporters leave both behind; XML forbids them, and Assimp, and so RViz, tolerates them.
    """
    return data.partition(b"\0")[0].lstrip() if not data.startswith(_UTF_16) else data


def without_broken_materials(data: bytes) -> tuple[bytes, list[str]]:
    """Return a COLLADA file without references to materials that it does not define.

    pycollada drops a body entirely when one of its materials refers to a missing picture or
    effect, which some exporters leave behind; Assimp, and so RViz, draws it.

    Returns:
        The file, and the ids of the removed materials.
    """
    document = Collada(io.BytesIO(data), ignore=[DaeError])
    defined = {material.id for material in document.materials}
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    root = etree.fromstring(data, parser)
    broken = []
    for binding in root.findall(".//{*}instance_material"):
        material = binding.get("target", "").lstrip("#")
        if material not in defined:
            broken.append(material)
            binding.getparent().remove(binding)
    return etree.tostring(root), sorted(set(broken))


Scale = tuple[float, float, float]

MAX_BYTES = 128 << 20
"""Limit in bytes of a mesh file; a larger one is refused rather than stalling the viewer."""

MAX_TRIANGLES = 2_000_000
"""Largest number of triangles of a mesh file, five times as many as the most detailed public robots
have in total."""

FORMATS = ("dae", "stl", "obj", "ply", "off", "glb", "gltf")
"""No archives, which can expand to any size."""
GLTF = ("glb", "gltf")
Z_UP = np.array(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)), np.float64)
"""Turns the up axis of glTF, y (glTF 2.0, section 3.4), to z, as RViz does since ros2/rviz#1482."""


class MeshError(Exception):
    """A mesh cannot be drawn; the text is one sentence that says why."""


def read_mesh(path: Path, resolver: Resolver) -> MeshContent:
    """Read a mesh file of one of `FORMATS`.

    A COLLADA file's unit is applied and its up axis is not, as in RViz, which makes Assimp
    ignore it; that of glTF is. Faces keep the shading of the file.

    Raises:
        MeshError: it cannot be read, has no triangles or too many, or is an archive.
        MemoryError: it needs more memory than there is.
    """
    _check_format(path)
    try:
        data = read_file(path, MAX_BYTES)
    except OSError as error:
        raise MeshError(f"{path} cannot be read: {error.strerror or error}.") from error
    return parse_mesh(data, path, resolver)


def parse_mesh(data: bytes, path: Path, resolver: Resolver) -> MeshContent:
    """Read the content of a mesh file; see `read_mesh`.

    Args:
        data: the content.
        path: gives the format, and the folder of its textures.
        resolver: finds textures.

    Raises:
        MeshError: see `read_mesh`.
    """
    suffix = _check_format(path)
    textures = TextureFolder(path.parent, resolver)
    try:
        parts, broken = _read(data, suffix, textures)
    except OSError as error:
        raise MeshError(f"{path} cannot be read: {error.strerror or error}.") from error
    except MemoryError:
        raise
    except Exception as error:
        # Third-party parsers raise any exception for a broken file; lxml also for want of memory.
        if "memory" in str(error).lower():
            raise MemoryError from error
        raise MeshError(f"{path} cannot be read as a mesh: {_one_line(error)}.") from error
    if not parts:
        raise MeshError(f"{path} has no triangles.")
    triangles = sum(len(part.faces) for part in parts)
    if triangles > MAX_TRIANGLES:
        raise MeshError(
            f"{path} has {triangles} triangles; the limit is {MAX_TRIANGLES}. Simplify the mesh."
        )
    warnings = [
        f"'{name}', which {path} names, is not drawn. {reason}"
        for name, reason in textures.refused.items()
    ]
    warnings += [f"Material '{name}' of {path} is not completely defined." for name in broken]
    return MeshContent(tuple(parts), tuple(warnings))


def _check_format(path: Path) -> str:
    suffix = path.suffix.lower().lstrip(".")
    if suffix not in FORMATS:
        raise MeshError(
            f"{path} has the unsupported mesh format '.{suffix}'. "
            f"Convert it to one of {', '.join(FORMATS)}."
        )
    return suffix


def _read(data: bytes, suffix: str, textures: TextureFolder) -> tuple[list[MeshPart], list[str]]:
    """Return the file's parts, and the ids of materials that could not be used."""
    if suffix == "stl":
        data = whole_stl(data)
    if suffix != "dae":
        return _parts(data, suffix, textures), []
    data = only_xml(data)
    parts = _parts(data, suffix, textures)
    if len(parts) >= data.count(b"<instance_geometry"):
        return parts, []
    data, broken = without_broken_materials(data)
    return (_parts(data, suffix, textures) if broken else parts), broken


def scaled(part: MeshPart, scale: Scale) -> MeshPart:
    """`part` multiplied along x, y, z; faces of a mirrored one are reversed."""
    if scale == (1.0, 1.0, 1.0):
        return part
    factors = np.array(scale, np.float32)
    normals = part.normals
    if normals is not None:
        # Normals scale by the inverse; those of a flattened mesh are meaningless.
        normals = _unit(normals / factors) if factors.all() else None
    mirrored = np.prod(np.sign(factors)) < 0
    faces = np.ascontiguousarray(part.faces[:, ::-1]) if mirrored else part.faces
    return replace(part, vertices=part.vertices * factors, faces=faces, normals=normals)


@np.errstate(all="ignore")
def _parts(data: bytes, suffix: str, textures: TextureFolder) -> list[MeshPart]:
    # What overflows on the way, within trimesh, too, is found by its result.
    scene = trimesh.load_scene(io.BytesIO(data), suffix, resolver=textures, process=False)
    parts = []
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):
            unit = _unit_metres(mesh) if suffix == "dae" else 1.0
            place = np.asarray(transform, np.float64)
            if suffix in GLTF:
                place = Z_UP @ place
            parts.append(_part(mesh, place, unit, is_gltf=suffix in GLTF))
    return parts


def _part(mesh: trimesh.Trimesh, transform: np.ndarray, unit: float, *, is_gltf: bool) -> MeshPart:
    """Return the mesh in the scene's frame, in metres."""
    exact, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    linear, is_moved = transform[:3, :3], not np.array_equal(transform, np.eye(4))
    if is_moved:
        exact = exact @ linear.T + transform[:3, 3]
    vertices = exact.astype(np.float32) if unit == 1.0 else (exact * unit).astype(np.float32)
    if not np.isfinite(vertices).all():
        raise ValueError("a vertex is not finite, or too far away")
    surface, uvs = _surface(mesh, is_gltf=is_gltf)
    colors = _vertex_colors(mesh, is_linear=is_gltf)
    # trimesh has no public way to ask whether the file gave normals; without, it computes some.
    normals = mesh._cache.cache.get("vertex_normals")
    if normals is None:
        # Flat facets, as RViz draws a file without normals: every facet has its own corners.
        corners = faces.reshape(-1)
        vertices = vertices[corners]
        faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
        uvs = None if uvs is None else uvs[corners]
        colors = None if colors is None else colors[corners]
    if is_moved:
        if np.linalg.det(linear) < 0.0:
            faces = faces[:, ::-1]
        if normals is not None:
            normals = normals @ np.linalg.pinv(linear)
    return MeshPart(
        vertices,
        np.ascontiguousarray(faces, np.uint32),
        surface or (Surface() if colors is not None else None),
        None if normals is None else _unit(np.asarray(normals, np.float32)),
        uvs,
        colors,
    )


def _unit_metres(mesh: trimesh.Trimesh) -> float:
    """COLLADA's `<unit meter>`, which trimesh stores as "0.0254 * meters" but does not apply."""
    factor, _, name = (mesh.units or "meters").partition(" * ")
    return float(factor) if name else 1.0


def _surface(mesh: trimesh.Trimesh, *, is_gltf: bool) -> tuple[Surface | None, np.ndarray | None]:
    """Return the file's own material, None if it has none, and texture coordinates."""
    visual: Any = mesh.visual
    if visual.kind != "texture":
        return None, None
    uvs = None if visual.uv is None else np.asarray(visual.uv, np.float32)
    material = visual.material
    if isinstance(material, PBRMaterial):
        if is_gltf:
            return _gltf_surface(material, has_uvs=uvs is not None), uvs
        # trimesh has these for COLLADA, too, whose colours are sRGB.
        factor, image = material.baseColorFactor, material.baseColorTexture
    elif isinstance(material, SimpleMaterial) and material.kwargs:
        factor, image = material.diffuse, material.image
    else:  # trimesh's placeholder for texture coordinates without a material
        return None, uvs
    r, g, b, a = (1.0,) * 4 if factor is None else (float(v) / 255.0 for v in factor)
    if image is not None and uvs is not None:
        r = g = b = 1.0
        return Surface((r, g, b, a or 1.0), encode(image)), uvs
    # Exporters that confuse COLLADA's opaque modes write 0 for a solid body.
    return Surface((r, g, b, a or 1.0)), uvs


def _gltf_surface(material: PBRMaterial, *, has_uvs: bool) -> Surface:
    """Return the surface of a material of glTF 2.0, section 3.9.

    The factor of its colour is linear light, and alpha counts if its mode is BLEND only; those of
    MASK are drawn as solid.
    """
    factor, image = material.baseColorFactor, material.baseColorTexture
    is_clear = material.alphaMode == "BLEND"
    rgba = np.ones(4) if factor is None else np.asarray(factor, np.float64) / 255.0
    alpha = float(rgba[3]) if is_clear else 1.0
    if image is not None and has_uvs:
        opaque = image if is_clear else _without_alpha(image)
        return Surface((1.0, 1.0, 1.0, alpha), encode(opaque))
    r, g, b = linear_to_srgb(rgba[:3]).tolist()
    return Surface((r, g, b, alpha))


def _without_alpha(image: Image.Image) -> Image.Image:
    plain = image.convert("RGB")
    plain.format = image.format  # by which it is encoded
    return plain


def _vertex_colors(mesh: trimesh.Trimesh, *, is_linear: bool) -> U8 | None:
    visual: Any = mesh.visual
    if visual.kind not in ("vertex", "face"):
        return None
    colors = np.array(visual.vertex_colors, np.uint8)
    if is_linear:
        shares = colors[:, :3] / 255.0
        colors[:, :3] = np.rint(255.0 * linear_to_srgb(shares))
    return colors


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Each row at length 1; zero and non-finite rows become +z."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    good = np.isfinite(length) & (length > 0.0)
    return np.where(good, vectors / np.where(good, length, 1.0), (0.0, 0.0, 1.0)).astype(np.float32)


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split())
    return (text or type(error).__name__)[:200].rstrip(".")

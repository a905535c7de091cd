"""Pictures that meshes and materials name."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image
from trimesh.resolvers import Resolver as TrimeshResolver

from webviz_urdf.resolve import ResolveError, Resolver

MAX_EDGE = 4096
"""Pixels; larger pictures are shrunk, since browsers refuse much more."""


class TextureFolder(TrimeshResolver):
    """Finds what a mesh file names: by URI, beside the mesh, or by its bare file name there.

    Args:
        folder: that of the mesh.
        resolver: for `package://` and `file://`.
    """

    def __init__(self, folder: Path, resolver: Resolver) -> None:
        self._resolver = resolver.relative_to(folder)
        self.not_found: dict[str, None] = {}

    def get(self, key: str) -> bytes:
        """Content of the file `key`.

        Raises:
            ResolveError: it is not found; `not_found` then has it.
        """
        # Exporters on Windows write backslashes, and absolute paths of the author's machine.
        plain = key.replace("\\", "/")
        for candidate in (key, plain, plain.rpartition("/")[2]):
            try:
                path = self._resolver.resolve(candidate)
            except ResolveError:
                continue
            return path.read_bytes()
        self.not_found[key] = None
        raise ResolveError(f"There is no file '{key}'.")

    def keys(self) -> list[str]:
        """Nothing is listed: files are looked up by name only."""
        return []

    def write(self, name: str, data: bytes) -> None:
        """Never writes."""
        raise PermissionError(name)

    def namespaced(self, namespace: str) -> TextureFolder:
        """The resolver for files below the folder `namespace`."""
        return TextureFolder((self._resolver.base or Path()) / namespace, self._resolver)


def open_image(path: Path) -> Image.Image:
    """The picture at `path`.

    Raises:
        OSError: it is no picture.
    """
    with Image.open(path) as image:
        image.load()
        return image


def encode(image: Image.Image) -> bytes:
    """PNG, or JPEG for a picture that came as one, as glTF allows."""
    data = io.BytesIO()
    is_jpeg = image.format == "JPEG"
    if max(image.size) > MAX_EDGE:
        image = image.copy()
        image.thumbnail((MAX_EDGE, MAX_EDGE))
    if is_jpeg:
        image.convert("RGB").save(data, "JPEG", quality=95)
    else:
        has_alpha = "A" in image.getbands() or "transparency" in image.info
        image.convert("RGBA" if has_alpha else "RGB").save(data, "PNG", compress_level=1)
    return data.getvalue()


def mean_color(image: Image.Image) -> tuple[float, float, float]:
    """Average sRGB colour 0 to 1, for surfaces that have no texture coordinates."""
    r, g, b = image.convert("RGB").resize((1, 1), Image.Resampling.BOX).getpixel((0, 0))  # pyright: ignore[reportGeneralTypeIssues]
    return r / 255.0, g / 255.0, b / 255.0

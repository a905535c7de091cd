"""Textures of meshes and materials."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

from PIL import Image, UnidentifiedImageError
from trimesh.resolvers import Resolver as TrimeshResolver

from webviz.data.images import ImageError, read_header
from webviz_urdf.files import read_file
from webviz_urdf.resolve import ResolveError, Resolver

MAX_EDGE = 4096
"""Pixels; larger pictures are scaled down, because browsers limit the size of textures."""

MAX_PIXELS = 8192**2
"""Largest number of pixels of a picture; a larger one is refused before it is decoded."""

MAX_BYTES = 64 << 20
"""Limit in bytes of a picture's file."""

_FORMATS = ("PNG", "JPEG", "TGA", "TIFF", "BMP", "GIF", "WEBP", "DDS", "PPM")


class TextureError(Exception):
    """A picture cannot be drawn; the text says why, in one or two sentences."""


_MAP_OPTIONS = {
    **dict.fromkeys(("-blendu", "-blendv", "-boost", "-texres", "-clamp", "-bm"), 1),
    **dict.fromkeys(("-imfchan", "-type", "-cc"), 1),
    "-mm": 2,
    **dict.fromkeys(("-o", "-s", "-t"), 3),
}
"""Most values of each option of a texture map in MTL; the first is always there."""


class TextureFolder(TrimeshResolver):
    """Finds the files that a mesh names: by URI, or next to the mesh by path or bare name.

    Args:
        folder: that of the mesh.
        resolver: for `package://` and `file://`.
    """

    def __init__(self, folder: Path, resolver: Resolver) -> None:
        self._resolver = resolver.relative_to(folder)
        self.refused: dict[str, str] = {}
        """Sentences by name: why a file cannot be used."""

    def get(self, key: str) -> bytes:
        """Content of the file `key`.

        Raises:
            ResolveError: it cannot be used; `refused` has the reason.
        """
        reason = ""
        name = without_options(key)
        # Exporters on Windows write backslashes, and absolute paths of the author's machine.
        plain = name.replace("\\", "/")
        for candidate in (name, plain, plain.rpartition("/")[2]):
            try:
                return self._read(self._resolver.resolve(candidate))
            except (ResolveError, TextureError) as error:
                reason = reason or str(error)
        self.refused[name] = reason
        raise ResolveError(reason)

    def _read(self, path: Path) -> bytes:
        """Content of a picture, or of another part of a mesh such as a material library."""
        try:
            data = read_file(path, MAX_BYTES)
        except OSError as error:
            raise TextureError(f"{path} cannot be read: {error.strerror}.") from error
        with contextlib.suppress(UnidentifiedImageError):
            _open(path, data).close()
        return data

    def keys(self) -> list[str]:
        """Empty: files are only looked up by name."""
        return []

    def write(self, name: str, data: bytes) -> None:
        """Never writes."""
        raise PermissionError(name)

    def namespaced(self, namespace: str) -> TextureFolder:
        """Return the resolver for files below the folder `namespace`."""
        return TextureFolder((self._resolver.base or Path()) / namespace, self._resolver)


def without_options(name: str) -> str:
    """Return the file of a map of an MTL file, which may have options before it.

    They place and scale the texture (Wavefront's MTL, "Options for texture map statements") and are
    ignored, as by RViz.
    """
    words = name.split(" ")
    while len(words) > 1 and (most := _MAP_OPTIONS.get(words[0].lower())):
        del words[0]
        for index in range(most):
            if len(words) < 2 or (index and not _is_number(words[0])):
                break
            del words[0]
    return " ".join(words)


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def open_image(path: Path) -> Image.Image:
    """Return the picture at `path`.

    Raises:
        TextureError: it cannot be read, is not a picture, or has too many pixels.
    """
    try:
        data = read_file(path, MAX_BYTES)
    except OSError as error:
        raise TextureError(f"{path} cannot be read: {error.strerror or error}.") from error
    return parse_image(data, path)


def parse_image(data: bytes, path: Path) -> Image.Image:
    """Return the picture whose file has this content; `path` is its name.

    Raises:
        TextureError: it is not a picture, or has too many pixels.
    """
    try:
        with _open(path, data) as image:
            image.load()
            return image
    except UnidentifiedImageError as error:
        raise TextureError(f"{path} is not a readable picture.") from error
    except (OSError, ValueError, SyntaxError, Warning) as error:
        reason = getattr(error, "strerror", None) or error
        raise TextureError(f"{path} is not a readable picture: {reason}.") from error


def _open(path: Path, data: bytes) -> Image.Image:
    """Return a picture of acceptable size, of which only the header was decoded."""
    with contextlib.suppress(ImageError):  # Pillow says what is wrong with it
        if header := read_header(memoryview(data)):
            _check_size(path, *header.size)  # of large ones Pillow warns, and not this thread alone
    try:
        image = Image.open(io.BytesIO(data), formats=_FORMATS)
    except (Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise TextureError(f"{path} has more than {_megapixels(MAX_PIXELS)}.") from error
    _check_size(path, *image.size)
    return image


def _check_size(path: Path, width: int, height: int) -> None:
    if width * height > MAX_PIXELS:
        raise TextureError(
            f"{path} has {_megapixels(width * height)}; the limit is {_megapixels(MAX_PIXELS)}. "
            "Save it smaller."
        )


def _megapixels(pixels: int) -> str:
    return f"{pixels / 1e6:.0f} megapixels"


def encode(image: Image.Image) -> bytes:
    """Return the picture as PNG, or as JPEG if it was one: glTF's two formats."""
    data = io.BytesIO()
    is_jpeg = image.format == "JPEG"
    if max(image.size) > MAX_EDGE:
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

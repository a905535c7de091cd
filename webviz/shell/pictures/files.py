"""Pictures, contact sheets and animations as files, written atomically."""

from __future__ import annotations

import contextlib
import math
import os
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING

import PIL.Image

from webviz.api.errors import Error, UsageError
from webviz.shell.cli.ending import unfinished

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont, ImageFont

STILLS = (".png", ".webp", ".jpg", ".jpeg", ".gif")
ANIMATIONS = (".gif", ".webp")
VIDEOS = (".mp4",)
WITH_ALPHA = (".png", ".webp")
CAPTION = 22
"""Height of the captions of a contact sheet in pixels."""
GAP = 4
MAX_EDGE = 16_000
"""Maximum edge of a contact sheet in pixels; the limit of WebP and of most programs."""
PAPER, INK = (24, 24, 24), (210, 210, 210)


class OutputError(Error):
    """A picture cannot be written."""


def check(path: Path, *, is_animation: bool, transparent: bool) -> None:
    """Check the name of a file, and whether it can be written, before any work is done.

    Raises:
        UsageError: its name does not fit.
        OutputError: it cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in (*STILLS, *VIDEOS):
        raise UsageError(f"{path} has no supported image extension. Use {', '.join(STILLS)}.")
    if suffix in VIDEOS and not is_animation:
        raise UsageError(f"A {suffix} file needs several times, such as --every 0.1.")
    if is_animation and suffix not in (*ANIMATIONS, *VIDEOS):
        raise UsageError(f"{suffix} does not support animation. Use {' or '.join(ANIMATIONS)}.")
    if transparent and suffix not in WITH_ALPHA:
        raise UsageError(f"{suffix} does not support transparency. Use {' or '.join(WITH_ALPHA)}.")
    if not path.exists():
        with writing(path):
            pass
        path.unlink()


def save(image: PIL.Image.Image, path: Path) -> None:
    """Write one picture.

    Raises:
        OutputError: it cannot be written.
    """
    with writing(path) as file:
        image.save(file, _format(path))


def save_animation(images: Iterable[PIL.Image.Image], path: Path, fps: float) -> None:
    """Write an endless animation; pictures are taken one by one.

    Raises:
        OutputError: it cannot be written.
    """
    pictures = iter(images)
    first = next(pictures)
    with writing(path) as file:
        first.save(
            file,
            _format(path),
            save_all=True,
            append_images=pictures,
            duration=round(1000 / fps),
            loop=0,
        )


def with_clock(image: PIL.Image.Image, text: str) -> PIL.Image.Image:
    """Return a picture with a line of text in its lower left corner, on a dark ground."""
    image = image.copy()
    draw, font = pen(image, max(12, image.height // 36))
    place = GAP * 2, image.height - GAP * 2
    left, top, right, bottom = draw.textbbox(place, text, font, "ld")
    draw.rectangle((left - GAP, top - GAP, right + GAP, bottom + GAP), PAPER)
    draw.text(place, text, INK, font, "ld")
    return image


def contact_sheet(pictures: Sequence[tuple[str, PIL.Image.Image]], columns: int) -> PIL.Image.Image:
    """All pictures in rows with captions.

    Args:
        pictures: captions and pictures of one size.
        columns: pictures per row.

    Raises:
        OutputError: it would be too large.
    """
    width, height = pictures[0][1].size
    total = sheet_size((width, height), len(pictures), columns)
    mode = pictures[0][1].mode
    sheet = PIL.Image.new(mode, total, PAPER)
    draw, font = pen(sheet, 13)
    for index, (caption, picture) in enumerate(pictures):
        row, column = divmod(index, columns)
        x, y = GAP + column * (width + GAP), GAP + row * (height + CAPTION)
        sheet.paste(picture, (x, y))
        draw.text((x + 2, y + height + 2), caption, INK, font)
    return sheet


def sheet_size(size: tuple[int, int], count: int, columns: int) -> tuple[int, int]:
    """Width and height of a contact sheet.

    Raises:
        OutputError: it would be too large.
    """
    rows = math.ceil(count / columns)
    total = (columns * (size[0] + GAP) + GAP, rows * (size[1] + CAPTION) + GAP)
    if max(total) > MAX_EDGE:
        raise OutputError(
            f"The contact sheet would have {total[0]} x {total[1]} pixels; the limit is {MAX_EDGE} "
            "per side. Make fewer or smaller pictures."
        )
    return total


def numbered(path: Path, view: str, index: int | None, count: int) -> Path:
    """Return the name of one of several pictures, such as out-Front-03.png."""
    parts = [path.stem, re.sub(r"[^\w.-]+", "_", view)]
    if index is not None:
        parts.append(str(index).zfill(len(str(count - 1))))
    return path.with_name("-".join(filter(None, parts)) + path.suffix)


@contextlib.contextmanager
def writing(path: Path) -> Iterator[IO[bytes]]:
    """Provide a file that replaces the one at `path` at the end of the block, if there is no error.

    Raises:
        OutputError: it cannot be written.
    """
    # Devices, such as /dev/stdout, must not be replaced.
    is_device = path.exists() and not path.is_file()
    part = path if is_device else path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with part.open("wb") as file, contextlib.nullcontext() if is_device else unfinished(part):
            yield file
            file.flush()
            if not is_device:
                os.fsync(file.fileno())
        if not is_device:
            part.replace(path)
    except OSError as error:
        raise OutputError(f"Cannot write {path}: {error.strerror or error}.") from error
    finally:
        if not is_device:
            with contextlib.suppress(OSError):
                part.unlink(missing_ok=True)


def _format(path: Path) -> str:
    return {".jpg": "JPEG"}.get(path.suffix.lower(), path.suffix[1:].upper())


def pen(image: PIL.Image.Image, size: float) -> tuple[ImageDraw, FreeTypeFont | ImageFont]:
    """Return what draws on an image, and a font of a size in pixels."""
    import PIL.ImageDraw  # here, as few viewers ever write, and it takes 1.5 MB
    import PIL.ImageFont

    return PIL.ImageDraw.Draw(image), PIL.ImageFont.load_default(size)

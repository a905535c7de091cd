"""Videos, encoded by ffmpeg where it is installed."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO

import PIL.Image

from webviz.shell.pictures.files import OutputError

ENCODERS = {
    "libx264": ("-crf", "18", "-preset", "medium"),
    "libopenh264": ("-b:v", "8M"),
    "libsvtav1": ("-crf", "28", "-preset", "7"),
    "libaom-av1": ("-crf", "28", "-cpu-used", "6"),
}
"""Encoders of H.264 and AV1 by preference, with their settings."""
EVEN = "pad=ceil(iw/2)*2:ceil(ih/2)*2"
MATRIX = "scale=out_color_matrix=bt709:out_range=tv"
"""Players guess a matrix that is not stated by the height of the picture, and shift colours."""
PATIENCE_S = 20.0
MAX_REASON = 300
"""Characters of what ffmpeg says."""


def encoder() -> tuple[str, str]:
    """Return the encoder to use, and why there is none: one of both is ""."""
    program = shutil.which("ffmpeg")
    if program is None:
        return "", "ffmpeg is not installed"
    command = [program, "-hide_banner", "-encoders"]
    try:
        listing = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S).stdout
    except (OSError, subprocess.SubprocessError) as error:
        return "", f"ffmpeg does not start ({error})"
    supported = set(listing.split())
    encoder_name = next((name for name in ENCODERS if name in supported), "")
    return encoder_name, "" if encoder_name else "this ffmpeg encodes neither H.264 nor AV1"


def save_video(images: Iterable[PIL.Image.Image], path: Path, fps: float, name: str) -> None:
    """Write an MP4 file atomically; pictures are taken one by one.

    Args:
        images: of one size; odd sizes are padded by a pixel.
        path: of the file.
        fps: pictures per second.
        name: of the encoder.

    Raises:
        OutputError: ffmpeg fails, or the file cannot be written.
    """
    pictures = iter(images)
    first = next(pictures)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with _ffmpeg(first.size, part, fps, name) as pipe:
            pipe.write(first.convert("RGB").tobytes())
            for picture in pictures:
                pipe.write(picture.convert("RGB").tobytes())
        part.replace(path)
    except OSError as error:
        raise OutputError(f"Cannot write {path}: {error.strerror or error}.") from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


@contextlib.contextmanager
def _ffmpeg(size: tuple[int, int], part: Path, fps: float, name: str) -> Iterator[IO[bytes]]:
    """Provide the input of ffmpeg; the file is complete at the end of the block.

    Raises:
        OutputError: it fails.
    """
    command = [
        *("ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y"),
        *("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}"),
        *("-r", f"{fps:g}", "-i", "pipe:0", "-an"),
        *("-vf", f"{EVEN},{MATRIX}", "-pix_fmt", "yuv420p", "-colorspace", "bt709"),
        *("-c:v", name, *ENCODERS[name], "-movflags", "+faststart"),
        *("-f", "mp4", f"file:{part}"),
    ]
    with tempfile.TemporaryFile() as errors:
        with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=errors) as process:
            assert process.stdin is not None
            try:
                with contextlib.suppress(BrokenPipeError):  # it has ended, and says why
                    yield process.stdin
                    process.stdin.close()
            except BaseException:
                process.kill()
                raise
        errors.seek(0)
        message = errors.read().decode(errors="replace")
    if process.returncode:
        reason = " ".join(message.split())[-MAX_REASON:] or f"it ended with {process.returncode}"
        raise OutputError(f"ffmpeg failed: {reason.rstrip('.')}.")

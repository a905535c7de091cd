"""Pictures of scenes compared with pictures that a person has looked at."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from webviz.api.views import View
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing.comparing import (
    TOLERANCE,
    PixelBox,
    difference_image,
    load,
    masked,
    share_of_difference,
    store,
)
from webviz.shell.testing.darkroom import Darkroom, Size
from webviz.shell.testing.recording import RecordingScene

__tracebackhide__ = True  # failures are shown where the test calls

UPDATE = "--update-pictures"


@dataclass(frozen=True)
class Album:
    """Where the reference pictures of one test are, and what to do with them.

    Args:
        folder: of the reference pictures.
        output: where to put pictures that differ.
        root: of all tests; messages name files relative to it.
        update: make reference pictures instead of comparing.
        each_display: whether each display must be seen in each picture.
        size: width and height in pixels.
    """

    folder: Path
    output: Path
    root: Path
    update: bool = False
    each_display: bool = False
    size: Size = (400, 300)

    def shown(self, path: Path) -> str:
        """A path as a person in the root would write it."""
        return str(path.relative_to(self.root) if path.is_relative_to(self.root) else path)


@dataclass
class Photographer:
    """Makes and checks the pictures of one scene.

    Args:
        scene: what is drawn.
        darkroom: where pictures are made.
        album: with which they are compared.
        view: where the camera is.
    """

    scene: RecordingScene
    darkroom: Darkroom
    album: Album
    view: View

    def capture(self, transparent: bool = False) -> Pixels:
        """What a browser shows."""
        return self.darkroom.capture(self.scene, self.view, self.album.size, transparent)

    def check(
        self,
        name: str,
        displays: Mapping[str, str],
        mask: Sequence[PixelBox] = (),
        tolerance: float = TOLERANCE,
    ) -> None:
        """Compare with a reference picture, or make that.

        Args:
            name: of the picture in the album, without suffix.
            displays: prefix of groups and name of each display that must be seen in it.
            mask: what does not matter.
            tolerance: share of pixels that may differ.

        Raises:
            AssertionError: a person would see the difference; the text tells where to look.
        """
        album = self.album
        path = album.folder / f"{name}.png"
        if not path.exists() and not album.update:
            raise AssertionError(
                f"There is no {album.shown(path)}: run pytest with {UPDATE}, look at the picture, "
                "and commit it."
            )
        actual = masked(self.capture(), mask)
        expected = load(path) if path.exists() else None
        if expected is not None:
            expected = masked(expected, mask)
        share = 1.0
        if expected is not None and expected.shape == actual.shape:
            share = share_of_difference(actual, expected)
        # What still passes stays as it is: every version of a picture weighs on a clone.
        if expected is None or (album.update and share > tolerance):
            store(actual, path, few_colors=True)
            expected = actual
        elif share > tolerance:
            raise AssertionError(self._complaint(name, path, share, actual, expected))
        self._check_each(name, displays, mask, tolerance, expected)

    def _check_each(
        self,
        name: str,
        displays: Mapping[str, str],
        mask: Sequence[PixelBox],
        tolerance: float,
        whole: Pixels,
    ) -> None:
        """Raise if a display could be left out without anybody noticing."""
        unseen: list[str] = []
        for prefix, display in displays.items():
            rest = self.darkroom.capture_without(self.scene, self.view, self.album.size, prefix)
            if share_of_difference(masked(rest, mask), whole) <= tolerance:
                unseen.append(display)
        if unseen:
            raise AssertionError(
                f"The picture {name} would be the same without {' and without '.join(unseen)}: "
                "move the camera, or leave out of the scene what it is not about."
            )

    def _complaint(
        self, name: str, path: Path, share: float, actual: Pixels, expected: Pixels
    ) -> str:
        output = self.album.output / f"{name}.png"
        store(actual, output)
        shown, reference = self.album.shown(output), self.album.shown(path)
        remedy = f"If that is right, run with {UPDATE} and look again."
        if actual.shape != expected.shape:
            sizes = [f"{p.shape[1]} x {p.shape[0]}" for p in (actual, expected)]
            return (
                f"The picture has {sizes[0]} pixels, {reference} has {sizes[1]}: look at {shown}. "
                f"{remedy}"
            )
        marked = output.with_suffix(".difference.png")
        store(difference_image(actual, expected), marked)
        return (
            f"{100 * share:.2f} % of the picture differ from {reference}: look at {shown} and "
            f"{self.album.shown(marked)}. {remedy}"
        )

"""Comparison of pictures of scenes with reference pictures."""

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
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.shared_renderer import SharedRenderer, Size

__tracebackhide__ = True  # failures are shown where the test calls

UPDATE = "--update-pictures"


@dataclass(frozen=True)
class ReferenceImages:
    """The reference pictures of a test.

    Args:
        folder: of the reference pictures.
        output: folder for pictures that differ.
        root: of all tests; messages have paths relative to it.
        update: replace reference pictures that differ.
        each_display: whether every display must be visible in each picture.
        size: width and height in pixels.
    """

    folder: Path
    output: Path
    root: Path
    update: bool = False
    each_display: bool = False
    size: Size = (400, 300)

    def check(
        self,
        name: str,
        pixels: Pixels,
        mask: Sequence[PixelBox] = (),
        tolerance: float = TOLERANCE,
    ) -> Pixels:
        """Compare a picture with its reference picture, or update that.

        Args:
            name: of the picture in the references, without suffix.
            pixels: uint8 (height, width, 3).
            mask: boxes to ignore.
            tolerance: share of pixels that may differ.

        Returns:
            The reference picture, masked.

        Raises:
            AssertionError: there is a visible difference; the message names the files.
        """
        path = self.folder / f"{name}.png"
        if not path.exists() and not self.update:
            raise AssertionError(
                f"{self.relative(path)} is missing. Run pytest with {UPDATE}, check the picture, "
                "and commit it."
            )
        actual = masked(pixels, mask)
        expected = load(path) if path.exists() else None
        if expected is not None:
            expected = masked(expected, mask)
        share = 1.0
        if expected is not None and expected.shape == actual.shape:
            share = share_of_difference(actual, expected)
        # Keep pictures that pass, since every version adds to the size of a clone.
        if expected is None or (self.update and share > tolerance):
            store(actual, path, few_colors=True)
            return actual
        if share > tolerance:
            raise AssertionError(self._complaint(name, path, share, actual, expected))
        return expected

    def relative(self, path: Path) -> str:
        """Return a path relative to the root, if it is inside."""
        return str(path.relative_to(self.root) if path.is_relative_to(self.root) else path)

    def _complaint(
        self, name: str, path: Path, share: float, actual: Pixels, expected: Pixels
    ) -> str:
        output = self.output / f"{name}.png"
        store(actual, output)
        link, reference = self.relative(output), self.relative(path)
        remedy = f"If it is correct, run pytest with {UPDATE} and check the picture."
        if actual.shape != expected.shape:
            sizes = [f"{p.shape[1]} x {p.shape[0]}" for p in (actual, expected)]
            return (
                f"The picture has {sizes[0]} pixels, {reference} has {sizes[1]}. See {link}. "
                f"{remedy}"
            )
        marked = output.with_suffix(".difference.png")
        store(difference_image(actual, expected), marked)
        return (
            f"{100 * share:.2f} % of the picture differ from {reference}. See {link} and "
            f"{self.relative(marked)}. {remedy}"
        )


@dataclass
class SnapshotFixture:
    """Makes and checks the pictures of a scene.

    Args:
        scene: to draw.
        shared_renderer: makes the pictures.
        references: has the reference pictures.
        view: of the camera.
    """

    scene: RecordingScene
    shared_renderer: SharedRenderer
    references: ReferenceImages
    view: View

    def capture(self, transparent: bool = False) -> Pixels:
        """Return a picture of the scene."""
        return self.shared_renderer.capture(
            self.scene, self.view, self.references.size, transparent
        )

    def check(
        self,
        name: str,
        displays: Mapping[str, str],
        mask: Sequence[PixelBox] = (),
        tolerance: float = TOLERANCE,
    ) -> None:
        """Compare the scene with a reference picture, or update that.

        Args:
            name: of the picture in the references, without suffix.
            displays: that must be visible: their names by the prefix of their groups.
            mask: boxes to ignore.
            tolerance: share of pixels that may differ.

        Raises:
            AssertionError: there is a visible difference; the message names the files.
        """
        expected = self.references.check(name, self.capture(), mask, tolerance)
        self._check_each(name, displays, mask, tolerance, expected)

    def _check_each(
        self,
        name: str,
        displays: Mapping[str, str],
        mask: Sequence[PixelBox],
        tolerance: float,
        whole: Pixels,
    ) -> None:
        """Raise AssertionError if a display makes no visible difference."""
        unseen: list[str] = []
        for prefix, display in displays.items():
            rest = self.shared_renderer.capture(
                self.scene, self.view, self.references.size, hidden=prefix
            )
            if share_of_difference(masked(rest, mask), whole) <= tolerance:
                unseen.append(display)
        if unseen:
            raise AssertionError(
                f"The picture {name} would be the same without {' and without '.join(unseen)}. "
                "Move the camera, or remove them from the scene."
            )

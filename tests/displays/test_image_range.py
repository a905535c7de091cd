"""The range of values over several images."""

import numpy as np

from webviz.data.images import RawImage
from webviz_displays.image.base import RunningRange


def image(low: float, high: float) -> RawImage:
    data = np.array([low, high], np.float32).view(np.uint8)
    return RawImage(2, 1, "32FC1", 8, False, data)


def test_an_image_that_is_drawn_again_counts_once() -> None:
    running, window = RunningRange(), 3
    assert running.of(1, image(1.0, 2.0), window) == (1.0, 2.0)
    for _ in range(5):
        assert running.of(2, image(3.0, 6.0), window) == (2.0, 4.0)
    assert running.of(3, image(9.0, 9.0), window) == (3.0, 6.0)
    assert running.of(4, image(9.0, 9.0), window) == (9.0, 9.0)  # the first has left

"""Fixtures of the transform tests."""

import pytest

from webviz.data.transforms import TransformBuffer

S = 1_000_000_000


class HandFedBuffer(TransformBuffer):
    """A buffer into which a test puts translations along x."""

    def put(
        self,
        parent: str,
        child: str,
        stamp_s: float = 1.0,
        x: float = 0.0,
        is_static: bool = False,
        authority: str = "",
    ) -> bool:
        """Insert one, with its stamp in seconds."""
        stamp, rotation = round(stamp_s * S), (0.0, 0.0, 0.0, 1.0)
        return self.set_transform(
            parent, child, stamp, (x, 0.0, 0.0), rotation, is_static, authority
        )


@pytest.fixture
def buffer() -> HandFedBuffer:
    return HandFedBuffer()

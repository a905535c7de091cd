"""Fixtures of the transform tests."""

from collections.abc import Callable

import pytest

from webviz.data.transforms import TransformBuffer

S = 1_000_000_000


@pytest.fixture
def buffer() -> TransformBuffer:
    return TransformBuffer()


@pytest.fixture
def put(buffer: TransformBuffer) -> Callable[..., bool]:
    """Insert a pure translation along x; the stamp in seconds."""

    def insert(
        parent: str,
        child: str,
        stamp_s: float = 1.0,
        x: float = 0.0,
        is_static: bool = False,
        authority: str = "",
    ) -> bool:
        return buffer.set_transform(
            parent,
            child,
            round(stamp_s * S),
            (x, 0.0, 0.0),
            (0.0, 0.0, 0.0, 1.0),
            is_static,
            authority,
        )

    return insert

"""The skeletons of the ZED SDK: how many joints they have, and which of them are linked.

Numbers of joints are those of the SDK's BODY_18, BODY_34, BODY_38 and BODY_70.
"""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray


class Skeleton(msgspec.Struct, frozen=True, eq=False):
    """A format of skeletons.

    Args:
        joints: how many of the keypoints of a message are joints.
        bones: (M, 2), the joints at the ends of each bone.
    """

    joints: int
    bones: NDArray[np.intp]


def _body(joints: int, *chains: tuple[int, ...]) -> Skeleton:
    return Skeleton(
        joints, np.array([bone for chain in chains for bone in pairwise(chain)], np.intp)
    )


_TRUNK = (
    *((0, 1, 2, 3, 4, 5), (5, 6, 8), (5, 7, 9)),
    *((3, 10, 12, 14, 16), (3, 11, 13, 15, 17)),
    *((0, 18, 20, 22), (22, 24), (22, 26), (22, 28)),
    *((0, 19, 21, 23), (23, 25), (23, 27), (23, 29)),
)
"""Chains of joints from the pelvis to the face, the wrists and the feet."""

BODIES = (
    _body(
        18,
        *((0, 1, 2, 3, 4), (1, 5, 6, 7), (2, 5), (2, 8, 9, 10), (5, 11, 12, 13), (8, 11)),
        *((0, 14, 16), (0, 15, 17)),
    ),
    _body(
        34,
        *((0, 1, 2, 4, 5, 6, 7, 8, 9), (7, 10), (2, 11, 12, 13, 14, 15, 16), (14, 17)),
        *((0, 18, 19, 20, 21), (20, 32, 21), (0, 22, 23, 24, 25), (24, 33, 25)),
        *((2, 3, 26, 27, 28, 29), (27, 30, 31)),
    ),
    _body(
        38,
        *_TRUNK,
        *((16, tip) for tip in range(30, 38, 2)),
        *((17, tip) for tip in range(31, 38, 2)),
    ),
    _body(70, *_TRUNK, *((16, j) for j in range(30, 50)), *((17, j) for j in range(50, 70))),
)
"""By the `body_format` of a message."""

"""Views of every type, for property-based tests."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from webviz.api.views import (
    FPS,
    FrameAligned,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
)

METERS = st.floats(-1000, 1000).map(lambda value: round(value, 6))
ANGLES = st.floats(-3.14, 3.14).map(lambda value: round(value, 6))
PITCHES = st.floats(-1.569, 1.569).map(lambda value: round(value, 6))
DISTANCES = st.floats(0.1, 1000).map(lambda value: round(value, 6))
POINTS = st.tuples(METERS, METERS, METERS)


def around(cls: Any, points: st.SearchStrategy[Any] = POINTS) -> st.SearchStrategy[Any]:
    """Views of a type that has a focal point."""
    return st.builds(
        cls,
        distance=DISTANCES,
        yaw=ANGLES,
        pitch=PITCHES,
        focal_point=points,
        invert_z_axis=st.booleans(),
    )


ORBITS = around(Orbit)
FPS_VIEWS = st.builds(FPS, yaw=ANGLES, pitch=PITCHES, position=POINTS)
ALIGNED_VIEWS = st.builds(
    FrameAligned, yaw=ANGLES, pitch=PITCHES, position=POINTS, invert_z_axis=st.booleans()
)
FLAT_VIEWS = st.builds(
    TopDownOrtho,
    scale=st.floats(0.1, 1000).map(lambda value: round(value, 6)),
    angle=ANGLES,
    x=METERS,
    y=METERS,
)
VIEWS: st.SearchStrategy[View] = st.one_of(
    ORBITS,
    around(XYOrbit),
    around(ThirdPersonFollower),
    FPS_VIEWS,
    ALIGNED_VIEWS,
    FLAT_VIEWS,
)

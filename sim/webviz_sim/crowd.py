"""People that walk through a world: round obstacles that no map has."""

import numpy as np
from numpy.typing import NDArray

from webviz_sim.circles import NONE, Circles
from webviz_sim.planner import Planner
from webviz_sim.pose import Pose2D

RADIUS = 0.2  # m
SPEED = 0.6  # m/s


class Crowd:
    """Walks between the free places of a world, the same way for the same seed.

    Args:
        planner: of the world.
        start: a free place.
        count: how many people.
        seed: chooses their ways.
    """

    def __init__(self, planner: Planner, start: Pose2D, count: int, seed: int) -> None:
        self._planner = planner
        self._random = np.random.default_rng([seed, 2])
        self._places = planner.spread(start, count=12) if count else []
        self._walks = [self._walk(self._place()) for _ in range(count if self._places else 0)]
        self._distances = [0.0] * len(self._walks)

    @property
    def circles(self) -> Circles:
        """Return where they are."""
        here = [
            _along(walk, distance)
            for walk, distance in zip(self._walks, self._distances, strict=True)
        ]
        return np.array([(*point, RADIUS) for point in here]) if here else NONE

    def step(self, seconds: float) -> None:
        """Let them walk on; who arrives sets out for another place."""
        for number, walk in enumerate(self._walks):
            self._distances[number] += SPEED * seconds
            if self._distances[number] >= _length(walk):
                self._walks[number] = self._walk(Pose2D(*walk[-1]))
                self._distances[number] = 0.0

    def _place(self) -> Pose2D:
        return self._places[int(self._random.integers(len(self._places)))]

    def _walk(self, start: Pose2D) -> NDArray[np.float64]:
        path = self._planner.plan(start, self._place())
        # Who is where it wants to be stays for some seconds.
        return path if path is not None and len(path) > 1 else np.array([start[:2]] * 2)


def _length(walk: NDArray[np.float64]) -> float:
    return max(float(np.hypot(*np.diff(walk, axis=0).T).sum()), 3.0 * SPEED)


def _along(walk: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Return the point of a polyline at a distance from its start, in metres."""
    passed = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(walk, axis=0).T))])
    return np.array([np.interp(distance, passed, walk[:, axis]) for axis in (0, 1)])

"""One interactive marker as it is shown: where it is, and who moves it."""

from __future__ import annotations

import msgspec

from webviz import Frames, Pose, compose
from webviz_displays.interactive_markers.completion import Completed


class Place(msgspec.Struct, frozen=True):
    """A pose in a frame.

    Args:
        frame: id.
        stamp_ns: of the transform to the fixed frame; 0 is the latest, so that it moves with it.
        pose: in the frame.
    """

    frame: str
    stamp_ns: int
    pose: Pose


class Tracked:
    """An interactive marker.

    Args:
        key: of its handle.
        completed: the newest version from the server.
    """

    def __init__(self, key: str, completed: Completed) -> None:
        self.key = key
        self.content = completed
        self.version = 0
        """Changes with its controls, their angles, and what `place` depends on."""
        self.turned: dict[str, float] = {}
        """Angles by which controls have been turned, by name."""
        self.problem = ""
        """Reason why the last message for it was ignored, a sentence."""
        self.is_held = False
        self._place = Place(completed.frame, completed.stamp_ns, completed.pose)
        self._later: Place | None = None
        self._place_cache: tuple[str, Place] | None = None

    @property
    def is_locked(self) -> bool:
        """Return whether it moves with its frame."""
        return self._place.stamp_ns == 0

    @property
    def pose(self) -> Pose:
        """Pose of the marker in its frame at its stamp."""
        return self._place.pose

    @property
    def source(self) -> Place:
        """Place of the marker, as the server has it or as it was dragged since."""
        return self._place

    def update(self, completed: Completed) -> None:
        """Take a new version; while it is dragged, its pose waits for the end."""
        self.content, self.problem = completed, ""
        names = {part.control.name for part in completed.parts}
        self.turned = {name: angle for name, angle in self.turned.items() if name in names}
        self.version += 1
        self.put(Place(completed.frame, completed.stamp_ns, completed.pose))

    def put(self, place: Place) -> None:
        """Move it as the server wants; while it is dragged, at the end."""
        if self.is_held:
            self._later = place
        elif place != self._place:
            self._move(place)

    def place(self, frames: Frames) -> Place | None:
        """Its pose in a frame that it moves with; None until the transform at its stamp is known.

        A stamp is that of the transform to the fixed frame, in which it stays from then on.
        """
        if self._place.stamp_ns == 0:
            return self._place if self._place.frame else None
        if self._place_cache is None or self._place_cache[0] != frames.fixed_frame:
            at = frames.at(self._place.frame, self._place.stamp_ns)
            if at is None:
                return None
            placed = Place(frames.fixed_frame, 0, compose(at, self._place.pose))
            self._place_cache = frames.fixed_frame, placed
        return self._place_cache[1]

    def press(self) -> None:
        """Begin to drag it."""
        self.is_held = True

    def drag(self, control: str, pose: Pose, turned: float, frames: Frames) -> bool:
        """Move it, given its pose in the frame of `place`; whether that is known and differs."""
        place = self.place(frames)
        if place is None:
            return False
        if (pose, turned) == (place.pose, self.turned.get(control, 0.0)):
            return False
        self.turned[control] = turned
        self._move(Place(place.frame, 0, pose))
        return True

    def release(self) -> None:
        """End the drag, and go where the server wanted it meanwhile."""
        self.is_held, later, self._later = False, self._later, None
        if later is not None:
            self._move(later)

    def _move(self, place: Place) -> None:
        self._place, self._place_cache = place, None
        self.version += 1

"""Who published a frame's transforms, and whether two quarrel over it."""

from __future__ import annotations


class Publishers:
    """The authorities heard of for one child frame.

    One that takes over for good is a restart; one that speaks again after it was replaced, or two
    that give different static poses, are two publishers of one frame.

    Attributes:
        current: the authority of the last transform stored.
        contested_ns: stamp at which two were last caught, or None.
        delay_ns: how long after its stamp the last transform was received; None if not known.
    """

    __slots__ = ("_seen", "contested_ns", "current", "delay_ns")

    def __init__(self, authority: str) -> None:
        self.current = authority
        self.contested_ns: int | None = None
        self.delay_ns: int | None = None
        self._seen: dict[str, int] = {authority: 0}

    def switch(self, authority: str, stamp_ns: int, horizon_ns: int, conflict: bool) -> None:
        """Note that another authority than `current` gave a transform.

        Args:
            authority: the one that did.
            stamp_ns: of its transform.
            horizon_ns: authorities not heard of since this stamp are forgotten.
            conflict: its data contradicts what stood before.
        """
        self._seen[self.current] = stamp_ns
        if conflict or self._seen.get(authority, horizon_ns) > horizon_ns:
            self.contested_ns = stamp_ns
        self._seen = {name: at for name, at in self._seen.items() if at > horizon_ns}
        self._seen[authority] = stamp_ns
        self.current = authority

    def names(self) -> list[str]:
        """The authorities heard of lately, the current one last."""
        return [*(name for name in self._seen if name != self.current), self.current]

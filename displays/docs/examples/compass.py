"""A display with an overlay: north in the scene, and the heading of the camera over it."""

from collections.abc import Sequence

from webviz import Context, Display, Sample


class Compass(Display):
    """North, which is the y axis of the fixed frame."""

    module = "compass.js"
    icon = "M12 3l5 17-5-4-5 4z"

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw a line to the north."""
        ctx.lines("north", [[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]], (255, 40, 40), width=3.0)
        ctx.ok("Compass", "North is the y axis of the fixed frame.")

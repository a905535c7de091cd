"""Browsers as the checks of the doctor see them."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.api.views import View


@dataclass(frozen=True, kw_only=True)
class BrowserSeen:
    """A connected browser.

    Args:
        id: of the browser.
        name: of its user or its address, for sentences.
        waited_s: since it connected, while its page has not started; 0 once it has.
        silent_s: since its page reported last, in seconds.
        renderer: of its graphics, as it names it; "" while unknown.
        is_software: whether the processor draws.
        is_hidden: whether its tab is in the background.
        frame_s: median time that a frame took lately, 0 if none was drawn.
        late_s: longest time by which its timers were late lately.
        points: that it draws 20 times a second; 0 while unknown.
        rate: bytes a second that its link takes; None if it is fast enough.
        reduced: what is reduced because of its link, a clause; "" if nothing is.
        view: of its camera, None while unknown.
        size: width and height of its picture in pixels, zeros while unknown.
    """

    id: int
    name: str
    waited_s: float = 0.0
    silent_s: float = 0.0
    renderer: str = ""
    is_software: bool = False
    is_hidden: bool = False
    frame_s: float = 0.0
    late_s: float = 0.0
    points: int = 0
    rate: float | None = None
    reduced: str = ""
    view: View | None = None
    size: tuple[float, float] = (0.0, 0.0)

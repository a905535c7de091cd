"""What tests of other packages get: viewers whose scene can be read, and pictures to compare.

The fixtures of `webviz.pytest_plugin` make these; import them for annotations.
"""

from webviz.testing.comparing import NOTICEABLE, TOLERANCE, share_of_difference
from webviz.testing.live import LiveViewer
from webviz.testing.messages import header
from webviz.testing.rotation import turned
from webviz.testing.shown import Shown
from webviz.testing.source import SECOND
from webviz.testing.stage import Stage

__all__ = [
    "NOTICEABLE",
    "SECOND",
    "TOLERANCE",
    "LiveViewer",
    "Shown",
    "Stage",
    "header",
    "share_of_difference",
    "turned",
]

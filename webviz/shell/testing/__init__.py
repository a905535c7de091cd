"""What tests of other packages get: viewers whose scene can be read, and pictures to compare.

The fixtures of `webviz.shell.pytest_plugin` make these; import them for annotations.
"""

from webviz.data.messages import encode as serialized
from webviz.shell.testing.comparing import NOTICEABLE, TOLERANCE, share_of_difference
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.messages import header
from webviz.shell.testing.rotation import turned
from webviz.shell.testing.shown import Shown
from webviz.shell.testing.source import SECOND
from webviz.shell.testing.stage import Stage

__all__ = [
    "NOTICEABLE",
    "SECOND",
    "TOLERANCE",
    "LiveViewer",
    "Shown",
    "Stage",
    "header",
    "serialized",
    "share_of_difference",
    "turned",
]

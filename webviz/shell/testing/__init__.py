"""Viewers for tests of other packages: read their scene, and compare pictures.

They are created by the fixtures of `webviz.shell.pytest_plugin`; import them for annotations.
"""

from webviz.data.messages import encode as serialized
from webviz.shell.testing.comparing import NOTICEABLE, TOLERANCE, share_of_difference
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.messages import header, turned
from webviz.shell.testing.seeking import BagViewer, check_seeks
from webviz.shell.testing.shown import Shown
from webviz.shell.testing.source import SECOND
from webviz.shell.testing.stage import Stage

__all__ = [
    "NOTICEABLE",
    "SECOND",
    "TOLERANCE",
    "BagViewer",
    "LiveViewer",
    "Shown",
    "Stage",
    "check_seeks",
    "header",
    "serialized",
    "share_of_difference",
    "turned",
]

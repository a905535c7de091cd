"""Viewers for tests of other packages: read their scene, and compare pictures.

They are created by the fixtures of `webviz.shell.pytest_plugin`; import them for annotations.
"""

from webviz.data.messages import encode as serialized
from webviz.shell.testing.bench import DisplayBench, check_details
from webviz.shell.testing.comparing import NOTICEABLE, TOLERANCE, share_of_difference
from webviz.shell.testing.display_checks import DisplayChecks
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.messages import header, turned
from webviz.shell.testing.replaying import Replayed, looks_like, replay
from webviz.shell.testing.seeking import BagViewer, check_seeks
from webviz.shell.testing.source import SECOND
from webviz.shell.testing.viewer_under_test import ViewerUnderTest

__all__ = [
    "NOTICEABLE",
    "SECOND",
    "TOLERANCE",
    "BagViewer",
    "DisplayBench",
    "DisplayChecks",
    "Harness",
    "LiveViewer",
    "Replayed",
    "ViewerUnderTest",
    "check_details",
    "check_seeks",
    "header",
    "looks_like",
    "replay",
    "serialized",
    "share_of_difference",
    "turned",
]

"""Tools for visual tests of other packages; see `webviz.shell.testing`."""

from webviz.shell.testing import *  # noqa: F403
from webviz.shell.testing import __all__ as __all__

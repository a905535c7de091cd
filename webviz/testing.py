"""Tools for visual tests of other packages; see `webviz.shell.testing`."""

from webviz.shell import testing
from webviz.shell.testing import *  # noqa: F403
from webviz.shell.testing import __all__ as __all__


def __getattr__(name: str) -> object:
    """Return what has another name now."""
    return getattr(testing, name)

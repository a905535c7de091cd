"""Commands for `webviz.Viewer.do`."""

from webviz.engine.commands import *  # noqa: F403
from webviz.engine.commands import __all__ as __all__

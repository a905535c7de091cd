"""What can be asked of a viewer, for `webviz.Viewer.do`."""

from webviz.engine.commands import *  # noqa: F403

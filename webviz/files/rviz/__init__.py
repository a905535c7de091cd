"""RViz2's config files: `read` and `write`.

Unsupported parts are kept in the config, so that a file that was read and written again has
lost no key, and values differ at most in the last digit of single precision.
"""

from webviz.files.rviz.document import read, write
from webviz.files.rviz.report import Note, Report
from webviz.files.rviz.revival import revive

__all__ = ["Note", "Report", "read", "revive", "write"]

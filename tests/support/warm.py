"""Imports what commands of webviz need, so that processes forked from this one have it."""

# ruff: noqa: F401
import mcp.server.mcpserver
import rich.console
import rosidl_generator_py

import webviz.engine.loop
import webviz.shell.cli.commands
import webviz.sources.fleet.source
from webviz.api.check_registry import known_checks
from webviz.api.properties import properties_of
from webviz.api.registry import display_types
from webviz.files.config.model import standard
from webviz.shell.cli.serving import _import_slow_parts

_import_slow_parts()
known_checks()
standard()
for each in display_types().values():
    properties_of(each)

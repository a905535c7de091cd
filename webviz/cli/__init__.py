"""The command line: `webviz`, and a module for each of its subcommands."""

from webviz.cli.main import main

__all__ = ["main"]

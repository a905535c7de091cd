"""`python -m webviz` is `webviz`."""

from webviz.shell.cli import program

program()

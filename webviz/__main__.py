"""`python -m webviz` is `webviz`."""

from webviz.cli import program

program()

"""The tools that come with webviz, found by their entry points."""

"""The tools that come with webviz, one module each; found by their entry points alone."""

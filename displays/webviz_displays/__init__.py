"""The displays that come with webviz, one module or folder each."""

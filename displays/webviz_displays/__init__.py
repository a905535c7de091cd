"""The displays that come with webviz, one file each."""

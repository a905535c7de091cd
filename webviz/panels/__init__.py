"""The panels that come with webviz, one file each."""

"""Config files, webviz's own and RViz's."""

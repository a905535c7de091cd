"""A running viewer and its Python API, `webviz.Viewer`."""

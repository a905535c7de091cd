"""Features, each in one folder; see `webviz.engine.feature`."""

"""The engine: the frame loop, its sources, the displays and their pipeline."""

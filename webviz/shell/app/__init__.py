"""A viewer put together and at work, and how Python programs steer it: `webviz.Viewer`."""

"""The one thread that changes displays, transforms, scene and panel, and what it keeps."""

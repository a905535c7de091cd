"""The scene in real browsers; a package, so that its tabs are closed after its last test."""

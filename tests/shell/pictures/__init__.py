"""Pictures and videos; a package, so that its tab is closed after its last test."""

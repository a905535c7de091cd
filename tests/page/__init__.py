"""The page in real browsers; a package, so that its tab is closed after its last test."""

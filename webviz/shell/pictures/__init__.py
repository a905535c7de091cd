"""Pictures by a headless browser."""

"""HTTP, websockets and TLS, and their limits."""

"""HTTP, websockets and TLS, and the limits that guard them."""

"""The server: access, what is sent first, the channel to pages, HTTP and websockets."""

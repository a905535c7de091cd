"""The channel: messages between the page and the server other than viser's."""

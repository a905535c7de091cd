"""Images of panes on their way to the pages that show them."""

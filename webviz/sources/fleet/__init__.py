"""Several robots at once: each behind a bridge of its own, beside live topics or alone."""

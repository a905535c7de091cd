"""Pictures without a screen: a headless browser, a studio, and what they show at a moment."""

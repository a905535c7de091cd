"""Access to a viewer: roles, tokens and the rules that are enforced."""

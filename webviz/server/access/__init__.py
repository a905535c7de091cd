"""Who may use a viewer, and for what: roles, tokens and the rules that are enforced."""

"""Hand models that recordings can be tracked with."""

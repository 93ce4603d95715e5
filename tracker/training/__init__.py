"""From accepted registrations to a hand model, [R17] section 3.3."""

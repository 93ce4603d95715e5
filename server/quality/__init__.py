"""Labels that look wrong, worst first."""

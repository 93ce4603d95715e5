"""Moving scans: a person scanned again and again, registered to a body, curated by stretch."""

"""What is shown of a tracked frame: the fit, contacts, collisions, detections, errors."""

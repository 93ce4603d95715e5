"""Labels under load: people at real browsers and simulated ones, on a network that is late and breaks."""

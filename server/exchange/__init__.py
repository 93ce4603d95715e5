"""Labels in the formats of others, and snapshots of them that never change."""

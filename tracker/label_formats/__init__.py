"""Labels in the formats of others: one file per format, each with its writer, its reader and its conventions."""

"""The studies of [T16] §4 on twins of its public sequences, and the bars of this project."""

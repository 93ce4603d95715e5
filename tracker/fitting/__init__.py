"""One objective, one fit of a frame, and how good it is (T16 Eq. 5 and 14)."""

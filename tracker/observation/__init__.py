"""The D of T16 Eq. 5: what the tracker keeps of a frame."""

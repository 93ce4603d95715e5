"""The summands of T16 Eq. 5, one module each."""

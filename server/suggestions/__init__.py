"""Joints that a machine proposes. They are no annotations until somebody accepts them."""

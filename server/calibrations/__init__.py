"""Cameras calibrated from filmed boards: what was filmed, how it is to be done, and what was found."""

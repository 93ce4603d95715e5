"""Joints that people mark in images: the current ones and every one before."""

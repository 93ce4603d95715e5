"""Scans of hands whose truth is known and is not of the class of model that is fitted to them."""

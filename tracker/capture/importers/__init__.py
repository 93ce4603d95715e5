"""One module for each kind of recording that can be imported."""

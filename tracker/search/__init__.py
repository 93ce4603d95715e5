"""Where hands and things are when nothing is known of the frame before: starts and second tries."""

"""3D scans of hands: uploaded, cropped, shown."""

"""Registration of a hand model's mesh to 3D scans ([R17] section 3.2)."""

"""Looking at a track in 3D: a viser server per session in a process of its own, proxied by the studio."""

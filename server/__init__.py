"""The studio: recordings, annotations, jobs, tracks and the viewer behind one API."""

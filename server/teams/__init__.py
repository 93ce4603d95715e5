"""Projects, who marks which frames, review, blind replicas and how well annotators agree."""

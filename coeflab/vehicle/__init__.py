"""The parameter file: the law of one body, its inertia, and where every number comes from."""

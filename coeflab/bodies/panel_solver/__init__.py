"""Added mass by panels on the surface."""

"""Added mass in closed form: ellipsoids, bodies of revolution, simple parts, plane sections."""

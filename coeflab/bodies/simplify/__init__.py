"""A mesh as simple parts."""

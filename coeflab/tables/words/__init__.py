"""What words over a table say of its tests; offered, never taken."""

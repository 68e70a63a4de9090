"""A plan, the study it becomes, and what stands out in it."""

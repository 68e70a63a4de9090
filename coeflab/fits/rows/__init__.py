"""From tables to the rows of a regression."""

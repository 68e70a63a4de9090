"""Floor 1: pure functions of arrays. No units, no files, no nouns."""

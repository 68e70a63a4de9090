"""A vehicle as C: what the exports `c` and `fmi` share."""

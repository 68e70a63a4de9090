"""Floor 1: the nouns. Frozen; arrays are copied and read-only; verbs return new objects."""

"""The vocabulary of forces: symbols, terms, scaling, coefficients, added mass, transforms."""

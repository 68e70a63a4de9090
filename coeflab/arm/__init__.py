"""A vehicle with an arm of any number of links: nouns, Kane's equations, thrusters, motion."""

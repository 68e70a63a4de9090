"""Added mass of slender bodies by sections."""

"""The URV of the paper on Kane's method: a vehicle with links 1 to 3 of a PUMA 560."""

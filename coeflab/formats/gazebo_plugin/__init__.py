"""gz-sim with added mass in the Hydrodynamics plugin."""

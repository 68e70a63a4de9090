"""gz-sim with added mass in the link."""

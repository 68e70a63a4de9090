"""Force tables and the campaigns that they come from."""

"""One law fitted over several tables, campaigns and components."""

"""xdyn and lxdyn."""

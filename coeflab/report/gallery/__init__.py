"""Reports and parameter files of a folder, in the browser."""

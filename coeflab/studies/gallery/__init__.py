"""The gallery: reports and parameter files below a folder, looked at in a browser on this machine."""

"""The front door: one file a verb. `coeflab` hands its names out; commands and users call these, and nothing below."""

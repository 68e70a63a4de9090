"""Readers and writers of text: delimited tables, TOML, XML, YAML, names."""

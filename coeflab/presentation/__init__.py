"""Between nouns and rooms: a study as tables, figures and sections, before any format."""

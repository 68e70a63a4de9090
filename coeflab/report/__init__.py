"""One document for terminal, HTML, PDF and notebook."""

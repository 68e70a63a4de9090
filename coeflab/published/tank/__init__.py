"""The tow tank against theory."""

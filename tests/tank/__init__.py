"""The virtual tow tank."""

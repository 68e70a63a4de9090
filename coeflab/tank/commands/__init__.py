"""Commands about the tow tank."""

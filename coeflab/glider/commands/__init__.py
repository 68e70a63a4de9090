"""Commands about gliders."""

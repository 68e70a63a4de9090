"""Floor 4: what needs several rooms."""

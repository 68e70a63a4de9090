"""Pictures in the user's own style: each draws into an Axes, sets nothing beyond it, and shares its drawing with the report's figure."""

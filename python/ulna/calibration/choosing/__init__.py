"""A model that chooses itself: `[fit] extras = "auto"`. `choose` is the door."""

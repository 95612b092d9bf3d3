"""What the arm touches: one file a kind with all that the kind is, and one row each in `kinds`."""

"""Live readings: from a stream of angles, by whatever way it comes, to samples that are decoded, mapped and looked
at."""

"""What a joint does beyond its geometry: one file a cause."""

"""From bytes to rows: lines of fields, JSON, packets."""

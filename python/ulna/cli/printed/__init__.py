"""Results as tables that a metrologist reads, 80 columns wide: rich renderables, nothing printed here."""

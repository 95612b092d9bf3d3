"""Arms and readings from others and for others: URDF, tables of Denavit–Hartenberg parameters, importers."""

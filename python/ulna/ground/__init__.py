"""What everything stands on: errors, version, digits, array types, the style of plots. Imports nothing of Ulna."""

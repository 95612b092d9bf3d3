"""The work sheet of a plan: a PDF to print, to take along and to tick off."""

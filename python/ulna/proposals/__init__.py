"""From a table that somebody keeps to an arm file and a study: what is seen in it, what is asked, what is written."""

"""The page of `ulna show`: an arm with a slider for each joint, one file that needs no network."""

"""`ulna record`: its commands, by what they are about."""

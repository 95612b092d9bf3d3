"""One file a resource: what is asked, handed on to who knows it."""

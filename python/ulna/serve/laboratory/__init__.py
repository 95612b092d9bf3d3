"""A laboratory of several people: who they are, how they sign in, and what their server reaches."""

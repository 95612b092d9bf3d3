"""Live readings: a stream of angles by whatever way it comes, touches made of it, and what is known after each."""

"""The door for pages and programs: HTTP and WebSocket over the rooms below. It computes nothing."""

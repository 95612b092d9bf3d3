"""What a MicroScribe says, and what is said to it: from the published protocol; untested on a device."""

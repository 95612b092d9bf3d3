"""The check of three minutes: a few touches before work, against limits and against what they were before."""

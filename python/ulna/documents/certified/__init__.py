"""Certificates: what a result and a laboratory file say, as documents that a laboratory checks and signs."""

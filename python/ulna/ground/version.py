"""The version of Ulna, said once."""

VERSION = "0.1.0"

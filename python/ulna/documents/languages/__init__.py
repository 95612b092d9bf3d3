"""The words of every language that documents speak."""

"""The catalogue: words of documents in every language, and text that no page has shaped yet."""

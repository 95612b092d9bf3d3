"""The versions of the schema, one file each; a file of a released version is never changed."""

"""What is generic of files: every room has its own models and readers, and asks here for what they share.

toml.py, models.py, units.py, numbers.py: documents as typed models, told in one message where they are wrong; names.py,
toml_text.py, output.py: writing, whole or not at all. table.py: the door to tables; header.py: a table before its rows
are read, layout.py: how one is written otherwise, rows.py: which rows are used, unused.py: columns that nobody uses;
tables/: the formats of tables, one file and one row in its registry each. unpacked.py: what a file says that it holds,
beside its size; asking.py, answering.py: files that a process of their own reads.
"""

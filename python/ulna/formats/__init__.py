"""Ulna's doors: every format that it reads and writes, and what it says to input that it cannot use.

arm.py, study.py, readings.py, result.py: one format each. toml.py, table.py: what they share of reading; tables/: one
room for each format of tables, layout.py: how a study says that one is written otherwise, rows.py: which rows are used.
output.py: writing whole or not at all; schema.py: the JSON Schemas under `schemas/`, generated from the same models.
Everything is converted to mm and rad here, once.
"""

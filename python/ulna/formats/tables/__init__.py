"""One room per format of tables: each makes a `ulna.formats.header.Header` of a file and reads its rows.

format.py: what a format owes; registry.py: one row each. text.py: CSV and its dialects. parquet.py. workbook.py: Excel.
matfile.py, hdf5.py: named arrays, whose common rules are in arrays.py; hdf5_apart.py: what a process of
its own does of it. `ulna.formats.table` is the door.
"""

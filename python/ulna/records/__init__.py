"""What became of every arm, over the years.

The record is files: originals by their SHA-256 (`store`), and one entry for each act, chained by hashes (`entry`,
`chain`). The database (`tables`, `database`) holds the chain a second time, where nobody can change it unseen, and an
index of rows that follow from entries and files alone (`projection`): it can be made anew at any time. `acts` says what
can be done, a file and a row each; `filed` what each of Ulna's formats says of an arm.
"""

"""How often stated intervals hold the truth: virtual arms, arms simulated apart from Ulna, real readings.

``python -m benchmarks.coverage`` writes the page of the docs (`virtual`); ``python -m benchmarks.coverage simulated``
and ``python -m benchmarks.coverage real`` print a table each, a row a case.
"""

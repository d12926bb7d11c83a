"""What `validation.py` is made of: sets of measured wheels, rows of runs, theories, tables and figures."""

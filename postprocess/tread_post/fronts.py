"""What many runs of one scene say together: the Pareto front of cost and error, and the cheapest that will do."""

import math


def pareto_front(rows, cost, error):
    """Returns the rows that no other beats in both cost and error, the cheapest first. Skips rows whose cost or error is not a number."""
    front, best = [], math.inf
    known = [row for row in rows if math.isfinite(cost(row)) and math.isfinite(error(row))]
    for row in sorted(known, key=lambda row: (cost(row), error(row))):
        if error(row) < best:
            front.append(row)
            best = error(row)
    return front


def cheapest_within(rows, tolerance, cost, error):
    """The cheapest of `rows` whose error is at most `tolerance`; None if there is none."""
    return min((row for row in rows if error(row) <= tolerance and math.isfinite(cost(row))), key=cost, default=None)


def times_cheaper(dear, cheap):
    """How many times, in two digits."""
    return f"{float(f'{dear / cheap:.2g}'):g}"

# SPDX-License-Identifier: Apache-2.0
"""The arithmetic behind the numbers: medians, paired ratios with an interval, growth."""
import math
import statistics


def median(values):
    return statistics.median(values)


def median_interval(values, confidence=0.95):
    """(low, high), two of the values, between which the median of what they are samples of lies.

    From order statistics, whatever the distribution: the number of values below the median is
    binomial with p = 1/2. With too few values for the confidence, the smallest and the largest.
    """
    ordered = sorted(values)
    n = len(ordered)
    tail, rank = 0.0, 0  # rank values are cut off at each end
    while rank < n // 2:
        tail += math.comb(n, rank) * 0.5 ** n
        if 2 * tail > 1 - confidence:
            break
        rank += 1
    # The interval from the rank-th to the (n + 1 - rank)-th value, counted from 1.
    rank = max(rank, 1)
    return ordered[rank - 1], ordered[n - rank]


def paired_ratio(numerators, denominators, confidence=0.95):
    """(median, low, high) of numerators[i] / denominators[i]: measured side by side, so that what
    disturbs both cancels."""
    if len(numerators) != len(denominators) or not numerators:
        raise ValueError(f"{len(numerators)} values beside {len(denominators)}")
    ratios = [a / b for a, b in zip(numerators, denominators)]
    return (median(ratios), *median_interval(ratios, confidence))


def is_slower(ratio, limit=1.03):
    """Whether a paired ratio (median, low, high) of new over old time shows a slowdown beyond the
    limit: the median is over it, and the interval leaves no doubt that it is slower at all."""
    middle, low, _ = ratio
    return middle > limit and low > 1


def log_fit(sizes, values):
    """(exponent, factor) of values = factor * sizes^exponent, least squares of the logarithms."""
    xs = [math.log(x) for x in sizes]
    ys = [math.log(y) for y in values]
    if len(xs) < 2:
        raise ValueError("a line needs two points")
    x_mean, y_mean = statistics.fmean(xs), statistics.fmean(ys)
    spread = math.fsum((x - x_mean) ** 2 for x in xs)
    exponent = math.fsum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys)) / spread
    return exponent, math.exp(y_mean - exponent * x_mean)


def first_of_last_decade(sizes):
    """Where, of ascending sizes, those begin that are a tenth of the last one or more; two at
    least."""
    first = next(i for i, size in enumerate(sizes) if 10 * size >= sizes[-1])
    return max(0, min(first, len(sizes) - 2))


def steepest_step(sizes, values):
    """(exponent, from size, to size) where the values grow fastest from one size to the next."""
    steps = [(math.log(values[i + 1] / values[i]) / math.log(sizes[i + 1] / sizes[i]),
              sizes[i], sizes[i + 1]) for i in range(len(sizes) - 1)]
    return max(steps)


def seconds_to(points, error):
    """When the error is reached, between two points on the straight line of their logarithms; None
    beyond the last one."""
    best = None
    for a, b in zip(points, points[1:]):
        if a["error"] > error >= b["error"]:
            share = math.log(a["error"] / error) / math.log(a["error"] / b["error"])
            best = a["seconds"] * (b["seconds"] / a["seconds"]) ** share
    return best if best or points[0]["error"] > error else points[0]["seconds"]

#!/usr/bin/env python3
"""What one core of this machine can do at most, by which to read `timbre spectrum --timings`:
python3 benchmarks/machine_limits.py"""
import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy looks

import time

import numpy as np

ROUNDS = 5
MEGABYTES = 200


def shortest(work):
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def read_rate():
    """GB/s of a sum over memory that no cache holds."""
    numbers = np.ones(MEGABYTES * 125_000)
    return numbers.nbytes / shortest(lambda: numbers.max()) / 1e9


def copy_rate():
    """GB/s read and written, into pages that are there already."""
    source, target = np.ones(MEGABYTES * 125_000), np.ones(MEGABYTES * 125_000)
    return 2 * source.nbytes / shortest(lambda: np.copyto(target, source)) / 1e9


def fresh_page_rate():
    """GB/s written to memory for the first time: the system clears each page before."""
    return MEGABYTES * 1e6 / shortest(lambda: np.ones(MEGABYTES * 125_000)) / 1e9


def multiplication_rate(rows, columns):
    """GFlop/s of A^T B."""
    A, B = np.ones((rows, columns)), np.ones((rows, columns))
    return 2 * rows * columns**2 / shortest(lambda: A.T @ B) / 1e9


def main():
    print(f"reading memory           {read_rate():6.1f} GB/s")
    print(f"copying memory           {copy_rate():6.1f} GB/s, read and written")
    print(f"fresh pages              {fresh_page_rate():6.1f} GB/s")
    print(f"DGEMM, 1500 x 1500       {multiplication_rate(1500, 1500):6.1f} GFlop/s")
    print(f"DGEMM, 50000 x 8, A^T B  {multiplication_rate(50_000, 8):6.1f} GFlop/s")


if __name__ == "__main__":
    main()

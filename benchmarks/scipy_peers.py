#!/usr/bin/env python3
"""scipy's eigsh as two packages call it, on one pair of matrices; spectrum_peers.py calls it.

scipy_peers.py SOLVER FOLDER K SHIFT OUT, with the files of spectrum_peers.cpp. SOLVER:
  pyfm  pyFM: eigsh inverts by itself (SuperLU)
  lapy  LaPy: a factor of splu, handed to eigsh
Both leave the tolerance at 0, full precision."""
import json
import sys
import time

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg


PARTS = ("data", "indices", "indptr")  # of a sparse matrix; symmetric, so rows are columns


def read_sparse(folder, name):
    return sparse.csc_matrix(tuple(np.load(f"{folder}/{name}_{part}.npy") for part in PARTS))


def solve_as_pyfm(W, M, count, shift):
    return linalg.eigsh(W, k=count, M=M, sigma=shift)


def solve_as_lapy(W, M, count, shift):
    factor = linalg.splu(W - shift * M)
    inverse = linalg.LinearOperator(matvec=factor.solve, shape=W.shape, dtype=W.dtype)
    return linalg.eigsh(W, count, M, sigma=shift, OPinv=inverse)


SOLVERS = {"pyfm": solve_as_pyfm, "lapy": solve_as_lapy}


def peak_megabytes():
    """Not ru_maxrss, which a process inherits from the one that started it."""
    with open("/proc/self/status") as status:
        line = next(line for line in status if line.startswith("VmHWM:"))
    return int(line.split()[1]) * 1024 / 1e6


def main():
    solver, folder, count, shift, output = sys.argv[1:]
    W, M = read_sparse(folder, "W"), read_sparse(folder, "M")
    start = time.process_time()
    values, vectors = SOLVERS[solver](W, M, int(count), float(shift))
    taken = {"cpu_seconds": time.process_time() - start, "peak_megabytes": peak_megabytes()}
    np.save(f"{output}.values.npy", values)
    np.save(f"{output}.vectors.npy", vectors)
    with open(f"{output}.json", "w") as file:
        json.dump(taken, file)


if __name__ == "__main__":
    main()

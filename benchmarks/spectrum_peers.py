#!/usr/bin/env python3
"""Times timbre's spectrum against its peers on the same matrices; docs/benchmarks.md explains.

    python3 benchmarks/spectrum_peers.py -o FOLDER [--case SHAPE,K ...]

Prints a table, and writes FOLDER/spectrum_peers.md, .json and .svg."""
import argparse
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

import numpy as np
import scipy
from scipy.sparse import csc_matrix, csgraph, diags

from dot_plot import Dot, dot_plot
from scipy_peers import PARTS, SOLVERS, read_sparse

HERE = pathlib.Path(__file__).resolve().parent
LABELS = {
    "timbre": "timbre, certified",
    "pyfm": "scipy as pyFM calls it",
    "lapy": "scipy as LaPy calls it",
    "spectra-simplicial": "Spectra + SimplicialLDLT",
    "spectra-cholmod": "Spectra + CHOLMOD",
    "arpack-cholmod": "ARPACK + CHOLMOD",
}
SHIFT = -0.01  # of pyFM and LaPy; it suits unit area, to which all surfaces are scaled
LARGEST_RESIDUAL = 1e-6
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
COLUMNS_AT_ONCE = 32


def call_timbre(build, *words):
    """What it prints; a failure, which it explains itself, ends this program too."""
    done = subprocess.run([build / "cli" / "timbre", *words], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    return done.stdout.strip()


# ---- Matrices

def make_mesh(build, shape, folder):
    """The file of a shape: ellipsoid:N and SPECIES:N are made, anything else is a file."""
    kind, _, vertices = shape.partition(":")
    if not vertices.isdigit():
        return shape
    if kind == "ellipsoid":
        mesh = folder / "ellipsoid.ply"
        words = ["ellipsoid", "-o", mesh]
    else:
        mesh = folder / "remeshed" / f"{kind}0.ply"
        words = ["creatures", "-o", folder, "--species", kind, "--sets", "remeshed", "--poses", "2"]
    call_timbre(build, "dataset", "make", *words, "--resolution", vertices, "-q")
    return mesh


def write_sparse(folder, name, matrix):
    for part in PARTS:
        np.save(folder / f"{name}_{part}.npy", getattr(matrix, part))


def write_matrices(build, mesh, mass, folder):
    """W, M, positions and component of the surface scaled to unit area; its vertices."""
    call_timbre(build, "spectrum", mesh, "-k", "2", "--mass", mass, "-o", folder / "spectrum.npz",
                "-q")
    arrays = np.load(folder / "spectrum.npz")
    lumped = arrays["mass"]
    if lumped.min() <= 0.0:
        sys.exit(f"{mesh}: has vertices without a part in the spectrum; peers need a positive mass")
    W = csc_matrix(tuple(arrays[f"W_{part}"] for part in PARTS))
    M = (diags(lumped).tocsc() if mass == "lumped" else
         csc_matrix(tuple(arrays[f"M_{part}"] for part in PARTS)))
    area = lumped.sum()
    write_sparse(folder, "W", W)
    write_sparse(folder, "M", M / area)
    np.save(folder / "positions.npy", arrays["vertices"] / np.sqrt(area))
    np.save(folder / "component.npy", csgraph.connected_components(W, directed=False)[1])
    return len(lumped)


# ---- Runs

def limit_processor_time(seconds):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))


def run_solver(build, solver, folder, count, limit):
    """One process; what it took, or why it gave nothing."""
    program = ([sys.executable, HERE / "scipy_peers.py"] if solver in SOLVERS else
               [build / "benchmarks" / "spectrum_peers"])
    done = subprocess.run([*program, solver, folder, str(count), str(SHIFT), folder / "found"],
                          capture_output=True, text=True, env={**os.environ, **ONE_THREAD},
                          preexec_fn=lambda: limit_processor_time(limit))
    if done.returncode == -signal.SIGXCPU:
        return {"failure": f"> {limit} s", "at_least": limit}
    if done.returncode != 0:
        return {"failure": (done.stderr.strip() or f"exit {done.returncode}").splitlines()[-1]}
    return json.loads((folder / "found.json").read_text())


def check(W, M, folder):
    """The same for all solvers: sorted values, worst residual, and how far from orthonormal."""
    values = np.load(folder / "found.values.npy").ravel()
    vectors = np.load(folder / "found.vectors.npy", mmap_mode="r")
    lumped = np.asarray(M.sum(axis=1)).ravel()
    residuals, deviations = [], []
    for first in range(0, len(values), COLUMNS_AT_ONCE):
        columns = slice(first, first + COLUMNS_AT_ONCE)
        X, l = vectors[:, columns], values[columns]
        MX = M @ X
        errors = np.sqrt(np.sum((W @ X - MX * l) ** 2 / lumped[:, None], axis=0))
        norms = np.sqrt(np.sum(X * MX, axis=0))
        residuals.append(np.max(errors / ((np.abs(l) + values.max()) * norms)))
        gram = vectors.T @ MX - np.eye(len(values), len(l), -first)
        deviations.append(np.max(np.abs(gram)))
    # Maxima of numpy, which NaN passes through.
    return {"values": np.sort(values), "residual": np.max(residuals),
            "orthonormality": np.max(deviations)}


def run_and_check(solver, W, M, folder, count, options):
    run = run_solver(options.build, solver, folder, count, options.limit)
    if "failure" in run:
        return run
    run |= check(W, M, folder)
    if not run["residual"] <= LARGEST_RESIDUAL:
        run["failure"] = f"residual {run['residual']:.0e}"
    return run


def run_rounds(W, M, folder, count, options):
    """All solvers in turn, again and again; the best of each, or its first failure."""
    best = {}
    for number in range(1, options.rounds + 1):
        for solver in options.solvers:
            if "failure" in best.get(solver, {}):
                continue
            print(f"round {number}: {solver}", file=sys.stderr)
            run = run_and_check(solver, W, M, folder, count, options)
            if ("failure" in run or solver not in best or
                    run["cpu_seconds"] < best[solver]["cpu_seconds"]):
                best[solver] = run
    return best


def compare_with_timbre(runs):
    """The largest distance of eigenvalues, over l + l_k as in residuals; takes their place."""
    values = {solver: run.pop("values") for solver, run in runs.items() if "values" in run}
    theirs = values.pop("timbre", None)
    if theirs is None:
        return
    for solver, mine in values.items():
        runs[solver]["difference"] = np.max(np.abs(mine - theirs) / (theirs + theirs[-1]))


def run_case(shape, count, options):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print(f"{shape}, k = {count}", file=sys.stderr)
        mesh = make_mesh(options.build, shape, folder)
        vertices = write_matrices(options.build, mesh, options.mass, folder)
        W, M = read_sparse(folder, "W"), read_sparse(folder, "M")
        runs = run_rounds(W, M, folder, count, options)
    compare_with_timbre(runs)
    return {"shape": shape, "vertices": vertices, "count": count, "runs": runs}


# ---- Answers

def title(result):
    name = pathlib.Path(result["shape"]).name.partition(":")[0]
    return f"{name}, {result['vertices']:,} vertices, k = {result['count']}"


def ratio(run, reference):
    """To the processor seconds of timbre; empty for timbre itself, or if it has none."""
    if run is reference or "failure" in reference:
        return ""
    return f"{run['cpu_seconds'] / reference['cpu_seconds']:.1f}\u00d7"


def table_row(solver, run, reference):
    if "failure" in run:
        return [LABELS[solver], run["failure"], "", "", "", "", ""]
    difference = f"{run['difference']:.0e}" if "difference" in run else ""
    return [LABELS[solver], f"{run['cpu_seconds']:.2f}", ratio(run, reference),
            f"{run['peak_megabytes']:.0f}", f"{run['residual']:.0e}",
            f"{run['orthonormality']:.0e}", difference]


def table_line(cells):
    return "| " + " | ".join(cells) + " |"


def to_markdown(results):
    header = ["", "CPU s", "ratio", "peak MB", "residual", "orthonormal to",
              "values differ by"]
    lines = []
    for result in results:
        runs = result["runs"]
        lines += [f"**{title(result)}**", "", table_line(header), table_line(["---"] * len(header))]
        lines += [table_line(table_row(solver, runs[solver], runs["timbre"])) for solver in runs]
        lines.append("")
    return "\n".join(lines)


def to_dot(solver, run, reference):
    label = LABELS[solver]
    if "failure" in run:
        return Dot(label, run.get("at_least"), run["failure"], at_least=True)
    seconds = run["cpu_seconds"]
    note = filter(None, [f"{seconds:.3g} s", ratio(run, reference)])
    return Dot(label, seconds, ", ".join(note))


def to_plot(results):
    groups = [(title(result), [to_dot(solver, run, result["runs"]["timbre"])
                               for solver, run in result["runs"].items()]) for result in results]
    return dot_plot("Lowest eigenpairs: processor seconds on one thread", groups, "s")


def write_answers(options, results):
    options.output.mkdir(parents=True, exist_ok=True)
    version = call_timbre(options.build, "--version").splitlines()[0]
    answer = {"timbre": version, "scipy": scipy.__version__, "numpy": np.__version__,
              "mass": options.mass, "rounds": options.rounds, "cases": results}
    stem = options.output / "spectrum_peers"
    stem.with_suffix(".json").write_text(json.dumps(answer, indent=1) + "\n")
    stem.with_suffix(".md").write_text(to_markdown(results), encoding="utf-8")
    stem.with_suffix(".svg").write_text(to_plot(results), encoding="utf-8")


# ---- Command line

def case(words):
    shape, comma, count = words.rpartition(",")
    if not comma or not count.isdigit() or int(count) < 2:
        raise argparse.ArgumentTypeError(f"'{words}' is not SHAPE,K with K of 2 or more")
    return shape, int(count)


def solver_list(words):
    chosen = ["timbre"] + [word for word in words.split(",") if word != "timbre"]
    if not set(chosen) <= LABELS.keys():
        raise argparse.ArgumentTypeError(f"choose among {', '.join(LABELS)}")
    return chosen


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True,
                        help="folder of the results")
    parser.add_argument("--case", dest="cases", type=case, action="append", metavar="SHAPE,K",
                        help="K pairs of ellipsoid:N or SPECIES:N (about N vertices; species as in "
                             "'timbre dataset make creatures') or of a mesh file; may be repeated")
    parser.add_argument("--solvers", type=solver_list, default=list(LABELS), metavar="A,B,...",
                        help=f"timbre and some of {', '.join(list(LABELS)[1:])}")
    parser.add_argument("--rounds", type=int, default=3, help="of which the best counts (3)")
    parser.add_argument("--limit", type=int, default=600,
                        help="processor seconds after which a solver is stopped (600)")
    parser.add_argument("--mass", choices=("lumped", "consistent"), default="lumped")
    parser.add_argument("--build", type=pathlib.Path, default=HERE.parent / "build" / "release",
                        help="folder of the build (build/release)")
    options = parser.parse_args()
    options.cases = options.cases or [("gorilla:6700", 100), ("gorilla:6700", 300),
                                      ("gorilla:33000", 100)]
    return options


def main():
    options = parse_options()
    results = []
    for shape, count in options.cases:
        results.append(run_case(shape, count, options))
        write_answers(options, results)  # after each: a long run may be interrupted
    print(to_markdown(results), end="")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Kills `timbre db add` at different moments: what it acknowledged must be there.

kill_test.py TIMBRE [ROUNDS]"""
import json
import pathlib
import subprocess
import sys
import tempfile

import shapes

COUNT = 16


def run(*args):
    done = subprocess.run(args, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{args}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def add_until_killed(timbre, database, files, lines, threads):
    """Starts adding, kills after so many acknowledged lines, returns the names acknowledged."""
    process = subprocess.Popen([timbre, "db", "add", database, *files, "-k", "40",
                                "--threads", str(threads)],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    names = [process.stdout.readline().split()[1] for _ in range(lines)]
    process.kill()
    # Lines already in the pipe were acknowledged too; the last may be torn.
    for line in process.stdout.read().splitlines(keepends=True):
        if line.endswith("\n"):
            names.append(line.split()[1])
    process.wait()
    return names


def check(timbre, database, acknowledged):
    stored = {shape["name"] for shape in json.loads(run(timbre, "db", "list", database, "--json"))["shapes"]}
    missing = set(acknowledged) - stored
    if missing:
        sys.exit(f"acknowledged but not stored: {sorted(missing)}")
    report = json.loads(run(timbre, "db", "verify", database, "--json"))
    if report["damaged"] or report["checked"] != len(stored):
        sys.exit(f"verify: {report}")


def main():
    timbre, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        files = shapes.write_tori(folder, COUNT)
        expected = None
        for number in range(rounds):
            database = str(folder / f"{number}.timbre")
            killed_after = number % (COUNT - 1)
            acknowledged = add_until_killed(timbre, database, files, killed_after, 1 + number % 2)
            if pathlib.Path(database).exists():
                check(timbre, database, acknowledged)
            elif acknowledged:
                sys.exit("acknowledged, but there is no database")
            resumed = run(timbre, "db", "add", database, *files, "-k", "40").splitlines()
            for shape in acknowledged:
                if f"kept {shape}" not in resumed:
                    sys.exit(f"round {number}: '{shape}' was not kept: {resumed}")
            check(timbre, database, [pathlib.Path(file).stem for file in files])
            print(f"round {number}: killed after {len(acknowledged)} of {COUNT}")
            listing = run(timbre, "db", "list", database)
            if expected not in (None, listing):
                sys.exit("the resumed database differs from an earlier one")
            expected = listing


if __name__ == "__main__":
    main()

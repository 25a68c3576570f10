#!/usr/bin/env python3
"""Judges retrieval, maps and symmetry on creatures by their exact truth: a change that makes
answers worse fails here. The bounds lie a little below what the methods reach.

quality_test.py TIMBRE"""
import json
import subprocess
import sys
import tempfile

timbre = sys.argv[1]
SPECIES = "person,wrestler,gorilla,horse,dog,cat"
failures = []


def run(*words):
    done = subprocess.run([timbre, *words, "--json", "-q"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"timbre {' '.join(words)}: {done.stderr}")
    return json.loads(done.stdout)


def judge(what, value, at_least=None, at_most=None):
    good = (at_least is None or value >= at_least) and (at_most is None or value <= at_most)
    bound = f">= {at_least}" if at_least is not None else f"<= {at_most}"
    print(f"{'ok  ' if good else 'FAIL'} {what}: {value:.4f} ({bound})")
    if not good:
        failures.append(what)


with tempfile.TemporaryDirectory() as folder:
    shapes, database = f"{folder}/creatures/remeshed", f"{folder}/creatures.timbre"
    run("dataset", "make", "creatures", "-o", f"{folder}/creatures", "--sets", "remeshed",
        "--species", SPECIES, "--poses", "3")
    files = [f"{shapes}/{line.split()[0]}" for line in open(f"{shapes}/labels.txt")]
    run("db", "add", database, *files, "--labels", f"{shapes}/labels.txt")
    for channel, bound in (("dna_log", 0.84), ("dna_weyl", 0.79), ("dna_raw", 0.95)):
        judge(f"mAP of {channel}", run("eval", "retrieval", database, "--channel", channel)["map"],
              at_least=bound)
    maps = run("eval", "match", shapes, "-n", "5", "--samples", "600")
    judge("maps found", maps["found"], at_least=1.0)
    judge("mean error of maps", maps["mean_error"], at_most=2.0)
    judge("maps with sides exchanged", maps["flipped"], at_most=0.0)
    plain = run("eval", "match", shapes, "-n", "5", "--method", "functional", "--samples", "300")
    judge("sides exchanged by descriptors alone", plain["flipped"], at_least=0.2)
    mirrors = run("eval", "match", shapes, "-n", "2", "--kind", "sym", "--samples", "600")
    judge("symmetries found", mirrors["mesh_rate"], at_least=1.0)
    judge("mean error of symmetries", mirrors["mean_error"], at_most=1.3)
sys.exit(bool(failures))

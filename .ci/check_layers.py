#!/usr/bin/env python3
"""Fails when an #include runs against the order of the rooms, or when a
public header pulls in a heavy library."""
import pathlib
import re
import sys

ORDER = [["analysis/core"], ["analysis/mesh"], ["analysis/operators"], ["analysis/spectrum"],
         ["analysis/signatures", "analysis/embedding", "analysis/geodesic", "analysis/filter"],
         ["index", "matching"], ["datasets"], ["cli"]]
RANK = {room: rank for rank, rooms in enumerate(ORDER) for room in rooms}
HEAVY = ("OpenMesh/", "Spectra/", "flann/", "ceres/", "embree", "suitesparse/", "cholmod",
         "Eigen/CholmodSupport", "sqlite3", "CLI/", "nlohmann/", "pybind11/", "openssl/", "zstd",
         "zlib", "cblas")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
SKIPPED = {"build", "tests", "docs", "benchmarks", ".git"}


def room_of(path):
    return next((room for room in RANK if path.startswith(room + "/")), None)


def complaints(root):
    for file in sorted(p for p in root.rglob("*") if p.suffix in (".h", ".cpp")):
        path = file.relative_to(root).as_posix()
        here = room_of(path)
        if here is None or path.split("/")[0] in SKIPPED:
            continue
        private = file.suffix == ".cpp" or "detail" in file.parts or here == "cli"
        for number, line in enumerate(file.read_text().splitlines(), 1):
            hit = INCLUDE.match(line)
            if not hit:
                continue
            there = room_of(hit[1].removeprefix("timbre/"))
            if there and there != here and RANK[there] >= RANK[here]:
                yield f"{path}:{number}: {here} may not know {there}"
            elif there and there != here and "/detail/" in hit[1]:
                yield f"{path}:{number}: {hit[1]} is private to {there}"
            elif not private and hit[1].startswith(HEAVY):
                yield f"{path}:{number}: public header includes {hit[1]}"


found = list(complaints(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))
print("\n".join(found), end="\n" if found else "")
sys.exit(bool(found))

#!/usr/bin/env python3
"""timbre distance: sources, results, errors.

distance_test.py TIMBRE"""
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest
import zipfile

import command_test
import numpy_file
import shapes

TIMBRE = os.path.abspath(sys.argv.pop(1))
command_test.CommandTest.TIMBRE = TIMBRE


class Distance(command_test.CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.put("square.off", shapes.square_off(8))

    def run_timbre(self, *args, **options):
        return super().run_timbre("distance", *args, **options)

    def refuse(self, *args, code=1, words=""):
        done = self.run_timbre(*args, code=code)
        self.assertEqual(done.stdout, b"")
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertIn(words.encode(), done.stderr)

    def test_the_example_of_the_help_works(self):
        text = self.run_timbre("--help").stdout.decode()
        words = text.split("Example:\n")[1].split("\n")[0].split()
        self.assertEqual(words[:2], ["timbre", "distance"])
        os.rename(self.mesh, self.path("horse.off"))
        words = [word.replace("horse.ply", "horse.off") for word in words[2:]]
        self.run_timbre(*words, cwd=self.folder)
        header, values = numpy_file.read((self.folder / "horse_distances.npy").read_bytes())
        self.assertIn("'fortran_order': True, 'shape': (81, 2)", header)
        self.assertEqual(len(values), 162)
        self.assertEqual((values[0], values[81 + 17]), (0.0, 0.0))
        self.assertAlmostEqual(values[80], math.sqrt(2), 14)

    def test_each_line_is_a_source_of_one_or_more_vertices(self):
        sources = self.put("s.txt", "# corners\n0\n\n 0, 80  8# three\r\n72")
        for method in ("exact", "graph", "heat"):
            rows = self.run_timbre(self.mesh, "--sources", sources, "--method", method).stdout.decode().splitlines()
            table = [[float(x) for x in row.split()] for row in rows]
            self.assertEqual((len(table), len(table[0])), (81, 3))
            self.assertEqual([table[0][0], table[80][1], table[8][1], table[72][2]], [0, 0, 0, 0])
            self.assertLess(abs(table[80][0] - math.sqrt(2)), 0.1 if method == "heat" else 1e-12)

    def test_the_same_numbers_in_every_format_and_for_any_threads(self):
        sources = self.put("s.txt", "\n".join(str(i) for i in range(20)))
        text = self.run_timbre(self.mesh, "--sources", sources, "-o", "-").stdout
        self.run_timbre(self.mesh, "--sources", sources, "-o", self.path("a.txt"), "--threads", "1")
        self.assertEqual(pathlib.Path(self.path("a.txt")).read_bytes(), text)
        self.run_timbre(self.mesh, "--sources", sources, "-o", self.path("a.npy"), "--threads", "3")
        header, values = numpy_file.read(pathlib.Path(self.path("a.npy")).read_bytes())
        rows = [[float(x) for x in row.split()] for row in text.decode().splitlines()]
        self.assertEqual([values[81 * j + i] for i in range(81) for j in range(20)], sum(rows, []))
        self.run_timbre(self.mesh, "--sources", sources, "-o", self.path("a.npz"))
        with zipfile.ZipFile(self.path("a.npz")) as archive:
            self.assertEqual(numpy_file.read(archive.read("distances.npy")), (header, values))

    def test_one_source_is_a_vector(self):
        self.run_timbre(self.mesh, "--vertices", "3", "-o", self.path("a.npy"))
        self.assertIn("'shape': (81,)", numpy_file.read(pathlib.Path(self.path("a.npy")).read_bytes())[0])

    def test_json(self):
        mesh = self.put("two.off", shapes.square_off(8).replace("81 128 0", "82 128 0").replace("1.0 1.0 0\n", "1.0 1.0 0\n9 9 9\n"))
        answer = json.loads(self.run_timbre(mesh, "--vertices", "0,80", "--json").stdout)
        self.assertEqual((answer["method"], answer["vertices"], answer["sources"]), ("exact", 82, 2))
        self.assertEqual(answer["reached"], 162)
        self.assertAlmostEqual(answer["longest"], math.sqrt(2), 14)
        self.assertEqual(answer["values"][81], [None, None])
        self.assertLessEqual({"read", "distances"}, set(answer["timings"]))
        out = self.path("a.npy")
        answer = json.loads(self.run_timbre(mesh, "--vertices", "81", "--method", "heat", "--json", "-o", out).stdout)
        self.assertEqual((answer["reached"], answer["longest"], answer["output"]), (1, 0, out))
        self.assertNotIn("values", answer)

    def test_bad_sources_are_told_with_their_line(self):
        def refuse(text, words):
            path = self.put("s.txt", text)
            self.refuse(self.mesh, "--sources", path, "-o", self.path("a.npy"), words=f"timbre: {path}: {words}\n")
        refuse("0\n1 x\n", "line 2: 'x' is no vertex; 0 is the first")
        refuse("0\n\n-1\n", "line 3: '-1' is no vertex; 0 is the first")
        refuse("99999999999\n", "line 1: '99999999999' is no vertex; 0 is the first")
        refuse("0\n3 81\n", "line 2: vertex 81 does not exist; the mesh has 81")
        refuse("# nothing\n\n", "sources: none given; a line of vertex numbers is wanted for each column of the result")
        self.refuse(self.mesh, "--sources", self.path("none.txt"), words="No such file")
        self.refuse(self.mesh, "--vertices", "0,81", code=2, words="--vertices: vertex 81 does not exist; the mesh has 81")
        self.refuse(self.mesh, "--vertices", "a", code=2, words="--vertices: 'a' is no vertex")
        self.refuse(self.mesh, code=2)
        self.refuse(self.mesh, "--vertices", "0", "--sources", "x", code=2)
        self.assertEqual(sorted(os.listdir(self.folder)), ["s.txt", "square.off"])

    def test_results_need_force_to_replace(self):
        for name in ("a.npy", "a.npz", "a.txt"):
            out = self.put(name, "old")
            self.refuse(self.path("none.off"), "--vertices", "0", "-o", out, code=2, words="exists already")
            self.run_timbre(self.mesh, "--vertices", "0", "-o", out, "--force")
            self.assertNotEqual(pathlib.Path(out).read_bytes(), b"old")
        self.refuse(self.mesh, "--vertices", "0", "-o", self.path("a.doc"), code=2, words="ending '.doc' is unknown")
        self.refuse(self.mesh, "--vertices", "0", "-o", "-", "--json", code=2, words="standard output cannot hold both")

    def test_interrupted_it_leaves_no_file(self):
        mesh = self.put("large.off", shapes.torus_off(2.0, 0.7, 500, 200))
        sources = self.put("s.txt", "\n".join(str(i) for i in range(1000)))
        before = sorted(os.listdir(self.folder))
        for method in ("exact", "heat", "graph"):
            process = subprocess.Popen([TIMBRE, "distance", mesh, "--sources", sources, "--method", method,
                                        "-o", self.path("a.npy")], stderr=subprocess.PIPE)
            time.sleep(2.0)
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=20)
            self.assertEqual(process.returncode, 130, err)
            self.assertEqual(sorted(os.listdir(self.folder)), before)


if __name__ == "__main__":
    unittest.main()

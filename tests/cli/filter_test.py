#!/usr/bin/env python3
"""timbre filter: coordinates, functions, orders and regions; errors.

filter_test.py TIMBRE"""
import json
import math
import os
import pathlib
import sys
import unittest
import zipfile

import command_test
import numpy_file
import shapes

command_test.CommandTest.TIMBRE = os.path.abspath(sys.argv.pop(1))


def read_off(data):
    """The coordinates."""
    lines = data.decode().split("\n")
    return [[float(x) for x in line.split()] for line in lines[2:2 + int(lines[1].split()[0])]]


def table(data):
    return [[float(x) for x in line.split()] for line in data.decode().splitlines()]


class Filter(command_test.CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.put("torus.off", shapes.torus_off(2.0, 0.7, 24, 12))
        self.square = self.put("square.off", shapes.square_off(8))

    def run_timbre(self, *args, **options):
        return super().run_timbre("filter", *args, **options)

    def figures(self, *args):
        return json.loads(self.run_timbre(*args, "--json").stdout)

    def refuse(self, *args, code=2, words=""):
        done = self.run_timbre(*args, code=code)
        self.assertEqual(done.stdout, b"")
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertIn(words.encode(), done.stderr)

    def test_the_example_of_the_help_works(self):
        text = super().run_timbre("filter", "--help").stdout.decode()
        words = text.split("Example:\n")[1].split("\n")[0].split()
        self.assertEqual(words[:2], ["timbre", "filter"])
        os.rename(self.mesh, self.path("horse.off"))
        words = [word.replace("horse.ply", "horse.off") for word in words[2:]]
        done = self.run_timbre(*words, cwd=self.folder)
        self.assertIn(b"changed by ", done.stdout)
        self.assertIn(b"wrote horse_60.ply\n", done.stdout)
        info = json.loads(super().run_timbre("info", self.path("horse_60.ply"), "--json").stdout)
        self.assertEqual((info["vertices"], info["faces"]), (288, 576))

    def test_all_eigenfunctions_give_the_mesh_back(self):
        self.run_timbre(self.square, "--low-pass", "81", "-o", self.path("all.off"))
        there, here = (read_off(pathlib.Path(p).read_bytes()) for p in (self.square, self.path("all.off")))
        self.assertLess(max(abs(a - b) for p, q in zip(here, there) for a, b in zip(p, q)), 1e-10)

    def test_more_eigenfunctions_miss_less(self):
        errors = self.figures(self.mesh, "--coefficients", "-k", "60")["errors"]
        self.assertEqual((len(errors), errors[1]), (61, 1.0))
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertLess(errors[60], 0.1)
        for count in (4, 30):
            self.assertAlmostEqual(self.figures(self.mesh, "--low-pass", str(count))["change"], errors[count], 9)

    def test_a_multiple_eigenvalue_stays_whole(self):
        # Two equal components: all but rounding is double.
        lines = shapes.square_off(8).split("\n")
        points, faces = lines[2:83], lines[83:-1]
        other = [" ".join(["3"] + [str(int(v) + 81) for v in face.split()[1:]]) for face in faces]
        mesh = self.put("two.off", "\n".join(["OFF", "162 256 0"] + points + points + faces + other) + "\n")
        self.run_timbre(mesh, "--low-pass", "1", "-o", self.path("a.off"))
        for place in read_off(pathlib.Path(self.path("a.off")).read_bytes()):
            for found, mean in zip(place, (0.5, 0.5, 0.0)):  # both components, not one alone
                self.assertAlmostEqual(found, mean, 12)

    def test_a_band_and_its_stop_add_up(self):
        band, stop = (table(self.run_timbre(self.mesh, option, "3,9", "--function", self.coordinates()).stdout)
                      for option in ("--band", "--stop"))
        there = read_off(pathlib.Path(self.mesh).read_bytes())
        for p, q, r in zip(band, stop, there):
            for a, b, c in zip(p, q, r):
                self.assertAlmostEqual(a + b, c, 12)

    def coordinates(self):
        return self.put("xyz.txt", "\n".join(" ".join(map(repr, p)) for p in
                                             read_off(pathlib.Path(self.mesh).read_bytes())))

    def test_smoothing_is_the_transfer_of_the_heat_equation(self):
        # A steep table of e^(-0.002 lambda): as near as straight lines are.
        rows = "\n".join(f"{x} {math.exp(-0.002 * x)!r}" for x in range(0, 3000, 2))
        file = self.put("heat.txt", rows)
        by_time = self.figures(self.mesh, "--smooth", "0.002", "-k", "150")
        by_table = self.figures(self.mesh, "--transfer", file, "-k", "150")
        self.assertAlmostEqual(by_time["change"], by_table["change"], 6)
        self.assertGreater(by_time["change"], 0.01)

    def test_the_result_does_not_depend_on_the_unit_of_length(self):
        large = self.put("large.off", shapes.torus_off(2000.0, 700.0, 24, 12))
        self.assertAlmostEqual(self.figures(large, "--smooth", "0.01")["change"],
                               self.figures(self.mesh, "--smooth", "0.01")["change"], 9)

    def test_the_detail_goes_where_it_is_told(self):
        change = {word: self.figures(self.mesh, "--smooth", "0", "-k", "20", "--detail", word)
                  for word in ("last", "keep", "drop")}
        self.assertEqual({word: figures["detail"] for word, figures in change.items()},
                         {"last": 1, "keep": 1, "drop": 0})
        self.assertEqual((change["last"]["change"], change["keep"]["change"]), (0, 0))
        self.assertAlmostEqual(change["drop"]["change"], change["drop"]["errors"][-1], 12)
        warm = self.figures(self.mesh, "--smooth", "0.01", "-k", "20")
        self.assertTrue(0 < warm["detail"] < 1)

    def test_coefficients_fit_the_eigenfunctions_of_spectrum(self):
        self.run_timbre(self.square, "--coefficients", "-k", "81", "-o", self.path("c.npz"))
        super().run_timbre("spectrum", self.square, "-k", "81", "-o", self.path("s.npz"))
        with zipfile.ZipFile(self.path("c.npz")) as archive:
            header, c = numpy_file.read(archive.read("coefficients.npy"))
            self.assertEqual({name[:-4] for name in archive.namelist()},
                             {"coefficients", "eigenvalues", "energies", "errors"})
        self.assertIn("'fortran_order': True, 'shape': (81, 3)", header)
        with zipfile.ZipFile(self.path("s.npz")) as archive:
            _, phi = numpy_file.read(archive.read("evecs.npy"))
        for v, place in enumerate(read_off(pathlib.Path(self.square).read_bytes())):
            x = sum(phi[81 * i + v] * c[i] for i in range(81))
            self.assertAlmostEqual(x, place[0], 10)

    def test_a_function_is_filtered_into_any_format(self):
        values = self.put("f.txt", "\n".join(str(i % 7) for i in range(288)))
        text = self.run_timbre(self.mesh, "--low-pass", "5", "--function", values).stdout
        self.assertEqual((len(table(text)), len(table(text)[0])), (288, 1))
        self.run_timbre(self.mesh, "--low-pass", "5", "--function", values, "-o", self.path("g.npy"))
        header, numbers = numpy_file.read((self.folder / "g.npy").read_bytes())
        self.assertIn("'shape': (288,)", header)
        self.assertEqual([[x] for x in numbers], table(text))
        answer = self.figures(self.mesh, "--low-pass", "5", "--function", values)
        self.assertEqual((answer["values"], answer["columns"], answer["filter"]), (table(text), 1, "low_pass"))
        again = self.run_timbre(self.mesh, "--low-pass", "5", "--function", self.path("g.npy")).stdout
        self.assertLess(max(abs(a[0] - b[0]) for a, b in zip(table(text), table(again))), 1e-10)  # a projection

    def test_the_fiedler_order_runs_along_the_mesh(self):
        lines = shapes.square_off(8).split("\n")
        longer = [f"{4 * float(x)!r} {y} {z}" for x, y, z in (line.split() for line in lines[2:83])]
        mesh = self.put("strip.off", "\n".join(lines[:2] + longer + lines[83:]))
        order = [int(line) for line in self.run_timbre(mesh, "--fiedler").stdout.split()]
        self.assertEqual(sorted(order), list(range(81)))
        self.assertEqual([v // 9 for v in order], [i // 9 for i in range(81)])
        self.run_timbre(mesh, "--fiedler", "-o", self.path("order.npz"))
        with zipfile.ZipFile(self.path("order.npz")) as archive:
            self.assertIn(b"'<i4'", archive.read("order.npy"))
            _, vector = numpy_file.read(archive.read("vector.npy"))
        self.assertEqual([vector[v] for v in order], sorted(vector))
        answer = self.figures(mesh, "--fiedler")
        self.assertEqual(answer["order"], order)
        self.assertAlmostEqual(answer["components"][0]["eigenvalue"], math.pi ** 2 / 16, 1)
        self.assertGreater(answer["components"][0]["gap"], 0.7)

    def test_a_fiedler_order_in_doubt_says_so(self):
        self.assertIn(b"one of many as good", self.run_timbre(self.mesh, "--fiedler").stderr)
        self.assertEqual(self.run_timbre(self.mesh, "--fiedler", "-q").stderr, b"")

    def test_nodal_domains(self):
        answer = self.figures(self.mesh, "--nodal", "1", "-o", self.path("labels.txt"))
        self.assertEqual((answer["domains"], answer["weak_domains"], answer["courant_bound"]), (2, 2, 2))
        labels = (self.folder / "labels.txt").read_text().split()
        self.assertEqual((len(labels), set(labels) - {"-1"}), (288, {"0", "1"}))
        self.assertIn(b"eigenfunction 0: 1 nodal domain, by Courant at most 1\n",
                      self.run_timbre(self.mesh, "--nodal", "0").stdout)
        self.refuse(self.square, "--nodal", "81", words="--nodal: the mesh has only 81 eigenfunctions, from 0")

    def test_output_names_and_force(self):
        self.refuse(self.mesh, "--low-pass", "5", words="the filtered mesh needs a file")
        self.refuse(self.mesh, "--low-pass", "5", "-o", self.path("a.npy"), words="the ending tells the format")
        self.refuse(self.mesh, "--coefficients", "-o", self.path("a.ply"), words="ending '.ply' is unknown")
        self.refuse(self.mesh, "--fiedler", "-o", self.path("a.ply"), words="ending '.ply' is unknown")
        self.refuse(self.mesh, "--low-pass", "5", "-o", "-", "--json", words="standard output cannot hold both")
        out = self.put("a.ply", "old")
        self.refuse(self.path("none.off"), "--low-pass", "5", "-o", out, words="exists already")
        self.assertEqual((self.folder / "a.ply").read_text(), "old")
        self.run_timbre(self.mesh, "--low-pass", "5", "-o", out, "--force")
        self.assertEqual((self.folder / "a.ply").read_bytes(),
                         self.run_timbre(self.mesh, "--low-pass", "5", "-o", "-").stdout)

    def test_tasks_exclude_each_other_and_what_does_not_go_with_them(self):
        self.refuse(self.mesh)
        self.refuse(self.mesh, "--low-pass", "5", "--fiedler")
        self.refuse(self.mesh, "--low-pass", "5", "-k", "7", words="--low-pass")
        self.refuse(self.mesh, "--band", "1,2", "--detail", "keep", words="--band")
        self.refuse(self.mesh, "--fiedler", "--function", "f.txt", words="--fiedler")
        self.refuse(self.mesh, "--band", "9,3", "--json", words="--band: ends before it begins: 9 to 3")
        self.refuse(self.mesh, "--band", "9", "--json")
        self.refuse(self.mesh, "--smooth", "-1", "--json", words="range")
        self.refuse(self.square, "--stop", "80,81", "--json", words="--stop: the mesh has only 81 eigenfunctions")
        self.refuse(self.mesh, "--smooth", "1", "--operator", "p2", "--json", words="--operator: p2 and p3")
        self.refuse(self.square, "--smooth", "1", "--boundary", "dirichlet", "--json", words="--boundary: coordinates")
        self.refuse(self.square, "--fiedler", "--boundary", "dirichlet", words="neumann")

    def test_tables_are_refused_with_their_place(self):
        def refuse(option, text, words):
            path = self.put("t.txt", text)
            self.refuse(self.mesh, option, path, *(["--low-pass", "5"] if option == "--function" else []), "--json",
                        code=1, words=f"timbre: {path}: {words}\n")
        refuse("--transfer", "1\n2\n", "has 1 columns; a transfer function has two, lambda and factor")
        refuse("--transfer", "0 1\n5 x\n", "line 2: 'x' is not a number")
        refuse("--transfer", "0 1\n5 1\n5 0\n", "point 2: lambda 5 is not above 5 before it")
        refuse("--function", "1\n2\n", "has 2 rows, but the mesh has 288 vertices")
        self.assertEqual(sorted(os.listdir(self.folder)), ["square.off", "t.txt", "torus.off"])

    def test_functions_that_are_0_at_the_boundary(self):
        f = self.put("f.txt", "\n".join(repr(math.sin(math.pi * i / 8) * math.sin(math.pi * j / 8))
                                        for i in range(9) for j in range(9)))
        answer = self.figures(self.square, "--low-pass", "1", "--function", f, "--boundary", "dirichlet")
        self.assertLess(answer["change"], 0.02)  # the lowest eigenfunction


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""timbre align: files, a database, what is written, what is refused.

align_test.py TIMBRE"""
import json
import math
import os
import sys
import tempfile
import unittest
import zipfile

import command_test
import numpy_file

TIMBRE = os.path.abspath(sys.argv.pop(1))
command_test.CommandTest.TIMBRE = TIMBRE
COUNT = 20


class Align(command_test.CommandTest):
    @classmethod
    def setUpClass(cls):
        """Three poses of one dog; line i of its .vts is the vertex of point i."""
        cls.shapes = tempfile.TemporaryDirectory()
        maker = command_test.CommandTest()
        maker.run_timbre("dataset", "make", "creatures", "-o", cls.shapes.name, "--species", "dog",
                         "--sets", "shared", "--poses", "3", "--resolution", "1200", "-q")
        folder = os.path.join(cls.shapes.name, "shared")
        cls.dogs = [os.path.join(folder, f"dog{i}.ply") for i in range(3)]

    @classmethod
    def tearDownClass(cls):
        cls.shapes.cleanup()

    def align(self, *args, code=0):
        return self.run_timbre("align", *args, "-k", str(COUNT), "--map-functions", "60", code=code)

    def refuse(self, *args, code=2, words=""):
        done = self.align(*args, code=code)
        self.assertEqual(done.stdout, b"")
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertIn(words.encode(), done.stderr)

    def functions(self, result, mesh):
        """Eigenfunctions at the points that all dogs share."""
        with zipfile.ZipFile(result) as archive:
            header, numbers = numpy_file.read(archive.read("evecs.npy"))
        self.assertIn("'fortran_order': True", header)
        rows = len(numbers) // COUNT
        with open(mesh.replace(".ply", ".vts")) as file:
            vertices = [int(line) - 1 for line in file]
        return [[numbers[i * rows + v] for v in vertices] for i in range(COUNT)]

    @staticmethod
    def cosine(x, y):
        return sum(a * b for a, b in zip(x, y)) / math.sqrt(sum(a * a for a in x) * sum(b * b for b in y))

    def test_poses_share_signs_and_order_with_the_reference(self):
        out = self.path("aligned")
        done = self.align(*self.dogs, "--reference", self.dogs[0], "-o", out, "--json")
        answer = json.loads(done.stdout)
        self.assertEqual(answer["count"], COUNT)
        self.assertEqual([s["mesh"] for s in answer["subjects"]], self.dogs[1:])
        self.assertEqual(sorted(os.listdir(out)), ["dog0.npz", "dog1.npz", "dog2.npz"])
        reference = self.functions(os.path.join(out, "dog0.npz"), self.dogs[0])
        self.assertGreaterEqual(answer["comparable"], 5)
        for subject in answer["subjects"]:
            self.assertEqual(subject["verdict"], "clear")
            self.assertEqual(len(subject["eigenvalues"]), COUNT)
            own = self.functions(subject["output"], subject["mesh"])
            for i in range(answer["comparable"]):
                self.assertGreater(self.cosine(own[i], reference[i]), 0.6, i)
                self.assertGreater(subject["agreement"][i], 0.7)

    def test_a_database_gives_the_same_as_its_files(self):
        database = self.path("dogs.timbre")
        self.run_timbre("db", "create", database, "-q")
        self.run_timbre("db", "add", database, *self.dogs, "-q")
        self.align(database, "--reference", "dog1", "-o", self.path("stored"))
        self.align(*self.dogs, "--reference", self.dogs[1], "-o", self.path("files"))
        for name in ("dog0.npz", "dog1.npz", "dog2.npz"):
            with open(os.path.join(self.path("stored"), name), "rb") as stored, \
                    open(os.path.join(self.path("files"), name), "rb") as files:
                self.assertEqual(stored.read(), files.read())
        self.refuse(database, "--reference", "cat", "-o", self.path("none"), words="no shape is named cat")

    def test_what_stands_there_is_kept(self):
        out = self.path("aligned")
        os.mkdir(out)
        kept = os.path.join(out, "dog2.npz")
        with open(kept, "w") as file:
            file.write("mine")
        self.refuse(*self.dogs, "--reference", self.dogs[0], "-o", out, words="--force")
        with open(kept) as file:
            self.assertEqual(file.read(), "mine")
        self.assertEqual(os.listdir(out), ["dog2.npz"])

    def test_two_subjects_cannot_share_a_file(self):
        other = self.put("dog1.off", b"")
        self.refuse(self.dogs[1], other, "--reference", self.dogs[0], "-o", self.path("a"), words="file of")

    def test_what_is_no_map_is_not_written(self):
        """A sphere is no dog."""
        sphere = self.path("sphere.ply")
        self.run_timbre("dataset", "make", "sphere", "--resolution", "400", "-o", sphere, "-q")
        out = self.path("aligned")
        done = self.align(sphere, "--reference", self.dogs[0], "-o", out, "--strict", code=3)
        self.assertNotIn(b"clear", done.stdout)

    def test_more_functions_than_there_are_is_refused(self):
        done = self.run_timbre("align", *self.dogs, "--reference", self.dogs[0], "-k", "90", "--map-functions",
                               "60", "-o", self.path("a"), code=2)
        self.assertIn(b"-k", done.stderr)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""timbre align: files, a database, what is written, what is refused.

align_test.py TIMBRE"""
import json
import math
import os
import shutil
import sys
import tempfile
import unittest
import zipfile

import command_test
import numpy_file
import shapes

TIMBRE = os.path.abspath(sys.argv.pop(1))
command_test.CommandTest.TIMBRE = TIMBRE
COUNT = 20


class Align(command_test.CommandTest):
    @classmethod
    def setUpClass(cls):
        """Three poses of one dog; line i of its .vts is the vertex of point i."""
        cls.made = tempfile.TemporaryDirectory()
        maker = command_test.CommandTest()
        maker.run_timbre("dataset", "make", "creatures", "-o", cls.made.name, "--species", "dog",
                         "--sets", "shared", "--poses", "3", "--resolution", "1000", "-q")
        folder = os.path.join(cls.made.name, "shared")
        cls.dogs = [os.path.join(folder, f"dog{i}.ply") for i in range(3)]

    @classmethod
    def tearDownClass(cls):
        cls.made.cleanup()

    def align(self, *args, code=0):
        return self.run_timbre("align", *args, "-k", str(COUNT), "--map-functions", "50", code=code)

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

    def test_what_stands_there_is_kept_without_force(self):
        out = self.path("aligned")
        os.mkdir(out)
        kept = os.path.join(out, "dog2.npz")
        with open(kept, "w") as file:
            file.write("mine")
        self.refuse(*self.dogs, "--reference", self.dogs[0], "-o", out, words="--force")
        with open(kept) as file:
            self.assertEqual(file.read(), "mine")
        self.assertEqual(os.listdir(out), ["dog2.npz"])

    def test_one_bad_shape_does_not_end_the_others(self):
        """Nor does the basis of an earlier reference stay in its place."""
        out = self.path("aligned")
        os.mkdir(out)
        with open(os.path.join(out, "broken.npz"), "w") as file:
            file.write("of another reference")
        broken = self.put("broken.off", "OFF\n3 1 0\n0 0 0\n1 0\n")
        done = self.align(broken, self.dogs[1], "--reference", self.dogs[0], "-o", out, "--force", "--json", code=1)
        self.assertIn(b"broken.off", done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual(answer["failed"], 1)
        self.assertIn("broken.off", answer["subjects"][0]["error"])
        self.assertEqual(answer["subjects"][1]["verdict"], "clear")
        self.assertEqual(sorted(os.listdir(out)), ["dog0.npz", "dog1.npz"])

    def test_names_are_as_long_as_needed_to_tell_subjects_apart(self):
        for folder in ("a", "b"):
            os.mkdir(self.path(folder))
            shutil.copy(self.dogs[1], self.path(f"{folder}/dog.ply"))
        out = self.path("aligned")
        self.align(self.path("a/dog.ply"), self.path("b/dog.ply"), self.path("a/../a/dog.ply"), "--reference",
                   self.path("b/dog.ply"), "-o", out)
        self.assertEqual(sorted(os.listdir(out)), ["a_dog.ply.npz", "b_dog.ply.npz"])

    def test_what_is_no_map_is_not_written(self):
        """A thin ring is no dog."""
        ring = self.put("ring.off", shapes.torus_off(12.0, 0.2, 120, 8))
        out = self.path("aligned")
        done = self.align(ring, "--reference", self.dogs[0], "-o", out, "--strict", "--json", code=3)
        answer = json.loads(done.stdout)
        self.assertEqual(answer["subjects"][0]["verdict"], "failed")
        self.assertIsNone(answer["comparable"])
        self.assertEqual(os.listdir(out), ["dog0.npz"])

    def test_nothing_is_mixed_without_near(self):
        out = self.path("aligned")
        self.align(self.dogs[1], "--reference", self.dogs[0], "-o", out, "--near", "0")
        with zipfile.ZipFile(os.path.join(out, "dog1.npz")) as archive:
            numbers = numpy_file.read(archive.read("mixture.npy"))[1]
        rows = len(numbers) // COUNT
        for i in range(COUNT):
            column = [abs(x) for x in numbers[i * rows:(i + 1) * rows]]
            self.assertAlmostEqual(max(column), 1.0)
            self.assertAlmostEqual(sum(column), 1.0)

    def test_what_cannot_be_is_refused(self):
        for words, cause in ((["-k", "90", "--map-functions", "60"], b"-k"), (["--near", "5"], b"--near"),
                             (["--map-functions", "300"], b"--map-functions")):
            done = self.run_timbre("align", *self.dogs, "--reference", self.dogs[0], *words, "-o", self.path("a"), code=2)
            self.assertIn(cause, done.stderr)
        self.refuse(*self.dogs, "--reference", self.path("none.ply"), "-o", self.path("a"), code=1, words="none.ply")
        self.assertFalse(os.path.exists(self.path("a")))


if __name__ == "__main__":
    unittest.main()

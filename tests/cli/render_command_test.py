#!/usr/bin/env python3
"""timbre render: pictures, options, errors.

render_command_test.py TIMBRE"""
import json
import os
import pathlib
import struct
import sys
import unittest

import command_test
import shapes

TIMBRE = sys.argv.pop(1)
command_test.CommandTest.TIMBRE = TIMBRE
VERTICES = 112


def npy(kind, shape, data):
    """A .npy file of numbers packed as `kind`: f8, f4, i8, i4."""
    header = f"{{'descr': '<{kind}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    code = {"f8": "d", "f4": "f", "i8": "q", "i4": "i"}[kind]
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + struct.pack(f"<{len(data)}{code}", *data)


class Render(command_test.CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.put("torus.off", shapes.torus_off(2.0, 0.7))
        self.out = self.path("a.png")

    def render(self, *args, size="64"):
        """The bytes of a picture."""
        done = self.run_timbre("render", self.mesh, "-o", self.out, "--size", size, "--force", *args)
        self.assertEqual(done.stderr, b"")
        return pathlib.Path(self.out).read_bytes()

    def size(self, png):
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(png[12:16], b"IHDR")
        return struct.unpack(">II", png[16:24])

    def refuse(self, *args, code=2, words=""):
        """Expects one line on standard error, and no picture."""
        done = self.run_timbre("render", *args, "-o", self.out, "--size", "32", code=code)
        self.assertEqual(done.stdout, b"")
        self.assertTrue(done.stderr.startswith(b"timbre: "), done.stderr)
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertIn(words.encode(), done.stderr)
        self.assertFalse(os.path.exists(self.out))


class Pictures(Render):
    def test_size(self):
        self.assertEqual(self.size(self.render()), (64, 64))
        self.assertEqual(self.size(self.render(size="80x40")), (80, 40))
        self.assertEqual(self.size(self.render("--view", "front,left,top")), (192, 64))
        self.assertEqual(self.size(self.render("--view", "front,back,left,right,top,bottom,three-quarter")), (256, 128))

    def test_each_option_changes_the_picture(self):
        plain = self.render()
        values = self.put("v.txt", "".join(f"{i} {-i}\n" for i in range(VERTICES)))
        pictures = [plain]
        for args in (["--view", "back"], ["--azimuth", "100"], ["--elevation", "-30"], ["--up", "z"], ["--up", "-x"],
                     ["--background", "white"], ["--background", "#102030"], ["--values", values],
                     ["--values", values, "--colours", "diverging"], ["--values", values, "--colours", "categorical"],
                     ["--values", values, "--lines", "7"], ["--values", values, "--clip", "20"],
                     ["--values", values, "--column", "1"], ["--eigenfunction", "3"],
                     ["--eigenfunction", "3", "--lines", "0"], ["--signature", "hks"], ["--signature", "wks"],
                     ["--signature", "hks", "--column", "50", "-k", "30"], ["--markers", "0,11"]):
            picture = self.render(*args)
            self.assertNotIn(picture, pictures, args)
            pictures.append(picture)

    def test_the_same_bytes_each_time_on_any_number_of_threads(self):
        self.assertEqual(self.render("--threads", "1"), self.render("--threads", "2"))

    def test_arrays_and_text_say_the_same(self):
        numbers = [(i % 7) - 3 for i in range(VERTICES)]
        text = self.render("--values", self.put("v.txt", "\n".join(map(str, numbers))))
        for kind in ("f8", "f4", "i8", "i4"):
            array = self.put("v.npy", npy(kind, f"({VERTICES},)", numbers))
            self.assertEqual(self.render("--values", array), text)
        self.run_timbre("signature", self.mesh, "--kind", "hks", "-k", "50", "-o", self.path("hks.npy"))
        self.assertEqual(self.render("--values", self.path("hks.npy"), "--column", "9", "--clip", "1"),
                         self.render("--signature", "hks", "-k", "50", "--column", "9"))

    def test_map_is_drawn_side_by_side(self):
        straight = self.put("map.txt", "".join(f"{i}\n" for i in range(VERTICES)))
        turned = self.put("map.npy", npy("i4", f"({VERTICES},)", [-1] + list(range(VERTICES - 1, 0, -1))))
        picture = self.render("--map", straight, "--onto", self.mesh, "--markers", "5")
        self.assertEqual(self.size(picture), (128, 64))
        self.assertNotEqual(self.render("--map", turned, "--onto", self.mesh, "--markers", "5"), picture)
        both = self.render("--map", straight, "--onto", self.mesh, "--view", "front,back,top")
        self.assertEqual(self.size(both), (192, 128))

    def test_match_writes_what_render_reads(self):
        for name in ("map.txt", "map.npy"):
            self.run_timbre("match", self.mesh, self.mesh, "-k", "40", "-o", self.path(name))
            self.assertEqual(self.size(self.render("--map", self.path(name), "--onto", self.mesh)), (128, 64))

    def test_standard_streams(self):
        with open(self.mesh, "rb") as mesh:
            done = self.run_timbre("render", "-", "-o", "-", "--size", "32", stdin=mesh)
        self.assertEqual(self.size(done.stdout), (32, 32))
        self.assertEqual(done.stderr, b"")

    def test_json(self):
        done = self.run_timbre("render", self.mesh, "-o", self.out, "--size", "32", "--eigenfunction", "2",
                               "--view", "front,top", "--json")
        answer = json.loads(done.stdout)
        self.assertEqual((answer["width"], answer["height"]), (64, 32))
        self.assertEqual(answer["views"], [{"azimuth": 0.0, "elevation": 0.0}, {"azimuth": 0.0, "elevation": 90.0}])
        values = answer["values"]
        self.assertEqual((values["about"], values["colours"]), ("eigenfunction 2", "diverging"))
        self.assertEqual(values["low"], -values["high"])
        done = self.run_timbre("render", self.mesh, "-o", self.out, "--size", "32", "--force", "--json")
        self.assertIsNone(json.loads(done.stdout)["values"])

    def test_values_that_do_not_exist_are_grey(self):
        array = npy("f8", f"({VERTICES},)", [float("nan"), float("inf")] + [1.0] * (VERTICES - 2))
        self.render("--values", self.put("v.npy", array))


class Errors(Render):
    def test_options(self):
        for args, words in ((["--size", "12"], "size: '12' is no side or WIDTHxHEIGHT"),
                            (["--size", "64x"], "size: '64x'"), (["--size", "5000"], "from 16 to 4096"),
                            (["--view", "inside"], "--view: inside not in"),
                            (["--view", "top", "--azimuth", "3"], "excludes"),
                            (["--elevation", "91"], "'91' is not in the range -90 to 90"),
                            (["--up", "w"], "--up"), (["--background", "#12345"], "none of transparent, white, black"),
                            (["--colours", "rainbow"], "--colours"), (["--signature", "dna"], "--signature"),
                            (["--eigenfunction", "2", "--signature", "hks"], "excludes"),
                            (["--map", "m.txt"], "--onto"), (["--onto", "b.off"], "--map"),
                            (["--eigenfunction", "112"], "eigenfunction: the mesh has only 112, from 0"),
                            (["--signature", "hks", "--column", "64"], "column: 64 is none of the 64, from 0"),
                            (["--markers", "3,112"], "marker: 112 is no vertex; there are 112, from 0"),
                            (["--markers", "-3"], "")):
            done = self.run_timbre("render", self.mesh, "-o", self.out, *args, code=2)
            self.assertEqual((done.stdout, done.stderr.count(b"\n")), (b"", 1), done.stderr)
            self.assertIn(words.encode(), done.stderr)
            self.assertFalse(os.path.exists(self.out))

    def test_output(self):
        done = self.run_timbre("render", self.mesh, code=2)
        self.assertIn(b"--output is required", done.stderr)
        done = self.run_timbre("render", self.mesh, "-o", self.path("a.jpg"), code=2)
        self.assertIn(b"must end in .png", done.stderr)
        done = self.run_timbre("render", self.mesh, "-o", "-", "--json", code=2)
        self.assertIn(b"standard output cannot hold both", done.stderr)
        taken = self.put("a.png", "old")
        done = self.run_timbre("render", self.path("none.off"), "-o", taken, code=2)
        self.assertIn(b"exists already; --force replaces it", done.stderr)
        self.assertEqual(pathlib.Path(taken).read_text(), "old")

    def test_meshes_with_nothing_to_draw(self):
        for text in ("OFF 0 0 0\n", "OFF 3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "OFF 3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n"):
            self.refuse(self.put("empty.off", text), "-q", code=1, words="empty.off: no triangle has an area")

    def test_values(self):
        def values(content, words, name="v.txt", code=1):
            self.refuse(self.mesh, "--values", self.put(name, content), code=code, words=words)
        values("1\n2\n", "v.txt: has 2 rows, but the mesh has 112 vertices")
        values("1\n2 3\n", "v.txt: line 2: has 2 numbers, lines before have 1")
        values("1\nx\n", "v.txt: line 2: 'x' is not a number")
        values("", "v.txt: holds no numbers")
        values(b"PK\x03\x04", "v.npz: is an archive", name="v.npz")
        values(npy("f8", "(2, 2)", [1, 2, 3]), "v.npy: data: is 24 bytes", name="v.npy")
        values(b"\x93NUMPY\x01\x00\xff\xff{", "v.npy: header: ends too soon", name="v.npy")
        self.refuse(self.mesh, "--values", self.path("none.npy"), code=1, words="none.npy: open: No such file")

    def test_maps(self):
        def maps(content, words, code=2):
            self.refuse(self.mesh, "--map", self.put("m.txt", content), "--onto", self.mesh, code=code, words=words)
        maps("0\n1\n", "m.txt: map: has 2 entries, but the source has 112 vertices")
        maps("112\n" * 112, "m.txt: map entry 0: 112 is no vertex of the target")
        maps("0.5\n" * 112, "m.txt: entry 0: 0.5 is no vertex number", code=1)
        maps("-2\n" * 112, "m.txt: entry 0: -2 is no vertex number", code=1)
        maps("0 1\n" * 112, "m.txt: has 2 columns; a map has one", code=1)


class Help(Render):
    def test_the_example_of_the_help_runs(self):
        text = self.run_timbre("render", "--help").stdout.decode()
        example = text.split("Example:\n")[1].split("\n")[0].split()
        self.assertEqual(example[:3], ["timbre", "render", "horse.ply"])
        os.rename(self.mesh, self.path("horse.ply"))
        done = self.run_timbre(*example[1:], cwd=self.folder)
        self.assertEqual(done.stdout, b"wrote horse.png\n")
        self.assertEqual(self.size((self.folder / "horse.png").read_bytes()), (1024, 512))


if __name__ == "__main__":
    unittest.main()

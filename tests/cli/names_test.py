#!/usr/bin/env python3
"""Names and places of files that tools trip over: as a mesh, and as a result.

names_test.py TIMBRE"""
import json
import os
import pathlib
import subprocess
import sys
import unittest

import command_test
import shapes

TIMBRE = os.path.abspath(sys.argv.pop(1))
command_test.CommandTest.TIMBRE = TIMBRE
AS_ROOT = os.geteuid() == 0
FACETS = "".join(f"facet normal 0 0 1\nouter loop\n{''.join(f'vertex {v}' + chr(10) for v in corners)}endloop\nendfacet\n"
                 for corners in (("0 0 0", "1 0 0", "0 1 0"), ("1 0 0", "1 1 0", "0 1 0")))
SQUARE = {
    "off": b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n",
    "obj": b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n",
    "ply": b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           b"element face 2\nproperty list uchar int vertex_indices\nend_header\n"
           b"0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n",
    "stl": f"solid\n{FACETS}endsolid\n".encode(),
}


class Names(command_test.CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.put("torus.off", shapes.torus_off(2.0, 0.7))

    def names(self, folder=None):
        return sorted(os.listdir(folder or self.folder))

    def run_here(self, *args, code=0, **options):
        """Runs timbre in the test's folder, where names need no path."""
        return self.run_timbre(*args, code=code, cwd=self.folder, timeout=60, **options)

    def refuse(self, *args, code=1, words="", **options):
        """Expects one line on standard error, nothing else, and no new file."""
        before = self.names()
        done = self.run_here(*args, code=code, **options)
        self.assertEqual(done.stdout, b"")
        self.assertTrue(done.stderr.startswith(b"timbre: "), done.stderr)
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertTrue(done.stderr.endswith(b"\n"), done.stderr)
        self.assertIn(words.encode(), done.stderr)
        self.assertEqual(self.names(), before)

    def count_faces(self, *args, **options):
        return json.loads(self.run_here("info", "--json", *args, **options).stdout)["faces"]


class Inputs(Names):
    def test_names_are_bytes(self):
        for name in ("two words.off", " .off", "größe 形.off", "new\nline.off", "tab\tquote'\".off", "$(x);&*.off",
                     "100%s%n.off", "a" * 251 + ".off"):
            self.put(name, SQUARE["off"])
            self.assertEqual(self.count_faces(name), 2, name)

    def test_messages_stay_one_line(self):
        self.put("new\nline\x1b[31m.off", "OFF\n1 0 0\n0 0 x\n")
        self.refuse("info", "new\nline\x1b[31m.off",
                    words="timbre: new\\nline\\x1b[31m.off: line 3, vertex 0: 'x' is not a decimal number")
        self.refuse("info", "none\r\n.off", words="timbre: none\\x0d\\n.off: open: No such file or directory")

    def test_names_that_look_like_options(self):
        for name in ("-x.off", "--json", "-"):
            self.put(name, SQUARE["off"])
            self.assertEqual(self.count_faces(f"./{name}"), 2)
        for name in ("-x.off", "--json"):
            self.assertEqual(self.count_faces("--", name), 2)
        self.refuse("info", "-x.off", code=2)

    def test_every_format_comes_through_standard_input(self):
        for format_name, content in SQUARE.items():
            answer = json.loads(self.run_here("info", "-", "--json", input=content).stdout)
            self.assertEqual((answer["format"], answer["vertices"], answer["faces"]), (format_name, 4, 2))
            packed = subprocess.run(["gzip", "-c"], input=content, capture_output=True, check=True).stdout
            self.assertEqual(self.count_faces("-", input=packed), 2)
        self.refuse("info", "-", words="timbre: -: byte 0: the file is empty", input=b"")
        self.refuse("info", "-", words="timbre: -: line 1: no known format", input=b"hello\n")

    def test_what_is_no_regular_file_is_refused_at_once(self):
        os.mkfifo(self.path("fifo.off"))
        os.mkdir(self.path("folder.off"))
        os.symlink("loop.off", self.path("loop.off"))
        os.symlink("none", self.path("dangling.off"))
        for name in ("fifo.off", "folder.off", "/dev/null", "/dev/zero"):
            self.refuse("info", name, words=f"timbre: {name}: open: not a regular file")
        self.refuse("info", "loop.off", words="timbre: loop.off: open: Too many levels of symbolic links")
        self.refuse("info", "dangling.off", words="timbre: dangling.off: open: No such file or directory")
        self.refuse("info", "torus.off/x", words="timbre: torus.off/x: open: Not a directory")

    def test_names_beyond_what_the_system_takes(self):
        for name in ("a" * 256 + ".off", "a/" * 2100 + "a.off"):
            self.refuse("info", name, words=": open: File name too long")
            self.refuse("spectrum", self.mesh, "-o", name.replace(".off", ".txt"), words=": output: File name too long")

    @unittest.skipIf(AS_ROOT, "root may read every file")
    def test_a_file_that_may_not_be_read(self):
        os.chmod(self.put("secret.off", SQUARE["off"]), 0)
        self.refuse("info", "secret.off", words="timbre: secret.off: open: Permission denied")

    def test_standard_input_that_is_a_folder(self):
        folder = os.open(self.folder, os.O_RDONLY)
        try:
            self.refuse("info", "-", words="timbre: -: read: Is a directory", stdin=folder)
        finally:
            os.close(folder)


class Outputs(Names):
    def test_names_of_results_are_bytes(self):
        for name in ("two words.txt", "größe.txt", "new\nline.txt", "./-o.txt"):
            done = self.run_here("spectrum", self.mesh, "-k", "5", "-o", name)
            self.assertEqual(len((self.folder / name).read_text().split()), 5)
            self.assertEqual(done.stdout, b"wrote " + name.encode().replace(b"\n", b"\\n") + b"\n")

    def test_places_that_take_no_result(self):
        os.mkdir(self.path("taken.txt"))
        os.symlink("loop.txt", self.path("loop.txt"))
        for command in ("spectrum", "signature", "embed"):
            for force in ([], ["--force"]):
                def refuse_place(place, code, words, flags=(command, self.mesh, *force)):
                    self.refuse(*flags, "-o", place, code=code, words=f"timbre: {place}: {words}")
                refuse_place("taken.txt", 1, "output: Is a directory")
                refuse_place("none/a.txt", 1, "create: No such file or directory")
                refuse_place("torus.off/a.txt", 1, "output: Not a directory")
                refuse_place("loop.txt", 1, "output: Too many levels of symbolic links")
        os.symlink("/dev/full", self.path("full.txt"))
        self.refuse("spectrum", self.mesh, "-o", "full.txt", "--force", code=2, words="is not a regular file")
        self.refuse("spectrum", self.mesh, "-o", "", code=2, words="--output: a name is missing")

    def test_the_mesh_itself_is_no_place_for_its_result(self):
        mesh = self.put("mesh.txt", SQUARE["off"])
        os.link(mesh, self.path("same.txt"))
        for place in ("mesh.txt", "same.txt"):
            self.refuse("spectrum", "mesh.txt", "-o", place, code=2, words="exists already; --force replaces it")
            self.assertEqual(pathlib.Path(mesh).read_bytes(), SQUARE["off"])

    def test_a_device_that_is_full(self):
        for args in (["-o", "-"], [], ["--json"]):
            with open("/dev/full", "wb", buffering=0) as full:
                done = subprocess.run([TIMBRE, "spectrum", self.mesh, *args], stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr, b"timbre: standard output: No space left on device\n")

    def test_a_reader_that_takes_one_byte(self):
        for args in (["info"], ["info", "--json"], ["embed", "-k", "9", "-o", "-"], ["spectrum", "--json"]):
            line = 'set -o pipefail; "$0" "$@" | head -c 1'
            done = subprocess.run(["bash", "-c", line, TIMBRE, *args, self.mesh], capture_output=True)
            self.assertEqual((done.returncode, len(done.stdout)), (0, 1), done.stderr)
            self.assertNotIn(b"Broken pipe", done.stderr)

    def test_a_disk_that_fills_up_leaves_nothing_behind(self):
        """A limit on the size of files is met in the middle of writing, as a full disk is."""
        line = 'trap "" XFSZ; ulimit -f 4; exec "$0" "$@"'
        large = self.put("large.off", shapes.torus_off(2.0, 0.7, 40, 30))
        for command, name in (("embed", "a.txt"), ("embed", "a.npy"), ("spectrum", "a.npz"), ("signature", "a.txt")):
            before = self.names()
            args = [command, large, "-k", "20", "-o", name, "-q"]
            done = subprocess.run(["bash", "-c", line, TIMBRE, *args], cwd=self.folder, capture_output=True)
            self.assertEqual(done.stderr, f"timbre: {name}: write: File too large\n".encode())
            self.assertEqual((done.returncode, done.stdout), (1, b""))
            self.assertEqual(self.names(), before)

    def test_a_result_is_kept_when_its_successor_cannot_be_written(self):
        self.put("a.npy", b"old")
        line = 'trap "" XFSZ; ulimit -f 4; exec "$0" "$@"'
        large = self.put("large.off", shapes.torus_off(2.0, 0.7, 40, 30))
        done = subprocess.run(["bash", "-c", line, TIMBRE, "embed", large, "-k", "9", "-o", "a.npy", "--force"],
                              cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 1)
        self.assertEqual((self.folder / "a.npy").read_bytes(), b"old")
        self.assertEqual(self.names(), ["a.npy", "large.off", "torus.off"])


@unittest.skipUnless(AS_ROOT, "only root may mount")
class Mounts(Names):
    def mount(self, *options):
        place = self.folder / "mounted"
        place.mkdir(exist_ok=True)
        done = subprocess.run(["mount", "-t", "tmpfs", *options, "tmpfs", str(place)], capture_output=True)
        if done.returncode != 0:
            self.skipTest("mounting is not allowed here")
        self.mounted = place
        return place

    def tearDown(self):
        if hasattr(self, "mounted"):
            subprocess.run(["umount", str(self.mounted)], check=True)
        super().tearDown()

    def test_a_full_disk_leaves_nothing_behind(self):
        place = self.mount("-o", "size=128k")
        large = self.put("large.off", shapes.torus_off(2.0, 0.7, 60, 40))
        (place / "filler").write_bytes(bytes(100000))
        for command, name in (("embed", "a.npy"), ("spectrum", "a.npz")):
            self.refuse(command, large, "-k", "20", "-o", f"mounted/{name}", "-q",
                        words=f"timbre: mounted/{name}: write: No space left on device")
            self.assertEqual(self.names(place), ["filler"])
        self.run_timbre("db", "add", str(place / "d.timbre"), self.mesh, "-k", "30", code=1)
        (place / "filler").unlink()
        self.run_here("spectrum", self.mesh, "-k", "20", "-o", "mounted/b.npy")

    def test_a_folder_that_is_read_only(self):
        place = self.mount()
        self.run_timbre("db", "add", str(place / "d.timbre"), self.mesh, "-k", "30")
        subprocess.run(["mount", "-o", "remount,ro", str(place)], check=True)
        self.refuse("spectrum", self.mesh, "-o", "mounted/a.txt", words="Read-only file system")
        before = self.names(place)
        self.refuse("db", "add", "mounted/d.timbre", self.mesh, "--name", "x", words="timbre: mounted/d.timbre: ")
        answer = json.loads(self.run_here("query", "mounted/d.timbre", self.mesh, "--json").stdout)
        self.assertEqual(answer["results"][0]["name"], "torus")
        self.assertEqual(self.names(place), before)


@unittest.skipUnless(AS_ROOT, "needs another user to become")
class NotAllowed(Names):
    NOBODY = 65534

    def run_as_nobody(self, *args):
        return subprocess.run([TIMBRE, *args], cwd="/", capture_output=True, user=self.NOBODY, group=self.NOBODY,
                              extra_groups=[])

    def setUp(self):
        super().setUp()
        os.chmod(self.folder, 0o755)
        if self.run_as_nobody("--version").returncode != 0:
            self.skipTest("others may not run the program where it lies")

    def test_files_and_folders_of_others(self):
        secret = self.put("secret.off", SQUARE["off"])
        os.chmod(secret, 0o600)
        done = self.run_as_nobody("info", secret)
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"timbre: {secret}: open: Permission denied\n".encode()))
        out = self.path("a.txt")
        done = self.run_as_nobody("spectrum", self.mesh, "-o", out)
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"timbre: {out}: create: Permission denied\n".encode()))
        self.assertEqual(self.names(), ["secret.off", "torus.off"])


if __name__ == "__main__":
    unittest.main()

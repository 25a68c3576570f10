#!/usr/bin/env python3
"""Results of the commands: where they go, what stops them, what is left when they stop.

results_test.py TIMBRE"""
import json
import os
import pathlib
import signal
import stat
import struct
import subprocess
import sys
import time
import unittest
import zipfile

import command_test
import shapes

TIMBRE = sys.argv.pop(1)
command_test.CommandTest.TIMBRE = TIMBRE
AS_ROOT = os.geteuid() == 0


class Results(command_test.CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.put("torus.off", shapes.torus_off(2.0, 0.7))

    def names(self):
        return sorted(os.listdir(self.folder))

    def refuse(self, *args, code=2, words=""):
        """Expects one line on standard error, and nothing else."""
        done = self.run_timbre(*args, code=code)
        self.assertEqual(done.stdout, b"")
        self.assertTrue(done.stderr.startswith(b"timbre: "), done.stderr)
        self.assertEqual(done.stderr.count(b"\n"), 1, done.stderr)
        self.assertIn(words.encode(), done.stderr)

    def shell(self, line, *args, code=0):
        """Runs a line of bash, where $0 is the command and $1, ... are `args`."""
        done = subprocess.run(["bash", "-c", line, TIMBRE, *args], capture_output=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def count_stored(self, database):
        return len(json.loads(self.run_timbre("db", "list", database, "--json").stdout)["shapes"])


class Files(Results):
    def test_spectrum_writes_arrays_that_others_read(self):
        out = self.path("a.npz")
        done = self.run_timbre("spectrum", self.mesh, "-k", "20", "-o", out)
        self.assertEqual(done.stdout, f"wrote {out}\n".encode())
        with zipfile.ZipFile(out) as archive:
            self.assertIsNone(archive.testzip())
            names = set(archive.namelist())
            header = archive.read("evecs.npy")[:128]
        self.assertLessEqual({"vertices.npy", "faces.npy", "evals.npy", "evecs.npy", "mass.npy", "W_data.npy"}, names)
        self.assertTrue(header.startswith(b"\x93NUMPY"))
        self.assertIn(b"(112, 20)", header)

    def test_matlab_files_hold_what_npz_files_hold(self):
        for command in (["spectrum", self.mesh, "-k", "20"], ["signature", self.mesh, "-k", "20"],
                        ["filter", self.mesh, "--fiedler"]):
            self.run_timbre(*command, "-o", self.path("a.npz"), "--force")
            self.run_timbre(*command, "-o", self.path("a.mat"), "--force")
            with zipfile.ZipFile(self.path("a.npz")) as archive:
                names = [name[:-4].encode() for name in archive.namelist()]
                vectors = {name[:-4].encode(): archive.read(name) for name in archive.namelist()}
            data = pathlib.Path(self.path("a.mat")).read_bytes()
            self.assertTrue(data.startswith(b"MATLAB 5.0 MAT-file"))
            found, compared, at = [], 0, 128
            while at < len(data):
                kind, size = struct.unpack_from("<II", data, at)
                self.assertEqual(kind, 14)
                length = struct.unpack_from("<I", data, at + 44)[0]
                name = data[at + 48:at + 48 + length]
                start = at + 48 + (length + 7) // 8 * 8
                if b"'<f8', 'fortran_order': False" in vectors.get(name, b"")[:128] and b",)" in vectors[name][:128]:
                    bytes_of = struct.unpack_from("<I", data, start + 4)[0]
                    self.assertEqual(data[start + 8:start + 8 + bytes_of], vectors[name][-bytes_of:], name)
                    compared += 1
                found.append(name)
                at += 8 + size
            self.assertEqual(at, len(data))
            self.assertIn(found, (names, names + [b"index_base"]))
            self.assertGreater(compared, 0)

    def test_existing_results_need_force(self):
        for command in ("spectrum", "signature", "embed"):
            out = self.put("a.txt", "old")
            self.refuse(command, self.mesh, "-k", "9", "-o", out, words="exists already; --force replaces it")
            self.assertEqual(pathlib.Path(out).read_text(), "old")
            self.run_timbre(command, self.mesh, "-k", "9", "-o", out, "--force")
            self.assertNotEqual(pathlib.Path(out).read_text(), "old")

    def test_of_three_files_all_or_none_are_written(self):
        out, values = self.path("a.npy"), self.path("a.evals.npy")
        for taken, free in ((out, values), (values, out)):
            pathlib.Path(taken).write_text("old")
            self.refuse("spectrum", self.mesh, "-k", "9", "-o", out, words=taken)
            self.assertFalse(os.path.exists(free))
            os.remove(taken)
        self.run_timbre("spectrum", self.mesh, "-k", "9", "-o", out)
        self.assertEqual(self.names(), ["a.evals.npy", "a.json", "a.npy", "torus.off"])
        # The second file is too large for what the shell allows.
        small = 'trap "" XFSZ; ulimit -f 8; "$0" spectrum "$1" -k 20 -o "$2"'
        done = self.shell(small, self.mesh, self.path("b.npy"), code=1)
        self.assertIn(b"b.npy: write: File too large", done.stderr)
        self.assertEqual(self.names(), ["a.evals.npy", "a.json", "a.npy", "torus.off"])

    def test_force_writes_through_a_link_and_keeps_the_mode(self):
        real = pathlib.Path(self.put("real.txt", "old"))
        real.chmod(0o600)
        link = self.folder / "link.txt"
        link.symlink_to(real.name)
        self.run_timbre("spectrum", self.mesh, "-k", "9", "-o", str(link), "--force")
        self.assertTrue(link.is_symlink())
        self.assertEqual(len(real.read_text().split()), 9)
        self.assertEqual(stat.S_IMODE(real.stat().st_mode), 0o600)

    def test_only_regular_files_are_replaced(self):
        fifo = self.path("fifo.txt")
        os.mkfifo(fifo)
        null = self.path("null.txt")
        os.symlink("/dev/null", null)
        for target in (fifo, null):
            self.refuse("spectrum", self.mesh, "-o", target, "--force", words="is not a regular file")
        self.assertTrue(stat.S_ISFIFO(os.stat(fifo).st_mode))
        self.assertTrue(stat.S_ISCHR(os.stat(null).st_mode))

    def test_outputs_are_looked_at_before_the_mesh(self):
        """A mesh that is not there would be found first by a command that reads it first."""
        mesh = self.path("none.off")
        taken = self.put("taken.txt", "old")
        commands = (["spectrum", mesh], ["signature", mesh], ["embed", mesh], ["symmetry", mesh], ["match", mesh, mesh],
                    ["db", "export", mesh, "name", "--spectrum"])
        for command in commands:
            self.refuse(*command, "-o", taken, words="exists already")
            self.refuse(*command, "-o", self.path("none/a.txt"), code=1, words="No such file or directory")
            self.refuse(*command, "-o", self.path("a.doc"), words="ending '.doc' is unknown")
            self.refuse(*command, "-o", "-", "--json", words="standard output cannot hold both")

    @unittest.skipIf(AS_ROOT, "to root every folder is writable")
    def test_a_folder_that_takes_no_files_is_found_first(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        self.refuse("spectrum", self.path("none.off"), "-o", str(locked / "a.txt"), code=1, words="Permission denied")


class Streams(Results):
    def test_result_on_standard_output(self):
        self.assertEqual(len(self.run_timbre("spectrum", self.mesh, "-k", "9", "-o", "-").stdout.split()), 9)
        rows = self.run_timbre("embed", self.mesh, "-k", "4", "-o", "-").stdout.splitlines()
        self.assertEqual((len(rows), len(rows[0].split())), (112, 4))

    def test_words_leave_standard_output_to_the_map(self):
        done = self.run_timbre("match", self.mesh, self.mesh, "-k", "40", "-o", "-")
        self.assertEqual(len(done.stdout.split()), 112)
        self.assertRegex(done.stderr.decode(), r"^timbre: .* -> .*: (clear|ambiguous)")
        self.assertNotIn(b"wrote", done.stderr)
        self.assertTrue(all(line.startswith(b"timbre: ") for line in done.stderr.splitlines()))
        quiet = self.run_timbre("match", self.mesh, self.mesh, "-k", "40", "-o", "-", "-q")
        self.assertEqual((quiet.stdout, quiet.stderr), (done.stdout, b""))

    def test_a_reader_that_goes_away_ends_nothing(self):
        files = shapes.write_tori(self.folder, 6)
        database = self.path("d.timbre")
        line = 'set -o pipefail; "$0" "$@" | head -1'
        self.assertEqual(self.shell(line, "db", "add", database, "-k", "30", *files).stdout, b"added t00\n")
        self.assertEqual(self.count_stored(database), 6)
        names = [f"t{i:02}" for i in range(5)]
        self.assertEqual(self.shell(line, "db", "remove", database, *names).stdout, b"removed t00\n")
        self.assertEqual(self.count_stored(database), 1)
        self.assertEqual(self.shell(line, "spectrum", self.mesh).stdout, b"0\n")
        bad = self.put("bad.off", "OFF\n1 0\n")
        self.shell(line, "db", "add", database, bad, *files, code=1)

    def test_an_answer_that_cannot_be_written_is_an_error(self):
        for redirect in (">/dev/full", ">&-"):
            for args in (["spectrum", self.mesh], ["--version"], ["info", "--help"], ["info", self.mesh, "--json"]):
                done = self.shell(f'"$0" "$@" {redirect}', *args, code=1)
                self.assertRegex(done.stderr.decode(), r"^timbre: standard output: [A-Z][a-z ]+\n$")

    def test_words_that_cannot_be_written_are_no_error(self):
        small = self.put("small.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        for redirect in ("2>/dev/full", "2>&-"):
            done = self.shell(f'"$0" "$@" {redirect}', "spectrum", small)
            self.assertEqual(len(done.stdout.split()), 3)
            database = self.path(f"{len(redirect)}.timbre")
            done = self.shell(f'"$0" "$@" {redirect}', "db", "add", database, self.mesh, "--json")
            self.assertEqual(json.loads(done.stdout)["added"], 1)

    def test_closed_streams_are_not_taken_by_files(self):
        database = self.path("d.timbre")
        self.shell('"$0" db add "$1" "$2" "$3" <&- >&- 2>&-', database, self.mesh, self.path("none.off"), code=1)
        self.assertEqual(json.loads(self.run_timbre("db", "verify", database, "--json").stdout)["damaged"], [])
        done = self.shell('"$0" info - <&-', code=1)
        self.assertEqual(done.stderr, b"timbre: -: read: Bad file descriptor\n")


class Interrupts(Results):
    def interrupt(self, *args, after=0.5, stdin=subprocess.DEVNULL):
        process = subprocess.Popen([TIMBRE, *args], stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(after)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual(err.count(b"\n"), 1, err)
        return out.decode()

    def test_spectrum_stops_and_leaves_no_file(self):
        mesh = self.put("large.off", shapes.torus_off(2.0, 0.7, 400, 150))
        before = self.names()
        self.interrupt("spectrum", mesh, "-k", "1000", "-o", self.path("a.npz"), after=1.0)
        self.assertEqual(self.names(), before)

    def test_waiting_for_standard_input_stops(self):
        for command in (["info", "-"], ["db", "add", self.path("d.timbre"), "-", "--name", "x"]):
            reading, writing = os.pipe()
            self.interrupt(*command, stdin=reading)
            os.close(reading)
            os.close(writing)

    def test_adding_keeps_what_was_acknowledged(self):
        files = [self.put(f"m{i}.off", shapes.torus_off(2.0, 0.7 - 0.01 * i, 150, 40)) for i in range(12)]
        database = self.path("d.timbre")
        out = self.interrupt("db", "add", database, *files, "--threads", "1", after=1.0)
        self.assertLess(out.count("added"), 12)
        self.assertGreaterEqual(self.count_stored(database), out.count("added"))


class Answers(Results):
    def test_doubt_is_an_exit_code_only_when_asked_for(self):
        # A square has all its symmetries to choose from.
        lines = [f"{i} {j} 0" for i in range(9) for j in range(9)]
        for i in range(8):
            for j in range(8):
                a = 9 * i + j
                lines += [f"3 {a} {a + 9} {a + 10}", f"3 {a} {a + 10} {a + 1}"]
        square = self.put("square.off", "OFF\n81 128 0\n" + "\n".join(lines) + "\n")
        answer = json.loads(self.run_timbre("match", square, square, "-k", "30", "--json").stdout)
        self.assertNotEqual(answer["verdict"], "clear")
        out = self.path("map.txt")
        self.run_timbre("match", square, square, "-k", "30", "--strict", "-o", out, code=3)
        self.assertEqual(len(pathlib.Path(out).read_text().split()), 81)

    def test_maps_do_not_depend_on_threads(self):
        maps = []
        for threads in ("1", "2"):
            out = self.path(f"{threads}.npz")
            self.run_timbre("match", self.mesh, self.mesh, "-k", "40", "--threads", threads, "-o", out)
            maps.append(pathlib.Path(out).read_bytes())
        self.assertEqual(*maps)

    def test_symmetry_answers_or_says_that_there_is_none(self):
        answer = json.loads(self.run_timbre("symmetry", self.mesh, "-k", "40", "--json").stdout)
        out = self.path("mirror.npz")
        if answer["maps"]:
            self.run_timbre("symmetry", self.mesh, "-k", "40", "-o", out)
            self.assertIn("map_0.npy", zipfile.ZipFile(out).namelist())
        else:
            self.refuse("symmetry", self.mesh, "-k", "40", "-o", out, code=1, words="no reflection")

    def test_fewer_eigenvalues_than_asked_for_are_mentioned(self):
        small = self.put("small.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
        done = self.run_timbre("signature", small, "--kind", "hks", "-k", "5")
        self.assertIn(b"has only 3 eigenvalues that are not 0", done.stderr)
        self.assertEqual(self.run_timbre("signature", self.mesh, "--kind", "hks", "-k", "5").stderr, b"")
        done = self.run_timbre("signature", self.mesh, "--kind", "gps", "-k", "40")
        self.assertIn(b"gps uses the first 25 eigenfunctions", done.stderr)

    def test_errors_name_the_file(self):
        # The regular tetrahedron: all eigenvalues but 0 are equal.
        even = self.put("even.off", "OFF\n4 4 0\n1 1 1\n1 -1 -1\n-1 1 -1\n-1 -1 1\n"
                        "3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n")
        self.refuse("signature", even, "--kind", "wks", "-k", "3", words=f"timbre: {even}: ")
        self.refuse("info", "", code=1, words="'': open: No such file or directory")

    def test_ranges_are_told_as_people_write_them(self):
        self.refuse("embed", self.mesh, "--time", "0", words="--time: '0' is not in the range 1e-300 to 1e+300")
        self.refuse("spectrum", self.mesh, "--tolerance", "nan", words="'nan' is not in the range 1e-14 to 1")

    def test_options_are_there_where_they_work(self):
        self.refuse("info", self.mesh, "--threads", "1", words="--threads")
        for command in ("spectrum", "signature", "embed"):
            one, two = (self.run_timbre(command, self.mesh, "--threads", n).stdout for n in ("1", "2"))
            self.assertEqual(one, two)
        facets = "".join(f"facet normal 0 0 1\nouter loop\n{v}endloop\nendfacet\n" for v in (
            "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n", "vertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n"))
        stl = self.put("a.stl", f"solid\n{facets}endsolid\n")
        self.assertEqual(len(self.run_timbre("spectrum", stl, "-q").stdout.split()), 4)
        self.assertEqual(len(self.run_timbre("spectrum", stl, "-q", "--soup").stdout.split()), 6)
        self.refuse("spectrum", stl, "--size-limit", "10", code=1, words="size")
        database = self.path("d.timbre")
        self.refuse("db", "add", database, stl, "--size-limit", "10", code=1, words="size")

    def test_unknown_commands_get_a_suggestion(self):
        self.refuse("spectra", self.mesh, words="did you mean 'spectrum'?")

    def test_names_that_are_no_utf8_or_hold_control_characters(self):
        latin = os.path.join(os.fsencode(self.folder), b"caf\xe9\n.off")
        os.symlink(self.mesh, latin)
        answer = json.loads(self.run_timbre("spectrum", latin, "-k", "3", "--json").stdout)
        self.assertTrue(answer["mesh"].endswith("caf\ufffd\n.off"))
        done = self.run_timbre("symmetry", latin, "-k", "40")
        self.assertIn(b"caf\xe9\\n.off: ", done.stdout)
        database = self.path("d.timbre")
        self.run_timbre("db", "add", database, *shapes.write_tori(self.folder, 2), "-k", "30")
        labels = self.folder / "labels.txt"
        labels.write_bytes(b"t00.off caf\xe9\nt01.off caf\xe9\n")
        report = self.run_timbre("eval", "retrieval", database, "--labels", str(labels), "--json")
        self.assertEqual(json.loads(report.stdout)["classes"][0]["label"], "caf\ufffd")


if __name__ == "__main__":
    unittest.main()

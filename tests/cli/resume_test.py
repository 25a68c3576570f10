#!/usr/bin/env python3
"""Stops `timbre spectrum -o F.npy` in many ways: what comes out at last has the same bytes.

resume_test.py TIMBRE"""
import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import time
import unittest

from command_test import CommandTest

COUNT = "600"


def wait_for(condition, process, seconds=60):
    end = time.monotonic() + seconds
    while process.poll() is None and not condition() and time.monotonic() < end:
        time.sleep(0.001)


class ResumeTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.path("ellipsoid.ply")
        self.run_timbre("dataset", "make", "ellipsoid", "--resolution", "4000", "-o", self.mesh)
        self.out, self.state = self.path("f.npy"), self.path("f.npy.state")

    def spectrum(self, *args, out=None, code=0):
        return self.run_timbre("spectrum", self.mesh, "-k", COUNT, "-o", out or self.out, *args, code=code)

    def start(self, *args):
        return subprocess.Popen([self.TIMBRE, "spectrum", self.mesh, "-k", COUNT, "-o", self.out, *args],
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def state_time(self):
        try:
            return os.stat(self.state).st_mtime_ns
        except FileNotFoundError:
            return 0

    def stop(self, with_signal, *args):
        """Runs until another state is written, and stops it; True if it was stopped in time."""
        before = self.state_time()
        process = self.start(*args)
        wait_for(lambda: self.state_time() != before, process)
        process.send_signal(with_signal)
        message = process.communicate()[1].decode()
        return process.returncode, message

    def bytes_of(self, out):
        stem = out[:-4]
        return [pathlib.Path(stem + ending).read_bytes() for ending in (".npy", ".evals.npy", ".json")]

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_kill_and_resume(self):
        whole = self.path("whole.npy")
        self.spectrum(out=whole)
        kills = 0
        args = []
        while not pathlib.Path(self.out).exists():
            code, _ = self.stop(signal.SIGKILL, *args)
            kills += code == -signal.SIGKILL
            self.assertIn(code, (0, -signal.SIGKILL))
            args = ["--resume"] if self.state_time() else []
            self.assertLess(kills, 100)
        self.assertGreater(kills, 0)
        self.assertEqual(self.bytes_of(self.out), self.bytes_of(whole))
        self.assertEqual(self.files(), ["ellipsoid.ply", "f.evals.npy", "f.json", "f.npy",
                                        "whole.evals.npy", "whole.json", "whole.npy"])

    def test_interrupt_keeps_what_was_found(self):
        code, message = self.stop(signal.SIGINT)
        self.assertEqual(code, 130)
        self.assertIn("f.npy: what was found is kept; --resume goes on with it", message)
        refused = self.spectrum(code=2).stderr.decode()
        self.assertIn("f.npy: output: is unfinished; --resume goes on with it, --force begins again", refused)
        done = self.spectrum("--resume")
        self.assertRegex(done.stderr.decode(), r"f\.npy: going on after \d+ of 600 eigenpairs")

    def test_resume_is_refused_for_another_request(self):
        self.stop(signal.SIGINT)
        for other in (["--tolerance", "1e-5"], ["--operator", "graph"], ["--float32"]):
            refused = self.spectrum("--resume", *other, code=1).stderr.decode()
            self.assertRegex(refused, "belongs to another mesh or other options|was begun for a matrix of another size")
        self.spectrum("--resume")

    def test_force_begins_again(self):
        self.stop(signal.SIGINT)
        self.spectrum("--force")
        self.assertEqual(self.files(), ["ellipsoid.ply", "f.evals.npy", "f.json", "f.npy"])

    def test_nothing_to_resume(self):
        refused = self.spectrum("--resume", code=2).stderr.decode()
        self.assertIn("there is nothing to go on with", refused)
        refused = self.spectrum("--resume", out=self.path("f.npz"), code=2).stderr.decode()
        self.assertIn("--resume: is for eigenfunctions in a file: -o F.npy", refused)

    def test_full_disk_leaves_nothing(self):
        def limit():
            import resource
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000000, 1000000))
        done = subprocess.run([self.TIMBRE, "spectrum", self.mesh, "-k", COUNT, "-o", self.out],
                              capture_output=True, preexec_fn=limit, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("f.npy: write: File too large", done.stderr.decode())
        self.assertEqual(self.files(), ["ellipsoid.ply"])

    def test_single_precision_is_the_same_rounded(self):
        single = self.path("s.npy")
        self.spectrum()
        self.spectrum("--float32", out=single)
        exact = pathlib.Path(self.out).read_bytes()
        rounded = pathlib.Path(single).read_bytes()
        self.assertIn(b"'<f4'", rounded[:128])
        doubles = struct.unpack("<500d", exact[-4000:])
        self.assertEqual(rounded[-2000:], struct.pack("<500f", *doubles))

    def test_document_holds_the_proof(self):
        self.spectrum()
        document = json.loads(pathlib.Path(self.path("f.json")).read_text())
        certificate = document["certificate"]
        values = document["eigenvalues"]
        self.assertEqual(len(values), int(COUNT))
        self.assertGreater(certificate["bound"], values[-1])
        self.assertGreaterEqual(certificate["count"], len(values))
        self.assertGreater(len(certificate["shifts"]), 1)
        for shift in certificate["shifts"]:
            self.assertEqual(shift["below"], sum(value < shift["shift"] for value in values))


if __name__ == "__main__":
    CommandTest.TIMBRE = sys.argv.pop(1)
    unittest.main()
